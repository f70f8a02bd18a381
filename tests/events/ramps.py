"""Systems of one coordinate with modes, in which it rises or falls steadily."""

from lagrangian import HybridScene, HybridSystem


def one(t, x, p, out):
    out[0] = 1.0


def minus_one(t, x, p, out):
    out[0] = -1.0


def position(t, x, p, out):
    out[0] = x[0]


def moving_ramp(modes, x0=-0.5, mode="a", t_end=10.0, surfaces=(), p=()):
    return HybridScene(HybridSystem(1, modes, surfaces), [x0], mode, (0.0, t_end), p=p)
