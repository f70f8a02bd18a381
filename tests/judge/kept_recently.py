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
    # The judge took what rounding of impulses adds up to over many steps for an open contact that presses
    "rest in the apex of five walls for two thousand steps": (
        Description(
            M=((2.15, 0.0, 0.0), (0.0, 0.322, 0.0), (0.0, 0.0, 1.75)), q0=(0.0, 0.0, 0.0), v0=(0.0, 0.0, 0.0),
            t_span=(0.0, 80.6128), h=0.0412,
            G=((0.875, 1.51, 0.182), (-0.0345, -0.432, -0.353), (0.173, -0.996, 0.109),
            (-0.357, 1.05, -1.11), (0.276, -0.448, 2.41)), offset=(0.0, 0.0, 0.0, 0.0, 0.0), restitution=(0.69, 0.48,
            0.93, 0.44, 1.0),
            C=((0.379, 0.0, 0.0), (0.0, 0.0567, 0.0), (0.0, 0.0, 0.308)), constant=(10.6, 2.35, 3.39),
            cosine=(-0.635, 0.187, -0.438), sine=(0.215, -0.105, 1.16), force_omega=2.81, family='anything',
        ),
        ("moreau",),
    ),
    # Interrupted by impacts of the others, hops of the elastic contact as low as rounding rose again, hop by hop
    "a body thrown into a corner of three walls, one of them elastic": (
        Description(
            M=((0.889, 0.228, 0.253), (0.228, 1.41, 0.319), (0.253, 0.319, 1.74)), q0=(0.0, 0.0, 0.0),
            v0=(0.042089197239613185, -0.008110598907803175, -0.011619812416507239), t_span=(0.0, 20.055), h=0.0382,
            G=((-0.0564, -0.903, 0.426), (0.289, 0.143, 0.947), (-0.777, 0.516, 0.36)), offset=(0.0, 0.0, 0.426),
            restitution=(0.0, 1.0, 0.0), K=((0.0683, -0.0112, 0.0835), (-0.0112, 0.117, 0.0953),
            (0.0835, 0.0953, 0.281)), constant=(0.0, 0.0, -17.1), omega=0.67, form=1, general=True, family='wedge',
        ),
        ("event-driven", "event-driven-loose"),
    ),
    # A pull of 20 N through bodies of 0.2 g that lie across it: steps too long for that find no way, and say so
    "a joint that hands the energy of a heavy body to light ones within a millisecond": (
        Description(
            M=((0.0225, 0.0, 0.0, 0.0), (0.0, 0.458, 0.0, 0.0), (0.0, 0.0, 0.000166, 0.0), (0.0, 0.0, 0.0, 0.000168)),
            q0=(1.47, 1.08, 0.0661, -1.2), v0=(-9.33764486981276, 7.725811932382462, 4.43840385993563,
            -4.240902147091625), t_span=(0.0, 0.2), h=0.00744, G=((1.33, -0.233, 0.163, 1.95),), offset=(1.9357657,),
            K=((2.96, 4.83, 0.0974, 0.0464), (4.83, 14.8, 0.0928, -0.111), (0.0974, 0.0928, 0.0107, 0.0119),
            (0.0464, -0.111, 0.0119, 0.0183)), constant=(0.0457, 3.23, -0.00109, 0.00133),
            J=((0.0, 0.0, 0.0, 0.0),), joint_offset=(-2.3858346050000003,), joint_bend=(1.0,), family='jointed',
        ),
        ("event-driven", "located", "located-4", "moreau"),
    ),
}  # fmt: skip
