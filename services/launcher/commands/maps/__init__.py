"""Commands about maps, and the marks that people make on them."""
