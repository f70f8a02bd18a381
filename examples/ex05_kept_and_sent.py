"""A run kept, and opened elsewhere
================================

A run goes to a NetCDF file with everything that is known about it: states, impulses, impacts, the scene with
its parameters, the method, the versions. Loaded again it equals itself to the last bit, and is drawn as if it
had never been away. Nothing in such a file is executed.
"""

import numpy as np

from lagrangian import scenes
from lcpstep import Located, Trajectory, load, simulate


def sent_and_opened() -> tuple[Trajectory, Trajectory]:
    """A run of a chattering oscillator, and what its file makes of it."""
    run = simulate(scenes.sticking_oscillator(t_end=50.0), Located(h=0.01))
    return run, load(run.save("kept.nc", overwrite=True))


if __name__ == "__main__":
    run, same = sent_and_opened()
    print(same)
    print("equal to the last bit:", np.array_equal(run.q, same.q) and np.array_equal(run.v, same.v))
    print(same.to_dataframe("events").head())
    same.plot().savefig("kept-and-sent.png")
