"""Pictures from anywhere, without any history: what goal-check says of where they were taken."""
