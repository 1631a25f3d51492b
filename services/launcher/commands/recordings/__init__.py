"""Commands about what the bus said."""
