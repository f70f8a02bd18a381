"""What each feature of a scene adds to the cost of a step of `Moreau`."""
