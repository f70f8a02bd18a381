"""Places in what `matching` writes of blows and pairs, and what is wrong with a suspect."""

START, STOP, LATE_BY, IMPULSE, JUMP, OF_PAIR = range(6)  # numbers of a pair
FIRST, LAST, HARD, PUSH, OF_BLOW = range(5)  # of a blow: its first and last time, sums of jumps and impulses
ANOTHER, OF_RUN, OF_COMPANION, ALONE = range(4)  # a suspect is of another strength, or without partner
