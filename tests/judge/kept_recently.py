"""More scenes that have been wrong once, as in `kept` and `kept_lately`: they stay."""

from __future__ import annotations

from benchmarks.judge.describe import Description

RECENTLY: dict[str, tuple[Description, tuple[str, ...]]] = {
    # Let go by the rounding of forces that cancel, an elastic contact hopped on for ever
    "contacts beside a joint, pressed by forces that begin at zero": (
        Description(
            M=((0.475, 0.0, 0.0, 0.0), (0.0, 0.754, 0.0, 0.0), (0.0, 0.0, 0.392, 0.0), (0.0, 0.0, 0.0, 0.824)),
            q0=(-0.117, 0.19, 0.514, -0.67), v0=(0.0, 0.0, 0.0, 0.0), t_span=(0.0, 3.17057), h=0.0124,
            G=((-1.1, 0.597, 0.183, -0.309), (0.436, -1.6, -0.115, 0.847)), offset=(-0.5432220000000001,
            0.9816120000000002), restitution=(0.67, 1.0), C=((0.000796, 0.0, 0.0, 0.0), (0.0, 0.00126, 0.0, 0.0),
            (0.0, 0.0, 0.000657, 0.0), (0.0, 0.0, 0.0, 0.00138)), constant=(0.0536, -0.235, -0.0974,
            -0.1559999999999997), cosine=(-0.0536, 0.235, 0.0974, 0.156), sine=(-0.0351, 0.248, -0.0134, -0.0422),
            force_omega=1.85, J=((0.0, 0.0, 0.0, 0.0),), joint_offset=(-0.3814425,), joint_bend=(1.0,), general=True,
            family='jointed',
        ),
        ("located-4", "located-tolerance", "located-4-tolerance"),
    ),
    # The judge asked steps whose grids lie within each other: they all erred by the same
    "a contact that opens just after a step, at rest on a wall that moves": (
        Description(
            M=((1.0,),), q0=(0.0,), v0=(0.0,), t_span=(0.0, 14.0194), h=0.0367, G=((-1.0,),), offset=(0.0,),
            constant=(0.205,), amplitude=(0.157,), phase=(0.0,), omega=3.28, family='wall',
        ),
        ("located",),
    ),
    # It starts at rest on a surface and comes back to it: errors grow to their root, which no companion shows
    "a mass on a spring that grazes a bent wall once in every period": (
        Description(
            M=((1.0,),), q0=(0.0,), v0=(0.0,), t_span=(0.0, 16.2081), h=0.0172, G=((-1.47,),), offset=(0.36,),
            restitution=1.0, K=((48.8,),), constant=(-9.81,), force_omega=3.68, bend=(-0.36,), round=(1.0,),
            general=True, family='curved',
        ),
        ("event-driven-loose",),
    ),
    # The walls close upon it at t = 0.3499, as every run says; the depth that half a step explains had to shrink
    "a mass in a slit that its walls close, struck by each of them before": (
        Description(
            M=((1.02,),), q0=(-0.179,), v0=(0.0,), t_span=(0.0, 1.702), h=0.0115, G=((1.0,), (-1.0,)),
            offset=(0.179, -0.17769296484580815), restitution=(0.0, 0.15), cosine=(0.398,), sine=(0.179,),
            force_omega=5.05, amplitude=(-0.000815, 0.00163), phase=(0.0, 2.27), omega=12.3, form=1, family='slit',
        ),
        ("moreau",),
    ),
    # What the end of chattering owed was paid back by a negative impulse of the force that followed
    "a ball whose first hops are below the tolerance, on a wall that moves": (
        Description(
            M=((1.0,),), q0=(0.414,), v0=(0.0,), t_span=(0.0, 0.1456), h=0.0112, G=((1.0,),),
            offset=(-0.41630656659489856,), restitution=0.71, K=((49.1,),), constant=(0.0279,), sine=(-0.225,),
            force_omega=2.88, amplitude=(0.00337,), phase=(3.83,), omega=2.21, form=1, family='wall',
        ),
        ("event-driven-loose",),
    ),
    # The judge moved no place of a scene with joints when it asked what nearness of starts does
    "contacts beside a bent joint, masses over six decades": (
        Description(
            M=((0.0106, 0.0, 0.0), (0.0, 0.00134, 0.0), (0.0, 0.0, 4970.0)), q0=(-1.7, 1.16, 0.115),
            v0=(0.0, 0.0, 0.0), t_span=(-1.56, -0.72462), h=0.00351, G=((-1.64, -0.77, -0.815), (1.25, -0.888,
            -0.624)), offset=(-1.8010749999999998, 3.2268399999999997), K=((0.713, 0.0488, 696.0), (0.0488, 0.00874,
            20.1), (696.0, 20.1, 822000.0)), cosine=(-0.0136, 0.00681, -5820.0), sine=(-0.0406, 0.0068, 12900.0),
            force_omega=17.0, J=((0.0, 0.0, 0.0),), joint_offset=(-2.1244125,), joint_bend=(1.0,), general=True,
            family='jointed',
        ),
        ("located-tolerance", "located-4-tolerance"),
    ),
}  # fmt: skip
