"""A scene in another program, as an FMU
=====================================

A scene is written as a functional mock-up unit (FMI 3, co-simulation) and stepped by FMPy, a program of others.
However long the communication steps are, the outputs are those of one run with located impacts.

Source: Modelica Association, Functional Mock-up Interface 3.0 (2022). Needs pythonfmu3 and FMPy: `pip install
"lcpstep[fmu]" fmpy`.
"""

import tempfile
from pathlib import Path

import fmpy
import numpy as np
from matplotlib.figure import Figure

from lagrangian import scenes
from lcpstep import Located, simulate
from lcpstep.export import fmu


def both(step: float = 0.1):
    """Rows that FMPy gets of the unit, and the run itself."""
    scene = scenes.bouncing_ball(t_end=5.0)
    with tempfile.TemporaryDirectory() as folder:
        unit = Path(folder) / "ball.fmu"
        fmu(scene, unit)
        rows = fmpy.simulate_fmu(str(unit), stop_time=5.0, output_interval=step)
    return rows, simulate(scene, Located(1e-3))


def picture(rows, run) -> Figure:
    """Height of the ball: the run as a line, the unit's outputs as points."""
    t = np.linspace(0.0, 5.0, 4001)
    figure = Figure(figsize=(7.5, 4.0), layout="constrained")
    ax = figure.subplots()
    ax.plot(t, run.at(t)[0][:, 0], "C0-", lw=1.0, label="lcpstep")
    ax.plot(rows["time"], rows["q0"], "ko", ms=4, mfc="none", label="FMPy, every 0.1 s")
    ax.set(xlabel="time t [s]", ylabel="height [m]", xlim=(0.0, 5.0), ylim=(0.0, 1.05))
    ax.legend(loc="upper right")
    ax.grid(alpha=0.3)
    return figure


def distance(rows, run) -> float:
    """The two, at most apart [m]."""
    return float(np.abs(rows["q0"] - run.at(rows["time"])[0][:, 0]).max())


if __name__ == "__main__":
    found = both()
    print(f"{len(found[0])} outputs, at most {distance(*found):.1e} m from the run")
    picture(*found).savefig("in-another-program.png")
