"""What runs are looked over for: whether a motion that ended well is to be doubted, or why it would not go on.

finished        all looks at a finished run, in turn: its `doubt`
of obstacles    room (a body has some inside), normals, sides (an inside), leaps (they jump), jolts (a frame does),
                fast_gaps; depth (deeper inside than steps explain), shared_normals (of contacts that slide)
of steps        resolution, balance (of energy), periods, outrun, turned, hops: whether they are short enough
of what stops   standstill; hindrance: kinks, sticking (forces that hold a velocity at zero)

Each is a function of a run that says what is wrong in words, for the message; empty where nothing is.
"""
