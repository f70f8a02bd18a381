"""Scenes that were wrong at loose tolerances once, as in `kept` and the others: they stay."""

from __future__ import annotations

from benchmarks.judge.describe import Description

LOOSE: dict[str, tuple[Description, tuple[str, ...]]] = {
    # Steps longer than its periods made it swing; a contact was let go before the step in which it was
    "three walls, at rest where the forces of springs balance": (
        Description(
            M=((0.869, 0.0, 0.0), (0.0, 0.342, 0.0), (0.0, 0.0, 0.702)),
            q0=(-0.295, -0.015, -0.384),
            v0=(0.0, 0.0, 0.0),
            t_span=(0.0, 89.97),
            h=0.0136,
            G=((0.0595, -1.29, 1.6), (-0.666, 1.57, 1.82), (-0.989, -0.186, 0.326)),
            offset=(0.6126025, 0.5259600000000001, -0.16936099999999998),
            restitution=0.72,
            K=((5.67, 2.55, 6.54), (2.55, 2.88, 9.8), (6.54, 9.8, 42.8)),
            C=((0.135, 0.0098, 0.0251), (0.0098, 0.0557, 0.0376), (0.0251, 0.0376, 0.256)),
            constant=(-4.22226, -4.55865, -18.511499999999998),
            family="square",
        ),
        ("event-driven-loose",),
    ),
    # Held by surfaces that close, it has no bounds: that is no failure of a callback
    "a body squeezed out between two walls that become parallel": (
        Description(
            M=((0.429, 0.0), (0.0, 0.435)),
            q0=(0.0, 0.0),
            v0=(0.0, 0.0),
            t_span=(0.0, 0.103545),
            h=0.000295,
            G=((-0.0973, -0.395), (1.3, -1.24), (1.15, 1.7)),
            offset=(0.556, 0.0, 0.4476583063254653),
            restitution=(0.0, 0.81, 0.4),
            K=((99200.0, 57400.0), (57400.0, 49800.0)),
            constant=(0.034, -0.22499999999999964),
            cosine=(-0.034, 0.225),
            force_omega=6.3,
            amplitude=(0.406, -0.203, 0.406),
            phase=(0.0, 0.0, 1.82),
            omega=11.9,
            bend=(-0.556, 0.916, -0.349),
            round=(1.0, 0.0, 0.0),
            family="curved",
        ),
        ("event-driven-loose",),
    ),
    # The same in space
    "a body held by three bent walls until they close": (
        Description(
            M=((0.362, 0.0, 0.0), (0.0, 2.65, 0.0), (0.0, 0.0, 1.43)),
            q0=(0.0, 0.0, 0.0),
            v0=(0.0, 0.0, 0.0),
            t_span=(0.0, 0.07833),
            h=0.00373,
            G=((1.93, -1.43, 1.38), (-0.395, -0.498, -0.312), (-0.26, 0.885, 0.0842)),
            offset=(0.2745674464638197, 0.18689999999999998, -0.006183723231909858),
            restitution=0.33,
            constant=(0.0, 0.0, -14.0),
            amplitude=(0.0236, 0.0236, -0.0118),
            phase=(2.59, 0.0, 2.59),
            omega=8.92,
            bend=(-0.874, -0.623, 0.217),
            round=(0.3, 0.3, 0.0),
            family="curved",
        ),
        ("event-driven", "event-driven-loose"),
    ),
    # The steps' error took it through the wall it had left: it was held there while it pulled
    "a bent wall that lets a falling mass go": (
        Description(
            M=((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)),
            q0=(0.0754, -1.06, 0.493),
            v0=(0.0, 0.0, 0.0),
            t_span=(649.0, 662.8632),
            h=0.0248,
            G=((1.99, 0.233, 1.14),),
            offset=(-0.06295547344867809,),
            restitution=0.16,
            C=((0.0895, 0.0, 0.0), (0.0, 0.0895, 0.0), (0.0, 0.0, 0.0895)),
            constant=(0.0, 0.0, -9.81),
            amplitude=(0.00692,),
            phase=(0.0,),
            omega=0.67,
            form=1,
            bend=(-0.327,),
            round=(0.3,),
            general=True,
            spread=0.564,
            pendulum=0.289,
            b=(0.409, -0.166, -0.359),
            family="curved",
        ),
        ("event-driven-loose",),
    ),
    # The same, by rounding of the state
    "six feet, one of which is struck by another's hops": (
        Description(
            M=((1.0, 0.0), (0.0, 0.193)),
            q0=(0.619, -0.79),
            v0=(0.357, -0.0253),
            t_span=(0.0, 0.575172),
            h=0.0631,
            G=((1.0, -0.5), (1.0, -0.3), (1.0, -0.1), (1.0, 0.1), (1.0, 0.3), (1.0, 0.5)),
            offset=(-1.014, -0.856, -0.698, -0.54, -0.382, -0.22399999999999998),
            restitution=(0.53, 0.0059, 0.95, 0.7, 0.93, 0.0),
            K=((0.265, 0.0354), (0.0354, 1.83)),
            constant=(-9.81, 0.0),
            family="feet",
        ),
        ("event-driven",),
    ),
}
