"""More of `kept`: scenes with joints.

One method of each was wrong; the comment says how.
"""

from benchmarks.judge.describe import Description

JOINTED = {
    # Where a force ended that another contact could bear, the forces were looked for a whole step later, and pulled
    "a body that three walls and a joint hold by more than it needs": (
        Description(
            M=((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)), q0=(0.0, 0.0, 0.0), v0=(0.0, 0.0, 0.0),
            t_span=(0.0, 12.6451), h=0.0196, restitution=0.82,
            G=((-0.161, -0.395, 2.14), (0.684, -0.628, -1.36), (0.138, 0.345, 0.534)), offset=(0.0, 0.0, 0.0),
            K=((1.25, 0.299, -0.474), (0.299, 0.626, 0.129), (-0.474, 0.129, 0.3)), constant=(0.0, 0.0, -9.81),
            cosine=(4.1, 1.5, 6.94), sine=(9.54, 1.86, -2.72), force_omega=4.63, J=((-0.3, 0.4, -0.2),),
            joint_offset=(-0.0,), function=True, family='jointed',
        ),
        ("located-4",),
    ),
    # What looked for the impact had put the joint right along other directions than the step that was taken then
    "a light mass whirled round a joint in a few steps": (
        Description(
            M=((1170.0, 0.0, 0.0, 0.0), (0.0, 0.0218, 0.0, 0.0), (0.0, 0.0, 11.1, 0.0), (0.0, 0.0, 0.0, 2420.0)),
            q0=(-1.35, -0.158, -0.219, 1.06), v0=(0.0, 0.0, 0.0, 0.0), t_span=(0.0, 0.289691), h=0.000747,
            G=((0.782, -2.11, -1.18, -0.954), (-0.00492, 2.1, 0.993, -0.0473)),
            offset=(1.5336400000000001, 0.606163), restitution=(0.82, 0.85),
            K=((25600000.0, 11200.0, 2220000.0, -566000.0), (11200.0, 160.0, -1410.0, 68700.0),
            (2220000.0, -1410.0, 324000.0, -1370000.0), (-566000.0, 68700.0, -1370000.0, 37800000.0)),
            C=((9040.0, 3.91, 774.0, -197.0), (3.91, 0.0581, -0.49, 23.9), (774.0, -0.49, 114.0, -476.0),
            (-197.0, 23.9, -476.0, 13500.0)), constant=(0.0, 0.0, 0.0, -23700.0),
            cosine=(-403.0, -0.00479, 6.3, -480.0), sine=(-37.6, -0.00685, -2.56, 54.7), force_omega=13.1,
            J=((0.0, 0.0, 0.0, 0.0),), joint_offset=(-1.5095125,), joint_bend=(1.0,), family='jointed',
        ),
        ("located",),
    ),
    "five masses from half a gram to nine tonnes on a sphere, long before time zero": (
        Description(
            M=((0.162, 0.0, 0.0, 0.0, 0.0), (0.0, 743.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.000477, 0.0, 0.0),
            (0.0, 0.0, 0.0, 9160.0, 0.0), (0.0, 0.0, 0.0, 0.0, 59.3)), q0=(-0.0278, -0.989, -1.19, 1.0, -0.206),
            v0=(-0.5131421205676158, -1.4174157281069044, -0.4115871753763563, -1.797405734977852,
            0.5265655814054375), t_span=(-23500.0, -23497.7354), h=0.0169, G=((-0.604, 2.19, 1.22, 1.64, 0.302),),
            offset=(2.0979308000000003,), restitution=0.072,
            C=((0.000906, 0.0, 0.0, 0.0, 0.0), (0.0, 4.17, 0.0, 0.0, 0.0), (0.0, 0.0, 2.67e-06, 0.0, 0.0),
            (0.0, 0.0, 0.0, 51.4, 0.0), (0.0, 0.0, 0.0, 0.0, 0.332)), constant=(0.0, 0.0, 0.0, 0.0, -582.0),
            J=((0.0, 0.0, 0.0, 0.0, 0.0),), joint_offset=(-1.7187149199999998,), joint_bend=(1.0,), family='jointed',
        ),
        ("located",),
    ),
}  # fmt: skip
