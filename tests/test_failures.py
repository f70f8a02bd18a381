"""What goes wrong during a run: named, with time and state, and without losing what was computed before."""

import math
import re

import numpy as np
import pytest

from lagrangian import Contacts, Coulomb, Joints, LinearContacts, LinearJoints, LinearSystem, Scene, System
from lcpstep import EventDriven, Located, Moreau, SimulationError, simulate
from lcpstep.callbacks import compiling
from lcpstep.trajectory import Status
from tests.falling import FALLING, FLOOR, run

T_BAD = 0.3  # from here on callbacks go wrong


def bad_force(t, q, v, p, out):
    out[0] = -8.0 if t < 0.3 else math.nan


def infinite_force(t, q, v, p, out):
    out[0] = -8.0 if t < 0.3 else math.inf


def bad_mass(t, q, v, p, out):
    out[0, 0] = 1.0 if t < 0.3 else math.nan


def singular_mass(t, q, v, p, out):
    out[0, 0] = 1.0 if t < 0.3 else 0.0


def negative_mass(t, q, v, p, out):
    out[0, 0] = 1.0 if t < 0.3 else -1.0


def infinite_mass(t, q, v, p, out):
    out[0, 0] = 1.0 if t < 0.3 else math.inf


def weight(t, q, v, p, out):
    out[0] = -8.0


def bad_frame(t, q, v, p, out):
    out[0, 0], out[0, 1], out[0, 2] = 0.0, 0.0, 0.0 if t < 0.3 else math.nan


def bad_motion(t, q, v, p, out):
    out[0, 0], out[0, 1], out[0, 2] = 0.0 if t < 0.3 else math.nan, 0.0, 0.0


def bad_motion_speed(t, q, v, p, out):
    out[0, 0], out[0, 1], out[0, 2] = 0.0, 0.0 if t < 0.3 else math.nan, 0.0


def gap(t, q, v, p, out):
    out[0] = q[0]


def bad_gap(t, q, v, p, out):
    out[0] = q[0] if t < 0.3 else math.nan


def jacobian(t, q, v, p, out):
    out[0, 0] = 1.0


def bad_jacobian(t, q, v, p, out):
    out[0, 0] = 1.0 if t < 0.3 else math.nan


def bad_gap_t(t, q, v, p, out):
    out[0] = 0.0 if t < 0.3 else math.nan


def bad_force_q(t, q, v, p, out):
    out[0, 0] = 0.0 if t < 0.3 else math.nan


def zero(t, q, v, p, out):
    out[0, 0] = 0.0


SPEED = LinearContacts(G=1.0, restitution=0.5, motion=bad_motion_speed)
CULPRITS = [
    ("system.force", LinearSystem(M=1.0, force=bad_force), FLOOR),
    ("system.force", LinearSystem(M=1.0, force=infinite_force), FLOOR),
    ("system.force", LinearSystem(M=1.0, force=bad_force), None),
    ("system.force", System(1, 1.0, bad_force), FLOOR),
    ("system.frame", LinearSystem(M=1.0, force=-8.0, frame=bad_frame), FLOOR),
    ("system.mass", System(1, bad_mass, weight), FLOOR),
    ("system.mass", System(1, singular_mass, weight), FLOOR),
    ("system.mass", System(1, negative_mass, weight), FLOOR),
    ("system.mass", System(1, infinite_mass, weight), FLOOR),
    ("contacts.motion", FALLING, LinearContacts(G=1.0, restitution=0.5, motion=bad_motion)),
    ("contacts.motion", FALLING, SPEED),
    ("contacts.gap", FALLING, Contacts(1, bad_gap, jacobian)),
    ("contacts.jacobian", FALLING, Contacts(1, gap, bad_jacobian)),
    ("contacts.gap_t", FALLING, Contacts(1, gap, jacobian, gap_t=bad_gap_t)),
]
IDS = [
    "force", "infinite force", "force without contact", "force of a general system", "frame", "mass",
    "singular mass", "negative mass", "infinite mass", "motion", "speed of the motion", "gap", "jacobian", "gap_t",
]  # fmt: skip
METHODS = [
    pytest.param(Moreau(1e-2), id="moreau"),
    pytest.param(Moreau(1e-2, theta=0.0), id="moreau, explicit"),
    pytest.param(EventDriven(), id="event-driven"),
    pytest.param(Located(1e-2), id="located"),
    pytest.param(Located(1e-2, order=4), id="order four"),
]


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(("name", "system", "contacts"), CULPRITS, ids=IDS)
def test_a_callback_that_goes_wrong_is_named_with_time_and_state(name, system, contacts, method):
    with pytest.raises(SimulationError, match=rf"{name}: .*t = 0\.\d+.*q = \[.*v = \[") as caught:
        run(system, contacts, method)
    m = caught.value.trajectory
    assert m.status is Status.NOT_FINITE
    assert str(caught.value) == m.message
    # up to a step before it (of Moreau 0.01 s, of the event-driven run a fiftieth of the span); what only a closed
    # contact asks for is noticed at the impact at 0.5 s, which Moreau predicts half a step early or late
    latest = 0.5 if name in ("contacts.jacobian", "contacts.gap_t") or contacts is SPEED else T_BAD
    assert 0.25 <= m.t[-1] <= latest + 2e-2
    assert np.all(np.isfinite(m.q))
    assert np.all(np.isfinite(m.v))
    # free fall, which the method knows exactly for theta = 1/2, and to order h for theta = 0
    np.testing.assert_allclose(m.q[:, 0], 1.0 - 4.0 * m.t**2, rtol=0, atol=4 * 1e-2 * latest + 1e-12)


