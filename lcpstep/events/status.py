"""Why a loop over events returned, and the kinds of events: small numbers that kernels and Python know.

Nothing is compiled here, so that both can import them.
"""

# Why a loop returned
FINISHED, BUFFER_FULL, NOT_FINITE, TOO_MANY_EVENTS, STEP_TOO_SMALL, NEVER_LEFT = range(6)
# Kinds of events, the values of `trajectory.Kind`
IMPACT, ACCUMULATION, STICK, RELEASE = range(4)
SLACK = 4  # rows and events that one round of a loop may need
