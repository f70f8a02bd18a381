"""Bodies above floors and beside walls whose modes switch. Callbacks are plain functions of (t, x, p, out)."""

from lagrangian import Guard, HybridScene, HybridSystem, LinearContacts, Mode
from lcpstep import EventDriven

METHOD = EventDriven()
FLOOR, LIVELY = LinearContacts([[1.0]], restitution=0.7), LinearContacts([[1.0]], restitution=0.95)


def falls(t, x, p, out):  # p: gravity, its factor in the other mode, where that begins
    out[0], out[1] = x[1], -p[0]


def falls_otherwise(t, x, p, out):
    out[0], out[1] = x[1], -p[0] * p[1]


def below(t, x, p, out):
    out[0] = p[2] - x[0]


def above(t, x, p, out):
    out[0] = x[0] - p[2]


def later(t, x, p, out):
    out[0] = t - p[2]


def ball(modes, mode, x0, t_end, p, contacts=FLOOR, **more):
    return HybridScene(
        HybridSystem(2, modes, mass=[[2.0]]), x0, mode, (0.0, t_end), p=p, contacts=contacts, name="ball", **more
    )  # fmt: skip


def two_gravities(t_end=6.0, factor=2.0):
    modes = {"high": Mode(falls, [Guard(below, "low")]), "low": Mode(falls_otherwise, [Guard(above, "high")])}
    return ball(modes, "high", [1.0, 0.0], t_end, [9.81, factor, 0.4], LIVELY)


def soft(t, x, p, out):  # p: squares of the two frequencies, distance of the wall
    out[0], out[1] = x[1], -p[0] * x[0]


def stiff(t, x, p, out):
    out[0], out[1] = x[1], -p[1] * x[0]


def left(t, x, p, out):
    out[0] = -x[0]


def right(t, x, p, out):
    out[0] = x[0]


def bilinear_with_wall(t_end=30.0, r=0.8, wall=0.3, **more):
    modes = {"right": Mode(soft, [Guard(left, "left")]), "left": Mode(stiff, [Guard(right, "right")])}
    return HybridScene(
        HybridSystem(2, modes, mass=[[0.5]]), [1.0, 0.0], "right", (0.0, t_end), p=[1.0, 4.0, wall],
        contacts=LinearContacts([[1.0]], offset=wall, restitution=r), name="bilinear with wall", **more,
    )  # fmt: skip
