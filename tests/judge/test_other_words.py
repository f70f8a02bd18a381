"""A scene in other words, that were answered otherwise once: contacts in another order, another zero of time."""

from dataclasses import replace
from itertools import permutations

import numpy as np
import pytest

from benchmarks.judge.agree import disturbed
from benchmarks.judge.describe import Description
from benchmarks.judge.runs import run
from lcpstep import Status
from tests.judge.kept_jointed import JOINTED
from tests.judge.kept_recently import RECENTLY

# Thrown off together by an elastic wall, two plastic ones are met again one after the other, at 0.85 of the speeds
INTO_A_CORNER = Description(
    M=((0.889, 0.228, 0.253), (0.228, 1.41, 0.319), (0.253, 0.319, 1.74)), q0=(0.0, 0.0, 0.0),
    v0=(0.042089197239613185, -0.008110598907803175, -0.011619812416507239), t_span=(0.0, 1.2), h=0.0382,
    G=((-0.0564, -0.903, 0.426), (0.289, 0.143, 0.947), (-0.777, 0.516, 0.36)), offset=(0.0, 0.0, 0.426),
    restitution=(0.0, 1.0, 0.0), K=((0.0683, -0.0112, 0.0835), (-0.0112, 0.117, 0.0953), (0.0835, 0.0953, 0.281)),
    constant=(0.0, 0.0, -17.1), general=True, family="wedge",
)  # fmt: skip


@pytest.mark.parametrize("order", list(permutations(range(3))))
@pytest.mark.parametrize("method", ["located", "located-4", "located-tolerance"])
def test_a_body_comes_to_rest_in_a_corner_whatever_the_numbers_of_its_walls(method, order):
    rows = {
        name: tuple(getattr(INTO_A_CORNER, name)[i] for i in order) for name in ("G", "offset", "restitution")
    }
    r = run(replace(INTO_A_CORNER, **rows), method)
    assert r.done, r.text
    np.testing.assert_allclose(r.motion.v[-1], 0.0, atol=1e-14)


def test_a_body_that_rests_on_a_moving_wall_strikes_another_at_any_time():
    """Where it strikes it is put back onto the first, and not to where rounding has left it beside the second."""
    d = Description(
        M=((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)), q0=(-1.94, 1.26, 0.0611), v0=(0.0, 0.0, 0.0),
        t_span=(0.0, 0.4764), h=0.0397, G=((-0.65, -0.208, 0.73), (0.284, -0.887, 0.363), (0.826, 0.265, 0.497),
        (-0.28, 0.873, 0.399)), offset=(-0.890523, 1.6464007, 1.2704732999999997, -1.5676589),
        restitution=(0.43, 1.0, 1.0, 0.37), constant=(0.0, 0.0, -9.81), amplitude=(0.0636,) * 4, phase=(0.0,) * 4,
        omega=1.09,
    )  # fmt: skip
    later = replace(d, t_span=(64.0, 64.4764), phase=(-69.76,) * 4)
    a, b = (run(x, "located").motion.q[-1] for x in (d, later))
    np.testing.assert_allclose(a, b, atol=1e-11)


@pytest.mark.parametrize("method", ["located-4", "located-4-tolerance", "located-tolerance"])
def test_a_body_that_joints_and_smooth_walls_wedge_is_not_left_open(method):
    """Forces of the walls that press against each other may be any, the motion is none."""
    d = Description(
        M=((1.14, 0.0534), (0.0534, 0.54)), q0=(0.321, 0.236), v0=(0.0, 0.0), t_span=(0.0, 0.332647), h=0.0106,
        G=((-0.282, -1.64), (0.219, 0.0881)), offset=(0.47756199999999993, -0.0910906), restitution=0.037,
        K=((0.211, 0.238), (0.238, 0.272)), constant=(0.0, -5.3), cosine=(2.37, 0.825), sine=(-4.36, 0.499),
        force_omega=0.332, J=((1.1, -0.7),), joint_offset=(-0.18790000000000004,), general=True, pendulum=0.119,
        b=(0.46, 0.718), family="jointed",
    )  # fmt: skip
    r = run(d, method)
    assert r.status == "DONE"
    assert np.max(np.abs(r.motion.q - d.q0)) < 1e-12


def test_contacts_that_collapse_beside_a_plastic_one_do_so_told_as_curved_ones_too():
    """The plastic one, let go 2e-15 s before the other strikes, has no speed beyond rounding: it bears nothing."""
    d = RECENTLY["a rebounding and a plastic contact that collapse, told as curved ones"][0]
    flat, curved = (run(replace(d, gaps=gaps), "event-driven").motion for gaps in (False, True))
    t = np.linspace(0.0, 0.2, 50)
    np.testing.assert_allclose(curved.at(t)[0], flat.at(t)[0], rtol=0, atol=1e-12)


def test_contacts_collapse_alike_at_another_zero_of_time():
    """One kept its last rebound of 1e-6 m/s, at which time alone had closed the other."""
    d = RECENTLY["six contacts with walls that move, of which two collapse beside a third"][0]
    moved = replace(
        d, t_span=(64.0, 64.7821), phase=(-857.6, -852.63, -852.63, -857.6, -852.63, -852.63),
        cosine=(-416.1184714400546, 6.739413056808173, -9.668356284028603, 0.009952719704147092, -1061.623435109023,
        -131.75505132156624), sine=(-139.88001189016424, 2.2654826527085827, -3.2500595017760254,
        0.0033456494871223798, -356.86927862638714, -44.29002654381055),
    )  # fmt: skip
    at_zero, later = (run(x, "located-4").motion for x in (d, moved))
    np.testing.assert_allclose(later.q[-1], at_zero.q[-1], rtol=0, atol=1e-11)


def test_a_motion_that_left_all_bounds_has_companions_near_its_start():
    """Order 4 had gone to 1e36 m beside a round joint; 1e-12 of that is no start of the scene."""
    rod = Description(
        M=((1.0, 0.0), (0.0, 1.0)), q0=(0.6, 0.8), v0=(0.8, -0.6), t_span=(0.0, 1.0), h=0.1, J=((0.0, 0.0),),
        joint_offset=(-0.5,), joint_bend=(1.0,), family="jointed",
    )  # fmt: skip
    near = disturbed(rod, 1e-12, 1e36, 1).scene()
    assert 0.0 < np.max(np.abs(near.q0 - np.array(rod.q0))) < 0.1


def test_a_collapse_on_joints_ends_for_steps_of_order_four_as_event_by_event():
    """The plastic contact, let go between the impacts of one instant, had taken part in those of the elastic one."""
    d = JOINTED["an elastic and a plastic contact that collapse on two joints"][0]
    exact = run(d, "event-driven").motion
    errors = []
    for factor in (1.0, 0.5, 0.25):
        motion = run(d, "located-4", factor).motion
        assert motion.status == Status.DONE
        np.testing.assert_array_equal(motion.impacts.kind, exact.impacts.kind)
        errors.append(np.max(np.abs(motion.q - exact.at(motion.t)[0])))
    assert errors[0] < 2e-7
    assert errors[2] < errors[1] / 8.0 < errors[0] / 64.0
