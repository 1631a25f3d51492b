"""`topnav soak`: missions without end while services are killed, frozen and cut off."""
