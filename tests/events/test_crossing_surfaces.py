"""Sliding on a surface where another crosses it. Constant fields in four quadrants: motions in closed form."""

import numpy as np
import pytest

from lagrangian import HybridScene, HybridSystem, Mode, Surface
from lcpstep import EventDriven, Status, simulate


def north_east(t, x, p, out):
    out[0], out[1] = -1.0, -0.5


def north_west(t, x, p, out):
    out[0], out[1] = 1.0, -0.5


def south_east(t, x, p, out):  # p: rates along both axes
    out[0], out[1] = -p[0], p[1]


def south_west(t, x, p, out):
    out[0], out[1] = p[0], p[1]


def across(t, x, p, out):
    out[0] = x[0]


def along(t, x, p, out):
    out[0] = x[1]


FIELDS = {"ne": north_east, "nw": north_west, "se": south_east, "sw": south_west}
SURFACES = {
    "north": Surface(across, "nw", "ne", "north"),
    "south": Surface(across, "sw", "se", "south"),
    "east": Surface(along, "se", "ne", "east"),
    "west": Surface(along, "sw", "nw", "west"),
}


def slid(p, surfaces=SURFACES):
    """From (0.3, 1): onto the axis at 0.3 s, down it to the origin at 2 s, one second further."""
    system = HybridSystem(2, {name: Mode(f) for name, f in FIELDS.items()}, list(surfaces.values()))
    return simulate(HybridScene(system, [0.3, 1.0], "ne", (0.0, 3.0), p=p), EventDriven())


@pytest.mark.parametrize(
    ("p", "modes", "end"),
    [
        ([1.0, -2.0], ["north", "south"], [0.0, -2.0]),  # attracted to the axis beyond as well
        ([-1.0, -2.0], ["north", "south", "sw"], [-1.0, -2.0]),  # thrown off it, to either side
    ],
)
def test_sliding_goes_on_in_what_lies_beyond_another_surface(p, modes, end):
    run = slid(p)
    assert (run.status, list(run.switches.target)) == (Status.DONE, modes), run.message
    np.testing.assert_allclose(run.x[-1], end, rtol=0, atol=1e-11)


def test_sliding_on_both_at_once_and_what_no_surface_parts_end_the_run_there():
    some = {name: SURFACES[name] for name in ("north", "east", "west")}
    for run, said in ((slid([1.0, 0.7]), "follow one another"), (slid([1.0, -2.0], some), "over the edge")):
        assert run.status == Status.ENDLESS_SWITCHING
        assert said in run.message
        np.testing.assert_allclose(np.r_[run.t[-1], run.x[-1]], [2.0, 0.0, 0.0], rtol=0, atol=1e-11)
