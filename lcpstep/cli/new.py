"""`lcpstep new`: a commented file to start from, which runs as it stands."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from lcpstep.cli.common import DONE, save_text

TEMPLATE = '''"""NAME: what moves, what it may not cross, where it starts. Run it:

    lcpstep simulate FILE --method located --film NAME.gif
    lcpstep simulate FILE --method event-driven --set restitution=0.5 --picture NAME.png
    lcpstep compare FILE                         every method: error, CPU time, impacts
"""

import math

from lagrangian import Contacts, Scene, System
from lagrangian.drawing import Circle, Line

# A bead of 0.3 kg on a rod that turns in the plane, above a floor. Units: m, kg, s, rad.
# Every function gets the time t, coordinates q, velocities v, the parameters p in the order below, and fills `out`.
# Here q = (angle of the rod from below). Plain arithmetic and `math` are compiled; nothing is to be returned.
M, LENGTH, GRAVITY, DAMPING, FLOOR = range(5)  # places in p


def mass(t, q, v, p, out):
    """Mass matrix M(t, q); constant ones may be given as numbers."""
    out[0, 0] = p[M] * p[LENGTH] ** 2


def force(t, q, v, p, out):
    """All forces f in M v' = f, those of contacts left out: weight, and a damper at the pivot."""
    out[0] = -p[M] * p[GRAVITY] * p[LENGTH] * math.sin(q[0]) - p[DAMPING] * v[0]


def gap(t, q, v, p, out):
    """Distances from obstacles, which must stay positive: of the bead from the floor."""
    out[0] = p[FLOOR] - p[LENGTH] * math.cos(q[0])


def jacobian(t, q, v, p, out):
    """Their derivatives by the coordinates."""
    out[0, 0] = p[LENGTH] * math.sin(q[0])


def drawing(t, q):
    """What it looks like: points, lines, circles, polygons; `contacts` says which impacts a shape shows."""
    length, floor, radius = 0.5, 0.45, 0.03  # the gap is that of the bead's centre: the floor is drawn below it
    bead = (length * math.sin(q[0]), -length * math.cos(q[0]))
    return [
        Line([(-0.6, -floor - radius), (0.6, -floor - radius)], fixed=True),
        Line([(0.0, 0.0), bead]),
        Circle(bead, radius, contacts=(0,)),
    ]


def scene(angle=2.0, damping=0.01, restitution=0.8):
    """The question: `--set angle=1.0` changes a parameter."""
    parameters = {"m": 0.3, "length": 0.5, "g": 9.81, "damping": damping, "floor": 0.45}
    return Scene(
        system=System(n_q=1, mass=mass, force=force),
        contacts=Contacts(n_c=1, gap=gap, jacobian=jacobian, restitution=restitution),
        q0=angle,
        v0=0.0,
        t_span=(0.0, 5.0),
        parameters=parameters,
        coordinates=["angle [rad]"],
        drawing=drawing,
        name="NAME",
    )
'''


def add(commands: Any) -> None:
    """Arguments of the command."""
    p = commands.add_parser(
        "new",
        help="write a commented scene file to start from",
        description="Writes NAME.py, a scene of your own with comments, which runs as it stands.",
        epilog="Example: lcpstep new swing; lcpstep simulate swing.py --method located --film swing.gif",
    )
    p.add_argument("name", metavar="NAME", help="of the scene, and of its file")
    p.set_defaults(run=run_new)


def run_new(options: argparse.Namespace) -> int:
    """`lcpstep new`."""
    file = Path(options.name if options.name.endswith(".py") else f"{options.name}.py")
    if not file.stem.isidentifier():
        raise ValueError(f"NAME: expected letters, digits and underscores, as my_scene, got {file.stem!r}")
    if file.exists():
        raise FileExistsError(f"NAME: {file} exists already")
    save_text(TEMPLATE.replace("NAME", file.stem).replace("FILE", str(file)).rstrip("\n"), file)
    print(f"wrote {file}\nTry next: lcpstep simulate {file} --method located --film {file.stem}.gif")
    return DONE
