"""Numbers of systems with modes that kernels and Python know."""

# What a guard is: the user's; a surface reached; the end of sliding, below and above
PLAIN, ARRIVE, EXIT_BELOW, EXIT_ABOVE = range(4)
NOT_SLIDING = -1  # in place of the mode beside a sliding one
DIFFERENCE = 2.0**-10  # step of differences, relative
# Places in what kernels keep of a run: time, duration and mode of the step that follows, then the state; in a line of
# the log time, modes left and entered, guard, then the states before and after
TIME, LENGTH, ROW_MODE, LEAD = range(4)
SWITCH_LEAD = 4
