"""What an audit takes for an event of the run, and for zero."""

AT_EVENT = 1e-7  # of the scale of times: what is so near to an event of the run is part of it
BESIDE, ERRORS = 1e-3, 3.0  # so is what is near, where the gap is above minus so many errors
NEGLIGIBLE = 1e-9  # of the largest gap: no error that is larger counts as one
UNKNOWN, PRESSED = 1, 2  # kinds of pieces: the motion is not known; the contact is closed
TIMES = 4e-16  # of the time: by how much the argument of what moves is rounded, at most
JUMP, RELEASED = 1, 2  # kinds of states: the velocity may have jumped; the motion is free again
SLACK = 1e-13  # of the numbers that a bound is made of: a few hundred roundings
ROUNDED = 1.1e-13  # of the positions of closed forms: what a gap may be off by
