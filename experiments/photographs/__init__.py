"""What a pipeline makes of photographs of real places: linked pictures, look-alikes, tilted cameras."""
