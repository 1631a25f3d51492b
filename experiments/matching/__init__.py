"""Matching of flat pictures placed on the sphere: latitude, blur, rotation, scale (thesis, section 3.1)."""
