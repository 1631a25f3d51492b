"""What the learned plugins share: device, trained weights, the two kinds of network."""