def ends_without_a_gap(t, q, v, p, out):
    out[0] = q[0] if t < 1.0 - 1e-9 else math.nan


def upwards(t, q, v, p, out):
    out[0, 0] = 1.0


@pytest.mark.parametrize("method", [Moreau(0.1), Moreau(0.1, tolerance=1e-3), Located(0.1)], ids=repr)
def test_a_gap_that_is_no_number_in_the_last_step_is_told(method):
    contacts = Contacts(1, ends_without_a_gap, upwards)
    scene = Scene(LinearSystem(1.0), q0=1.0, v0=1.0, t_span=(0.0, 1.0), contacts=contacts)
    with pytest.raises(SimulationError, match="gap"):
        simulate(scene, method)


@pytest.mark.parametrize("method", METHODS)
def test_the_state_in_the_message_is_that_of_the_time_in_the_message(method):
    with pytest.raises(SimulationError) as caught:
        run(FALLING, LinearContacts(G=1.0, motion=bad_motion), method)
    m = caught.value.trajectory
    assert f"at t = {m.t[-1]:.9g} s, q = {m.q[-1].tolist()}, v = {m.v[-1].tolist()}" in m.message


@pytest.mark.parametrize("method", METHODS)
def test_a_jacobian_that_only_steers_is_named_too(method):
    if not isinstance(method, Moreau) or method.theta == 0.0:
        return  # it is not asked for
    with pytest.raises(SimulationError, match=r"system\.force_q: "):
        run(System(1, 1.0, weight, bad_force_q, zero), FLOOR, method)


@pytest.mark.parametrize("method", METHODS)
def test_a_callback_that_raises_in_plain_python_does_not_lose_the_motion(method):
    compiling.TOLD.clear()  # that there is no numba is told but once
    seen = []

    def breaks(t, q, v, p, out):
        seen.append(t)  # cannot be compiled
        if t > 0.3:
            raise RuntimeError("the spring broke")
        out[0] = -8.0

    with (
        pytest.warns(UserWarning, match="plain Python"),
        pytest.raises(SimulationError, match="spring broke") as caught,
    ):
        run(LinearSystem(M=1.0, force=breaks), FLOOR, method)
    assert 0.25 <= caught.value.trajectory.t[-1] <= 0.31


def breaks_compiled(t, q, v, p, out):
    if t > 0.3:
        raise ValueError("the spring broke")
    out[0] = -8.0


def forgets(t, q, v, p, out):
    out[0] = 0.0
    if t <= 0.3:
        out[1] = -8.0


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
@pytest.mark.parametrize("method", METHODS)
def test_a_compiled_callback_that_raises_is_not_passed_over(method):
    with pytest.raises(SimulationError, match="spring broke") as caught:
        run(System(1, 1.0, breaks_compiled), FLOOR, method)
    assert 0.25 <= caught.value.trajectory.t[-1] <= 0.31


