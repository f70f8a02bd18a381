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
    # Ends of chattering sequences were summed up although other feet struck before they came
    "four feet of different restitution": (
        Description(
            M=((1.0, 0.0), (0.0, 0.113)), q0=(0.0728, 0.134), v0=(0.0, 0.0), t_span=(0.0, 0.17003), h=0.00347,
            G=((1.0, -0.5), (1.0, -0.167), (1.0, 0.167), (1.0, 0.5)),
            offset=(-0.0058, -0.050422, -0.2196985761044801, -0.1398), restitution=(0.31, 0.2, 0.38, 0.99),
            K=((2.07, 2.41), (2.41, 22.7)), constant=(-9.81, 0.0), amplitude=(0.125, 0.125, 0.125, 0.125),
            phase=(0.0, 0.0, 4.8, 0.0), omega=0.772,
        ),
        ("event-driven", "event-driven-loose"),
    ),
    # The impulse that takes the speed of a sequence that is summed up was kept as a negative one
    "wedge of three walls": (
        Description(
            M=((0.807, 0.0406, 0.0425), (0.0406, 0.471, 0.0324), (0.0425, 0.0324, 0.514)), q0=(0.605, 0.812, 1.7),
            v0=(0.0, 0.0, 0.0), t_span=(0.0, 0.237427), h=0.000233,
            G=((0.8, 0.364, 0.477), (-0.146, 0.104, 0.984), (-0.0129, -0.133, 0.991)),
            offset=(-1.573468, -1.6334179999999998, 0.5411005), restitution=(0.61, 0.0, 0.0),
            K=((27700.0, -6630.0, -1060.0), (-6630.0, 57900.0, -12600.0), (-1060.0, -12600.0, 51700.0)),
            constant=(0.0, 0.0, -5.04), amplitude=(0.0905, 0.0905, 0.0905), phase=(0.0, 0.0, 0.0), omega=0.547,
            general=True, spread=0.409, pendulum=1.64, b=(-0.792, -1.03, 0.765),
        ),
        ("event-driven",),
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
    "a heavy body squeezes light ones against a wall": (
        Description(
            M=((13300.0, 0.0, 0.0, 0.0), (0.0, 7.77, 0.0, 0.0), (0.0, 0.0, 0.0014, 0.0), (0.0, 0.0, 0.0, 0.22)),
            q0=(0.0, 0.0, 0.0, 0.0), v0=(0.0, 0.0, 0.0, 0.0), t_span=(0.0, 4.2183), h=0.0981,
            G=((-1.0, 1.0, 0.0, 0.0), (0.0, -1.0, 1.0, 0.0), (0.0, 0.0, -1.0, 1.0), (1.0, 0.0, 0.0, 0.0),
               (0.0, 0.0, 0.0, -1.0)),
            offset=(0.0, 0.0375, 0.44, 0.0, 0.0), restitution=(0.58, 0.61, 0.0, 0.011, 0.0),
            sine=(1390.0, 0.747, 3.52e-05, -0.0136), force_omega=0.545, family="beads",
        ),
        ("event-driven", "located", "located-4", "located-exact"),
    ),
    "struck while at rest on two other contacts": (
        Description(
            M=((777.0, 0.0, 0.0), (0.0, 60.9, 0.0), (0.0, 0.0, 4.97)), q0=(0.0, 0.0, 0.0),
            v0=(-0.651, -1.13, -0.0721), t_span=(0.0, 35.1656), h=0.0904,
            G=((-0.358, 0.686, 0.371), (-0.788, 0.29, -1.24), (3.38, -0.888, 0.227)),
            offset=(0.13, 0.664, 0.0156), restitution=(0.3, 0.0, 0.0),
            K=((172.0, 51.2, 1.78), (51.2, 16.2, 0.159), (1.78, 0.159, 0.234)), constant=(488.0, -69.8, -5.2),
            function=True, family="square",
        ),
        ("located",),
    ),
    "a force that begins at zero presses on three walls": (
        Description(
            M=((0.000882, 0.0, 0.0), (0.0, 1.06, 0.0), (0.0, 0.0, 26.3)), q0=(1.34, 0.387, -1.08), v0=(0.0, 0.0,
            0.0), t_span=(0.0, 0.03444), h=0.00492, G=((-1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, 1.0)),
            offset=(1.34, 0.387, 1.08), restitution=(0.18, 1.0, 1.0), C=((0.000468, 0.0, 0.0), (0.0, 0.562, 0.0),
            (0.0, 0.0, 13.9)), constant=(0.4659431806835997, 3.6710674841738156, -1.9379000469340624),
            sine=(5.46e-05, -0.133, 29.0), force_omega=0.594, general=True, spread=0.221, pendulum=3.83, b=(-0.132,
            -1.04, 0.549), family="corner",
        ),
        ("located-tolerance",),
    ),
    "hidden by the rounding of its gaps": (
        Description(
            M=((1.0, 0.0), (0.0, 0.234)), q0=(0.472, -0.379), v0=(0.0, 0.0), t_span=(0.0, 5.918), h=0.0538,
            G=((1.0, -0.5), (1.0, -0.3), (1.0, -0.1), (1.0, 0.1), (1.0, 0.3), (1.0, 0.5)), offset=(2.4485, -0.5857,
            -0.5099, -0.37879999999999997, -0.33929999999999993, 1.0375), restitution=(0.0, 1.0, 0.0, 0.86, 0.056,
            1.0), C=((0.379, 0.0), (0.0, 0.0889)), constant=(-0.014868840046347032, -1.1761204666885854),
            general=True, spread=0.973, pendulum=0.602, b=(-0.0311, -2.46), family="feet",
        ),
        ("located-tolerance",),
    ),
    "seven contacts of three coordinates": (
        Description(
            M=((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)), q0=(0.308, -1.75, 1.16), v0=(0.0, 0.0, 0.0),
            t_span=(0.0, 0.569738), h=0.0411, G=((-1.29, 0.742, 0.268), (-0.418, -0.442, -0.944), (-0.649, -1.03,
            0.907), (1.51, 0.241, 0.853), (0.167, -0.0946, 0.988), (0.959, 1.18, -0.74), (2.3, -0.342, 0.663)),
            offset=(1.3849399999999998, 0.45028399999999985, -2.654728, -1.03281, -1.3630659999999999, 2.628028,
            -2.07598), restitution=(0.11, 0.51, 0.3, 0.0, 1.0, 0.82, 0.65), C=((1.64, 0.0, 0.0), (0.0, 1.64, 0.0),
            (0.0, 0.0, 1.64)), general=True, spread=0.689, pendulum=0.21, b=(-0.217, -0.868, 0.417),
            family="anything",
        ),
        ("located-4", "located-tolerance", "located-4-tolerance"),
    ),
    "parallel walls in a moving frame": (
        Description(
            M=((1.0, 0.0), (0.0, 1.0)), q0=(2.15, -1.81), v0=(0.0, 0.0), t_span=(0.0, 1.86027), h=0.00177, G=((0.2,
            -0.3), (0.5, -0.2), (-0.1, 1.8), (1.0, -0.4)), offset=(-0.9730000000000001, -1.437, 3.473, -2.874),
            restitution=0.18, K=((0.0354, -0.0349), (-0.0349, 0.334)), constant=(0.139279, -0.679575),
            frame=(-0.012, 0.00845), omega=29.0, family="redundant",
        ),
        ("located-tolerance",),
    ),
    "impulses between states that are kept": (
        Description(
            M=((0.46, 0.0), (0.0, 2.35)), q0=(0.0, 0.0), v0=(0.0, 0.0), t_span=(0.0, 0.076664), h=0.000259,
            G=((-0.79, 1.08), (-0.34, -0.436)), offset=(0.0, 0.0), restitution=1.0, K=((16600.0, -8330.0),
            (-8330.0, 8180.0)), constant=(-0.044, -1.61), cosine=(0.0444, -0.284), sine=(-0.0689, -0.611),
            force_omega=3.03, frame=(0.0037, 0.0199), omega=0.703, family="square",
        ),
        ("located-tolerance",),
    ),
    "three contacts strike at once": (
        Description(
            M=((81.3, 0.0), (0.0, 0.353)), q0=(0.0, 0.0), v0=(0.0, 0.0), t_span=(0.0, 0.002439), h=0.000813,
            G=((1.5, -0.9), (0.8, 0.2), (0.0, -0.2), (1.5, -0.9), (3.1, -0.5), (8.5, -2.1)),
            offset=(0.12257568003832042, 0.0, 0.10747568003832043, 0.09227568003832043, 3.04,
            -0.046137840019160214), restitution=(0.99, 0.99, 0.46, 0.9, 0.0, 0.53), K=((52.7, -3.87), (-3.87,
            0.319)), constant=(5.49, 0.00391), amplitude=(0.0998, 0.0, 0.0998, 0.0998, 0.0998, -0.0499),
            phase=(1.18, 1.18, 1.18, 1.18, 0.0, 1.18), omega=24.9, family="redundant",
        ),
        ("located-4-tolerance",),
    ),
    "motions near the smallest numbers": (
        Description(
            M=((0.32, 0.0, 0.0), (0.0, 2.89, 0.0), (0.0, 0.0, 1.81)), q0=(0.0, 0.0, 0.0), v0=(0.0, 0.0, 0.0),
            t_span=(1.04, 2.39), h=0.01, G=((0.9, 1.9, 0.3), (0.9, 1.9, 0.3)), offset=(0.0, 0.0), restitution=(0.0,
            0.36), K=((2.62, 8.38, -0.2), (8.38, 32.4, -7.11), (-0.2, -7.11, 14.1)), family="redundant",
        ),
        ("located-exact",),
    ),
    "elastic beads that rest, from rounding on": (
        Description(
            M=((0.492, 0.0), (0.0, 1.9)), q0=(0.0, 0.0), v0=(0.0, 0.0), t_span=(214.0, 219.44867), h=0.00287,
            G=((-1.0, 1.0), (1.0, 0.0)), offset=(0.0, 0.0), restitution=1.0, constant=(0.0, -18.6), sine=(0.1,
            1.59), force_omega=12.7, family="beads",
        ),
        ("located-4",),
    ),
    "elastic feet that rest, from rounding on": (
        Description(
            M=((1.0, 0.0), (0.0, 0.158)), q0=(0.0, 0.0), v0=(0.0, 0.0), t_span=(126.0, 127.45656), h=0.00119,
            G=((1.0, -0.5), (1.0, -0.167), (1.0, 0.167), (1.0, 0.5)), offset=(0.0, 0.0, 0.0, 0.0), restitution=1.0,
            K=((24.5, -121.0), (-121.0, 1200.0)), C=((0.301, -0.0459), (-0.0459, 0.501)), constant=(-9.81, 0.0),
            family="feet",
        ),
        ("located-4-tolerance",),
    ),
    "a curved joint turns a gap": (
        Description(
            M=((1.4, 0.0, 0.0, 0.0, 0.0), (0.0, 1.52, 0.0, 0.0, 0.0), (0.0, 0.0, 0.498, 0.0, 0.0), (0.0, 0.0, 0.0,
            2.52, 0.0), (0.0, 0.0, 0.0, 0.0, 1.99)), q0=(-0.00671, 0.338, 1.01, 0.685, -0.58), v0=(0.0, 0.0, 0.0,
            0.0, 0.0), t_span=(0.0, 0.2334), h=0.0778, G=((-1.44, 1.46, 1.07, 0.567, 1.13), (0.598, -1.53, 0.312,
            -0.302, 1.44), (-0.0216, 0.73, -0.999, -0.295, -1.03)), offset=(-1.2918374000000001,
            1.2481025799999999, 0.366780064), C=((0.131, 0.0, 0.0, 0.0, 0.0), (0.0, 0.142, 0.0, 0.0, 0.0), (0.0,
            0.0, 0.0466, 0.0, 0.0), (0.0, 0.0, 0.0, 0.236, 0.0), (0.0, 0.0, 0.0, 0.0, 0.186)), constant=(0.0, 0.0,
            0.0, 0.0, -19.5), J=((0.0, 0.0, 0.0, 0.0, 0.0),), joint_offset=(-0.9700070120500001,),
            joint_bend=(1.0,), general=True, family="jointed",
        ),
        ("located",),
    ),
    "two impacts, of which either may come first": (
        Description(
            M=((1.0, 0.0, 0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0, 0.0), (0.0, 0.0, 0.0,
            1.0, 0.0), (0.0, 0.0, 0.0, 0.0, 1.0)), q0=(-0.664, -1.1, -0.78, 0.663, 0.333), v0=(-0.6819999999999998,
            -0.6819999999999998, 0.95, 0.0, 0.0), t_span=(0.0, 2.6174), h=0.0569, G=((-1.0, 1.0, 0.0, 0.0, 0.0),
            (0.0, -1.0, 1.0, 0.0, 0.0), (0.0, 0.0, -1.0, 1.0, 0.0), (0.0, 0.0, 0.0, -1.0, 1.0), (-0.0, -0.0, -0.0,
            -0.0, -1.0)), offset=(0.43600000000000005, -0.25660000000000005, -1.333, 0.33, 0.333),
            restitution=0.76, C=((0.00971, 0.0, 0.0, 0.0, 0.0), (0.0, 0.00971, 0.0, 0.0, 0.0), (0.0, 0.0, 0.00971,
            0.0, 0.0), (0.0, 0.0, 0.0, 0.00971, 0.0), (0.0, 0.0, 0.0, 0.0, 0.00971)), constant=(0.0, 0.0, 0.0,
            -9.81, 0.0), family="beads",
        ),
        ("located-tolerance",),
    ),
    "pieces as short as the rounding of a joint": (
        Description(
            M=((1.09, 0.101, 0.151, 0.0864, 0.195), (0.101, 0.507, 0.103, 0.0589, 0.133), (0.151, 0.103, 1.13,
            0.088, 0.198), (0.0864, 0.0589, 0.088, 0.373, 0.114), (0.195, 0.133, 0.198, 0.114, 1.89)), q0=(-0.0803,
            -0.0298, -0.116, -0.0377, 0.604), v0=(-1.0937350746268655, -0.6037350746268658, -1.095929104477612,
            0.07073507462686576, 0.6253358208955224), t_span=(-361.0, -352.07972), h=0.0141, G=((-0.849, 1.26,
            0.855, 0.229, -0.294), (0.789, -2.58, -1.18, 0.583, 1.6)), offset=(0.2867626, -0.9558282),
            restitution=(0.69, 1.0), constant=(0.0, 0.0, 0.0, 0.0, -18.5), J=((0.7, 0.7, -1.7, -0.7, -1.0),),
            joint_offset=(0.45748,), general=True, pendulum=8.62, b=(-0.0195, 0.88, 1.47, -0.798, 0.18),
            family="jointed",
        ),
        ("located",),
    ),
    "a row of bodies of which the last alone is pressed": (
        Description(
            M=((0.000822, 0.0, 0.0, 0.0, 0.0), (0.0, 0.000784, 0.0, 0.0, 0.0), (0.0, 0.0, 0.00799, 0.0, 0.0), (0.0,
            0.0, 0.0, 0.0212, 0.0), (0.0, 0.0, 0.0, 0.0, 1770.0)), q0=(0.0, 0.0, 0.0, 0.0, 0.0), v0=(-0.0118,
            -0.0901, 0.0457, -0.135, 0.07), t_span=(0.0, 0.82), h=0.082, G=((-1.0, 1.0, 0.0, 0.0, 0.0), (0.0, -1.0,
            1.0, 0.0, 0.0), (0.0, 0.0, -1.0, 1.0, 0.0), (0.0, 0.0, 0.0, -1.0, 1.0), (1.0, 0.0, 0.0, 0.0, 0.0)),
            offset=(0.0, 0.0, 0.0, 0.0, 0.0), restitution=(0.96, 0.018, 0.0, 0.27, 0.95), constant=(-0.00806, 0.0,
            0.0, 0.0, 0.0), family="beads",
        ),
        ("located-4", "located-exact"),
    ),
}  # fmt: skip
