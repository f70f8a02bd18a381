"""Scenes that have been wrong once, by what was wrong: they stay. Each is judged by every method it names, or by all.

A scene is added when what it showed is mended: `python -m benchmarks.judge --shrink 60` prints it small.
"""

from __future__ import annotations

from benchmarks.judge.describe import Description
from benchmarks.judge.runs import WAYS

ALL = tuple(WAYS)

KEPT: dict[str, tuple[Description, tuple[str, ...]]] = {
    # A bowl, where hops by quadrature may be too long: a short span, in which they are not
    "bowl, short": (
        Description(
            M=((1.0, 0.0), (0.0, 1.0)), q0=(0.5, -0.2), v0=(0.0, 0.0), t_span=(0.0, 2.0), h=0.005,
            G=((0.0, 0.0),), offset=(1.0,), bend=(-1.0,), round=(1e-9,), restitution=0.6, constant=(0.0, -9.81),
        ),
        ("event-driven", "located", "located-4", "moreau"),
    ),
    "slit under a force that changes sign": (
        Description(
            M=((1.0,),), q0=(0.0,), v0=(0.4,), t_span=(0.0, 2.0), h=0.0137, G=((1.0,), (-1.0,)), offset=(0.0, 0.0),
            K=((33.5,),), C=((0.8,),), sine=(0.36,), force_omega=3.05,
        ),
        ("event-driven", "moreau"),
    ),
    "contact force that starts at zero": (
        Description(
            M=((2.0, 0.0), (0.0, 3.0)), q0=(0.3, 1.3), v0=(0.0, 0.0), t_span=(0.0, 1.2), h=0.012, G=((1.0, 0.0),),
            offset=(-0.3,), K=((40.0, -40.0), (-40.0, 40.0)), constant=(-40.0, 40.0),
        ),
        ("event-driven", "located", "moreau"),
    ),
    "chattering on a table": (
        Description(
            M=((1.0,),), q0=(0.02,), v0=(0.0,), t_span=(0.0, 1.0), h=0.0015, G=((1.0,),), offset=(0.0,),
            restitution=0.3, constant=(-9.81,), amplitude=(0.01,), phase=(0.0,), omega=40.0,
        ),
        ("event-driven", "located", "located-4", "located-exact", "moreau"),
    ),
    "lifted off a corner, far from time zero": (
        Description(
            M=((1.0, 0.0), (0.0, 1.0)), q0=(-0.193, 2.24), v0=(0.0, 0.0), t_span=(7140.0, 7140.0565), h=0.0565,
            G=((1.0, 0.0), (0.0, -1.0)), offset=(0.193, 2.24), restitution=(0.0, 1.0),
            K=((0.486, -0.119), (-0.119, 0.303)), constant=(-1.61, -0.347),
        ),
        ("located-tolerance", "located-4-tolerance", "moreau-tolerance"),
    ),
    "sliding on for thousands of steps": (
        Description(
            M=((1.0, 0.0), (0.0, 1.0)), q0=(1.0, 0.0), v0=(0.0, 0.0), t_span=(0.0, 20.0), h=0.05, G=((0.0, 1.0),),
            offset=(0.0,), restitution=0.5, K=((9.0, 0.0), (0.0, 0.0)), constant=(0.0, -9.81),
        ),
        ("located-tolerance",),
    ),
    "touched at the very beginning of a step": (
        Description(
            M=((0.662, 0.269), (0.269, 3.69)), q0=(0.0, 0.0), v0=(0.0, 0.0), t_span=(0.0, 0.0135), h=0.0135,
            G=((1.6, 0.4), (0.6, 0.5), (1.6, 0.4), (2.2, 0.9), (8.2, 3.1)),
            offset=(0.0182, 0.0258, 0.0, 0.0626, 0.013877113161323678), restitution=(0.33, 0.37, 0.0, 0.26, 1.0),
            amplitude=(0.194, 0.0, 0.194, 0.194, 0.194), phase=(0.0, 0.0, 0.0, 0.0, 3.07), omega=3.42,
        ),
        ("located-4-tolerance",),
    ),
}  # fmt: skip