@pytest.mark.parametrize("method", METHODS)
def test_an_entry_that_a_callback_leaves_out_later_is_noticed(method):
    scene = Scene(System(2, np.eye(2), forgets), [0.0, 1.0], [0.0, 0.0], (0.0, 1.0))
    with pytest.raises(SimulationError, match=r"system\.force: .*not filled"):
        simulate(scene, method)


def root_of_time(t, q, v, p, out):
    out[0] = -8.0 * math.sqrt(0.3 - t)


@pytest.mark.parametrize("method", METHODS)
def test_a_function_outside_of_its_domain_is_named(method):
    with pytest.raises(SimulationError, match=r"system\.force: "):
        run(LinearSystem(M=1.0, force=root_of_time), FLOOR, method)


def drifting_apart(t, q, v, p, out):
    """Two joints that agree at t = 0 up to the second derivative."""
    out[0, 0], out[0, 1], out[0, 2] = math.sin(t) - t, math.cos(t) - 1.0, -math.sin(t)
    out[1, 0], out[1, 1], out[1, 2] = 0.0, 0.0, 0.0


@pytest.mark.parametrize("method", [Moreau(1e-2), EventDriven()])
def test_joints_that_come_to_contradict_each_other_end_the_run(method):
    joints = LinearJoints([[1.0], [1.0]], motion=drifting_apart)
    m = simulate(Scene(LinearSystem(M=1.0), 0.0, 0.0, (0.0, 1.0), joints=joints), method)
    assert m.status is Status.JOINTS_FAILED
    assert "contradict" in m.message
    assert m.t[-1] < 0.1


# --- statuses


def never_converges(t, q, v, p, out):
    # steep and bent: the velocity of the next step has no solution
    out[0] = 1e6 * q[0] ** 2 + 1e6


def test_a_step_that_does_not_converge_is_a_status_with_the_part_before():
    m = simulate(Scene(System(1, 1.0, never_converges), 1.0, 0.0, (0.0, 1.0)), Moreau(1e-2))
    assert m.status is Status.NEWTON_FAILED
    assert "smaller h" in m.message
    assert "t = 0" in m.message
    assert m.t[-1] < 1.0


@pytest.mark.parametrize("keep", [10**6, "impacts", [0.1], [0.9]], ids=str)
@pytest.mark.parametrize("method", METHODS)
def test_what_was_computed_before_a_failure_is_told_whatever_is_kept(method, keep):
    with pytest.raises(SimulationError) as caught:
        simulate(Scene(System(1, 1.0, bad_force), 1.0, 0.0, (0.0, 1.0), FLOOR), method, keep=keep)
    m = caught.value.trajectory
    t, q, v = (float(x) for x in re.findall(r"at t = (\S+) s, q = \[(\S+)\], v = \[(\S+)\]", m.message)[-1])
    assert 0.28 <= t <= 0.3 + 1e-9
    assert v == pytest.approx(-8.0 * t, abs=1e-9)
    assert q == pytest.approx(1.0 - 4.0 * t**2, abs=4.0 * 1e-2 * t)  # to order h for theta = 0
    if isinstance(keep, list):
        assert m.t.tolist() == [x for x in keep if x < t]
    else:
        assert m.t[-1] == pytest.approx(t, abs=1e-8)
        assert (m.q[-1, 0], m.v[-1, 0]) == (q, v)


def level(t, q, v, p, out):
    out[0] = q[1]


def spoilt_level(t, q, v, p, out):
    out[0, 0], out[0, 1] = 0.0, 1.0 if t <= 0.5 else math.nan


def along(t, q, v, p, out):
    out[0, 0], out[0, 1] = 1.0, 0.0


def spoilt_along(t, q, v, p, out):
    out[0, 0], out[0, 1] = 1.0 if t <= 0.5 else math.nan, 0.0


def upright(t, q, v, p, out):
    out[0, 0], out[0, 1] = 0.0, 1.0


def spoilt_gap(t, q, v, p, out):
    out[0] = q[1] if t <= 0.5 else math.nan


def spoilt_floor(t, q, v, p, out):
    out[0, 0], out[0, 1], out[0, 2] = 0.0 if t <= 0.5 else math.nan, 0.0, 0.0


def spoilt_lift(t, q, v, p, out):
    out[0] = q[1] - t * t if t <= 0.5 else math.nan


def lift_t(t, q, v, p, out):
    out[0] = -2.0 * t


