"""What a guard is: the user's; a surface reached; the end of sliding, below and above."""

PLAIN, ARRIVE, EXIT_BELOW, EXIT_ABOVE = range(4)
NOT_SLIDING = -1  # in place of the mode beside a sliding one
DIFFERENCE = 2.0**-10  # step of differences, relative
