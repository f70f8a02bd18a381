"""What numbers are rounded by, for kernels and Python; the `.pxd` file has it as C knows it."""

RESOLUTION = 2.0**-52
NOISE = 64 * RESOLUTION  # relative to the terms of a sum: what rounding may leave of it
