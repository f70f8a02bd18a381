"""What numbers are rounded by, for kernels and Python; the `.pxd` file has it as C knows it."""

RESOLUTION = 2.0**-52
NOISE = 64 * RESOLUTION  # relative to the terms of a sum: what rounding may leave of it
# Relative: what rounding may make of the phase of a callback, and of the time of a corner, off which times are moved
MARGIN = 8 * RESOLUTION
