"""What is no orbit, or of a kind that no proof is given of, is refused, with the reason in words."""

import math
import sys
from dataclasses import replace

import numpy as np
import pytest

import lcpstep.analysis
from lagrangian import Contacts, Coulomb, LinearContacts, LinearJoints, LinearSystem, System, scenes
from lagrangian.scenes.table import sine_table
from lcpstep import EventDriven, MissingSolver, simulate
from lcpstep.analysis import prove, prove_speed
from lcpstep.analysis.orbits import PeriodicOrbit, periodic_orbit
from lcpstep.analysis.proofs import NotProved
from lcpstep.trajectory import Kind
from tests.analysis.proved import attracting, on_table, on_table_orbit, settled, sine, two_masses, two_walls


@pytest.fixture(scope="module")
def cam_orbit():
    return periodic_orbit(scenes.cam_follower(rpm=700.0), [1.33, -66.2])


@pytest.fixture(scope="module")
def table_orbit():
    return on_table_orbit(sine_table)


def branching(t, q, v, p, out):
    """The same table behind a branch."""
    sine(t, q, v, p, out)
    if t < 0.0:
        out[0, 0] = 0.0


def sine_if(t, q, v, p, out):
    s = math.sin(p[1] * t)
    if s == 2.0:
        s = 0.0
    out[0, 0], out[0, 1], out[0, 2] = p[0] * s, p[0] * p[1] * math.cos(p[1] * t), -p[0] * p[1] ** 2 * s


def tabulated(t, q, v, p, out):
    out[0, 0] = p[0] * np.interp(t % (2.0 * math.pi / p[1]), [0.0, 1.0], [0.0, 0.0]) + p[0] * math.sin(
        p[1] * t
    )
    out[0, 1] = p[0] * p[1] * math.cos(p[1] * t)
    out[0, 2] = -p[0] * p[1] ** 2 * math.sin(p[1] * t)


@pytest.mark.parametrize(
    ("motion", "said", "after"),
    [(branching, "must be real number", 1), (sine_if, "a branch", 2), (tabulated, "interp is none of", 1)],
)
def test_a_callback_that_cannot_be_enclosed_is_named_with_its_line(motion, said, after):
    orbit = on_table_orbit(sine)
    with pytest.raises(NotProved, match=rf"contacts.motion: '{motion.__name__}' .*{said}") as refused:
        prove(replace(orbit, scene=on_table(motion)))
    first = motion.__code__.co_firstlineno + (motion.__doc__ is not None)
    assert f"test_proofs_refused.py, line {first + after})" in str(refused.value)


def looped(t, q, v, p, out):
    out[0, 0] = out[0, 1] = out[0, 2] = 0.0
    for k in range(1, 3):
        x = k * p[1] * t
        out[0, 0] += p[0] / (10.0 * k) ** (k - 1) * math.sin(x)
        out[0, 1] += p[0] / (10.0 * k) ** (k - 1) * k * p[1] * math.cos(x)
        out[0, 2] -= p[0] / (10.0 * k) ** (k - 1) * (k * p[1]) ** 2 * math.sin(x)


def test_a_loop_is_no_branch():
    assert prove(on_table_orbit(looped)).stability == "stable"


def pushed(t, q, v, p, out):
    out[0] = -9.81 + 0.0 * math.sin(t)


def plain_force(t, q, v, p, out):
    out[0] = -9.81


def flat_gap(t, q, v, p, out):
    out[0] = q[0]


def flat_jacobian(t, q, v, p, out):
    out[0, 0] = 1.0


OTHERS = {
    "nonlinear": {"system": System(1, mass=1.0, force=plain_force)},
    "system.force is a callback": {"system": LinearSystem(M=1.0, force=pushed)},
    "gaps are nonlinear": {"contacts": Contacts(1, flat_gap, flat_jacobian, restitution=0.5)},
    "no contacts": {"contacts": None},
    "nothing forces": {"contacts": LinearContacts(1.0, restitution=0.5)},
    "no restitution": {"contacts": LinearContacts(1.0, restitution=0.0, motion=sine_table)},
    "no whole number of turns": {"period": 0.2},
    "has no period": {"period": math.inf},
}


@pytest.mark.parametrize("reason", OTHERS)
def test_a_scene_of_another_kind_is_refused_by_name(table_orbit, reason):
    with pytest.raises(NotProved, match=reason):
        prove(replace(table_orbit, scene=replace(table_orbit.scene, **OTHERS[reason])))


def test_friction_and_joints_are_refused_by_name():
    orbit = attracting(two_masses())
    flat = orbit.scene.contacts
    rough = LinearContacts(flat.G, flat.offset, flat.restitution, friction=Coulomb(0.3, [[1.0, 0.0]]))
    with pytest.raises(NotProved, match="friction"):
        prove(replace(orbit, scene=replace(orbit.scene, contacts=rough)))
    with pytest.raises(NotProved, match="joints"):
        prove(replace(orbit, scene=replace(orbit.scene, joints=LinearJoints([[1.0, 0.0]]))))


def test_a_system_with_modes_is_refused_by_name():
    scene = scenes.driven_bilinear_oscillator()
    with pytest.raises(NotProved, match="modes"):
        prove(attracting(scene))


@pytest.mark.parametrize("rpm", [150.0, 180.0])
def test_a_chattering_motion_is_refused_by_name(rpm):
    orbit = attracting(scenes.cam_follower(rpm=rpm))
    assert "chattering" in orbit.name
    with pytest.raises(NotProved, match="sticks to the obstacle or chatters"):
        prove(orbit)


