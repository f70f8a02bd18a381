"""Cost of a step, memory and error of a column of N bodies, beside Siconos."""
