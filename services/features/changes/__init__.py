"""What changed at a place since a picture was taken there."""
