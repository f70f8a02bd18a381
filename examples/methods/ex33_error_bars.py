"""A run that says how far it can be trusted
=========================================

With `error=True` a run gets an error bar from a companion by another method. In chaos it also says until when:
at 660 rpm the cam-follower forgets its start, and no method can say where it is after some turns. Here the bar
is held against what the error really is.

Source: docs/accuracy.md, with statistics over random scenes.
"""

import numpy as np
from matplotlib.figure import Figure

from lagrangian import scenes
from lcpstep import EventDriven, Located, simulate


def bar_and_error():
    """The run by steps, and its true error at the times of its bar: times, bar, error [m]."""
    scene = scenes.cam_follower(rpm=660.0, t_end=3.0)
    run = simulate(scene, Located(h=1e-4), error=True)
    t = run.error.t
    exact = simulate(scene, EventDriven(rtol=1e-14, atol=1e-14))
    error = np.maximum.accumulate(np.abs(run.at(t)[0] - exact.at(t)[0])[:, 0])
    return run, t, run.error.position.largest[:, 0], error


def picture() -> Figure:
    """Bar and true error over time, and where the bar ends."""
    run, t, bar, error = bar_and_error()
    figure = Figure(figsize=(7.5, 4.2), layout="constrained")
    ax = figure.subplots()
    ax.semilogy(t, np.maximum(bar, 1e-12), "C0-", lw=3.0, alpha=0.5, label="error bar")
    ax.semilogy(t, np.maximum(error, 1e-12), "k--", lw=1.0, label="true error")
    ax.axvline(run.error.until, color="C3", ls=":", label=f"the bar ends: {run.error.until:.2f} s")
    ax.set(xlabel="time t [s]", ylabel="largest error so far [m]", xlim=(0.0, 3.0), ylim=(1e-8, 1.0))
    ax.legend(loc="upper left")
    ax.grid(alpha=0.3)
    return figure


if __name__ == "__main__":
    print(bar_and_error()[0].error)
    picture().savefig("error-bars.png")