ROUGH = Coulomb(mu=0.1, tangent=along)
AT_REST = {
    "contacts.jacobian of what slides": {"contacts": Contacts(1, level, spoilt_level, friction=ROUGH)},
    "contacts.jacobian of what rests": {"contacts": Contacts(1, level, spoilt_level)},
    "contacts.gap": {"contacts": Contacts(1, spoilt_gap, upright)},
    "contacts.motion": {"contacts": LinearContacts([[0.0, 1.0]], motion=spoilt_floor)},
    "friction.tangent": {
        "contacts": Contacts(1, level, upright, friction=Coulomb(mu=0.1, tangent=spoilt_along))
    },
    "joints.gap": {"joints": Joints(1, spoilt_lift, upright, lift_t)},
}


@pytest.mark.parametrize(
    "method",
    [
        *(EventDriven(), Located(1e-2), Located(1e-2, order=4)),
        *(Located(1e-2, tolerance=1e-5), Located(1e-2, order=4, tolerance=1e-5)),
    ],
    ids=["event-driven", "located", "order four", "by a tolerance", "order four by a tolerance"],
)
@pytest.mark.parametrize("name", AT_REST)
def test_what_goes_wrong_while_a_contact_is_closed_is_no_lack_of_forces(name, method):
    system = LinearSystem(M=np.eye(2), force=[0.0, -10.0])
    scene = Scene(system, q0=[0.0, 0.0], v0=[1.0, 0.0], t_span=(0.0, 0.8), **AT_REST[name])
    with pytest.raises(SimulationError, match=rf"^{name.split()[0]}: .*not finite") as caught:
        simulate(scene, method)
    m = caught.value.trajectory
    assert m.status is Status.NOT_FINITE
    assert 0.4 <= m.t[-1] <= 0.52
    assert "nan" not in str(caught.value).rpartition(" s, q = ")[2]
    rough = scene.contacts is not None and scene.contacts.friction is not None
    expected = np.stack([m.t - 0.5 * rough * m.t**2, (scene.n_j > 0) * m.t**2], axis=1)  # mu g = 1
    before = m.t <= 0.5  # a step that failed may end in the air
    np.testing.assert_allclose(m.q[before], expected[before], rtol=0, atol=1e-9)


def endless_level(t, q, v, p, out):
    out[0, 0], out[0, 1] = 0.0, 1.0 if t <= 0.1 else math.inf


@pytest.mark.parametrize("method", [EventDriven(), Located(1e-2), Located(1e-2, order=4)])
def test_an_infinite_jacobian_ends_the_run_of_what_falls_towards_a_rough_floor(method):
    contacts = Contacts(1, level, endless_level, friction=ROUGH)
    system = LinearSystem(M=np.eye(2), force=[0.0, -10.0])
    scene = Scene(system, q0=[0.0, 0.2], v0=[1.0, 0.0], t_span=(0.0, 0.8), contacts=contacts)
    with pytest.raises(SimulationError, match=r"^contacts\.jacobian: .*inf") as caught:
        simulate(scene, method)
    assert 0.1 <= caught.value.trajectory.t[-1] < 0.2 + 1e-9  # the impact, whose impulse nobody knows


def late_level(t, q, v, p, out):
    out[0, 0], out[0, 1] = 0.0, 1.0 if t <= 0.8 - 5e-5 else math.nan


def lift(t, q, v, p, out):
    out[0] = q[1] - t * t


@pytest.mark.parametrize(("keep", "states"), [(1, 80), (7, 13), ("impacts", 2), ([0.3, 0.6], 2)], ids=str)
def test_impulses_of_the_step_that_fails_are_not_handed_over(keep, states):
    scene = Scene(
        LinearSystem(M=np.eye(2), force=[0.0, -10.0]), q0=[0.0, 0.0], v0=[1.0, 0.0], t_span=(0.0, 0.8),
        contacts=Contacts(1, lift, late_level, lift_t),
    )  # fmt: skip
    with pytest.raises(SimulationError, match=r"^contacts\.jacobian: ") as caught:
        simulate(scene, Located(1e-2, order=4), keep=keep)
    found = caught.value.trajectory
    np.testing.assert_allclose(found.impulse[1:, 0], 12.0 * np.diff(found.t), rtol=1e-9)  # (g + 2) h
    assert len(found.t) == states