@pytest.mark.parametrize("coordinates", ["relative", "absolute"])
def test_a_motion_that_never_leaves_the_obstacle_is_refused_by_name(coordinates):
    orbit = attracting(scenes.cam_follower(rpm=90.0, coordinates=coordinates))
    assert orbit.name == "O(1, 0)"
    with pytest.raises(NotProved, match="sticks to contact 0 all the time"):
        prove(orbit)


def test_the_motion_that_sticks_at_358_rpm_is_refused_by_name():
    # At rest on the cam at first, it leaves it in the first turn and comes to O(3, 8), which does not stick
    scene = scenes.cam_follower(rpm=358.0, q0=0.0, v0=0.0)
    run = simulate(replace(scene, t_span=(0.0, scene.period)), EventDriven())
    assert Kind.RELEASE in run.impacts.kind
    hits = run.impacts[run.impacts.kind == Kind.IMPACT]
    motion = PeriodicOrbit(
        scene,
        EventDriven(),
        0.0,
        np.zeros((1, 2)),
        hits.time,
        hits.before,
        hits.after,
        True,
        np.zeros(2, complex),
        0.0,
    )
    for refused in (lambda: prove(motion), lambda: prove_speed(motion), lambda: prove_speed(motion, "flip")):
        with pytest.raises(NotProved, match="sticks to the obstacle or chatters"):
            refused()
    with pytest.raises(NotProved):  # nor is it one when nobody says so
        prove(replace(motion, sticks=False))


@pytest.mark.parametrize("size", [1e-5, 1e-3, 0.1])
@pytest.mark.parametrize("field", ["time", "before", "after", "x"])
def test_an_orbit_with_one_wrong_number_is_refused(cam_orbit, field, size):
    value = np.array(getattr(cam_orbit, field))
    value[0] += size * {"time": cam_orbit.scene.period, "x": np.array([1.33, 66.0])}.get(field, 90.0)
    with pytest.raises(NotProved):
        prove(replace(cam_orbit, **{field: value}))


def test_an_orbit_with_a_wrong_period_or_number_of_impacts_is_refused(cam_orbit):
    time, before, after = cam_orbit.time, cam_orbit.before, cam_orbit.after
    doubled = {"time": np.tile(time, 2), "before": np.tile(before, 2), "after": np.tile(after, 2)}
    late = {**doubled, "time": np.append(time, time + 0.3 * cam_orbit.scene.period)}
    none = {"time": time[:0], "before": before[:0], "after": after[:0]}
    with pytest.raises(NotProved, match="has no impact"):
        prove_speed(replace(cam_orbit, **none))
    with pytest.raises(NotProved, match="passes through contact 0"):
        prove(replace(cam_orbit, **none))
    for wrong in (doubled, late, {"x": np.tile(cam_orbit.x, (2, 1))}):
        with pytest.raises(NotProved):
            prove(replace(cam_orbit, **wrong))


def test_an_orbit_of_another_speed_is_refused(cam_orbit):
    with pytest.raises(NotProved, match="the orbit given is none"):
        prove(replace(cam_orbit, scene=scenes.cam_follower(rpm=700.01)))


def ceiling(orbit, height):
    """The table's scene with a wall above the ball as well."""
    contacts = LinearContacts([[1.0], [-1.0]], offset=[0.0, height], restitution=0.5, motion=below)
    return replace(orbit, scene=replace(orbit.scene, contacts=contacts, q0=0.02))


def below(t, q, v, p, out):
    out[0, 0] = p[0] * math.sin(p[1] * t + p[2])
    out[0, 1] = p[0] * p[1] * math.cos(p[1] * t + p[2])
    out[0, 2] = -p[0] * p[1] ** 2 * math.sin(p[1] * t + p[2])
    out[1, 0] = out[1, 1] = out[1, 2] = 0.0


def test_a_wall_that_the_flight_touches_is_named_and_one_just_beyond_is_not(table_orbit):
    (time,), (after,), (A, w, _) = table_orbit.time, table_orbit.after, table_orbit.scene.p
    up = after + A * w * math.cos(w * time)
    apex = A * math.sin(w * time) + up * up / (2.0 * 9.81)
    assert prove(ceiling(table_orbit, apex + 1e-9)).stability == "stable"
    for depth in (1e-9, 1e-5, 1e-3):
        with pytest.raises(NotProved, match="passes through contact 1"):
            prove(ceiling(table_orbit, apex - depth))


def test_a_second_contact_struck_at_once_is_named(cam_orbit):
    orbit = settled(two_walls())
    contacts = orbit.scene.contacts
    both = LinearContacts([[1.0], [1.0], [-1.0]], offset=[0.5, 0.5, 0.5], restitution=contacts.restitution[0])
    with pytest.raises(NotProved, match="both at once"):
        prove(replace(orbit, scene=replace(orbit.scene, contacts=both)))


def test_what_is_asked_of_no_kind_is_refused(cam_orbit):
    with pytest.raises(ValueError, match=r"unknown kind 'flop'.*flip"):
        prove_speed(cam_orbit, "flop")


def test_without_python_flint_the_message_says_what_to_install(monkeypatch):
    for name in [name for name in sys.modules if name.startswith("lcpstep.analysis.proofs")]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.delattr(lcpstep.analysis, "proofs")
    monkeypatch.setitem(sys.modules, "flint", None)
    with pytest.raises(MissingSolver, match="python-flint"):
        from lcpstep.analysis import prove as _  # noqa: F401
