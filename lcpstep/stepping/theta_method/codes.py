"""Numbers of the theta-method that kernels and Python know."""

NEED_LCP = -2  # why the loop returned, besides what `kernels.status` has: solve the problem at hand
NO_EVENT = -1  # in place of a kind of events
MAX_ITERATIONS = 25  # of Newton, per step
