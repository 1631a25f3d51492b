"""What tools answer, as an agent reads it. Text in it is JSON: told by others, it stays data."""
