"""Commands about the processes that run here: start, look at and end them, and who may do what with them."""
