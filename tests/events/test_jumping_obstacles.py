"""Obstacles whose velocity jumps at a corner, below several contacts or a general system: u- before it, u+ after."""

from dataclasses import replace

import numpy as np
import pytest

from lagrangian import Coulomb, LinearContacts, LinearJoints, LinearSystem, Scene, System
from lcpstep import EventDriven, Kind, Located, Moreau, Status, simulate

G, AT = 9.0, 0.3


def falls(t, q, v, p, out):
    for i in range(out.shape[0]):
        out[i] = -9.0


def table(t, q, v, p, out):
    """Contact 0 lies on a table that has the velocity p[0] from the corner on; there as well if p[1] > 0."""
    since = t - 0.3
    moves = since > 0.0 or (since == 0.0 and p[1] > 0.0)
    for i in range(out.shape[0]):
        for k in range(3):
            out[i, k] = 0.0
    if moves:
        out[0, 0], out[0, 1] = p[0] * since, p[0]


def stack(speed, later, system, restitution):
    """Two bodies that lie on each other and on the table."""
    made = System(2, np.diag([2.0, 1.0]), forced) if system == "general" else LinearSystem(
        np.diag([2.0, 1.0]), force=[-2.0 * G, -G]
    )  # fmt: skip
    return Scene(
        made, [0.0, 0.0], [0.0, 0.0], (0.0, 0.35),
        LinearContacts([[1.0, 0.0], [-1.0, 1.0]], 0.0, restitution, motion=table),
        p=[speed, later], corners=[AT],
    )  # fmt: skip


def forced(t, q, v, p, out):
    out[0], out[1] = -18.0, -9.0


@pytest.mark.parametrize("system", ["general", "linear"])
@pytest.mark.parametrize("later", [0.0, 1.0])
@pytest.mark.parametrize("restitution", [0.0, 0.5])
def test_a_table_takes_along_what_lies_on_it(system, later, restitution):
    """All that is closed shares the one impact, without rebound: 3 kg are given 0.4 m/s."""
    m = simulate(stack(0.4, later, system, restitution), EventDriven())
    assert m.status is Status.DONE
    np.testing.assert_allclose(m.v[-1], [0.4, 0.4], rtol=0, atol=1e-11)
    np.testing.assert_allclose(m.q[-1], [0.02, 0.02], rtol=0, atol=1e-11)
    struck = m.impacts[m.impacts.kind == Kind.IMPACT]
    np.testing.assert_allclose(struck.time, AT, rtol=1e-12)
    np.testing.assert_allclose(sorted(struck.impulse), [0.4, 1.2], rtol=1e-9)
    np.testing.assert_allclose(m.impulse.sum(axis=0), [27.0 * 0.35 + 1.2, 9.0 * 0.35 + 0.4], rtol=1e-9)


@pytest.mark.parametrize("system", ["general", "linear"])
@pytest.mark.parametrize("later", [0.0, 1.0])
def test_a_table_that_drops_leaves_what_lies_on_it(system, later):
    m = simulate(stack(-1.0, later, system, 0.5), EventDriven())
    assert m.status is Status.DONE
    np.testing.assert_allclose(m.v[-1], [-G * 0.05, -G * 0.05], rtol=0, atol=1e-11)
    np.testing.assert_allclose(m.q[-1], [-0.5 * G * 0.05**2] * 2, rtol=0, atol=1e-11)
    left = m.impacts[m.impacts.kind == Kind.RELEASE]
    assert left[0].contact == 0
    assert left[0].time == pytest.approx(AT)
    assert left[0].after == pytest.approx(1.0)


@pytest.mark.parametrize("later", [0.0, 1.0])
@pytest.mark.parametrize("speed", [-1.5, 0.8])
@pytest.mark.parametrize("method", [Located(1e-2, 4), Located(1e-2), Moreau(2e-5)])
def test_bodies_in_flight_meet_the_table_with_its_new_velocity(later, speed, method):
    """A ball hops on the table when that begins to move: the same by every method, and in closed form."""
    scene = Scene(
        System(1, 1.0, falls), [0.2], [0.0], (0.0, 0.7),
        LinearContacts(1.0, 0.0, 0.8, motion=table), p=[speed, later],
        corners=[AT],
    )  # fmt: skip
    m, other = simulate(scene, EventDriven()), simulate(scene, method)
    struck = m.impacts[m.impacts.kind == Kind.IMPACT]
    first = np.sqrt(0.4 / G)
    assert struck.time[0] == pytest.approx(first)
    assert struck.before[0] == pytest.approx(-G * first)
    rise, y = 0.8 * G * first, lambda t: 0.8 * G * first * (t - first) - 0.5 * G * (t - first) ** 2
    if len(struck) > 1:
        t = struck.time[1]
        assert y(t) == pytest.approx(speed * (t - AT), abs=1e-10)
        assert struck.before[1] == pytest.approx(rise - G * (t - first) - speed, abs=1e-9)
    np.testing.assert_allclose(
        other.q[-1], m.q[-1], rtol=0, atol=2e-3 if isinstance(method, Moreau) else 1e-5
    )


def rough(law):
    """A body that rests on a rough table, which then rises at 0.4 m/s."""
    friction = Coulomb(0.3, [[1.0, 0.0]], law=law)
    return Scene(
        LinearSystem(np.diag([2.0, 2.0]), force=[0.0, -2.0 * G]), [0.0, 0.0], [0.0, 0.0], (0.0, 0.35),
        LinearContacts([[0.0, 1.0]], 0.0, 0.5, motion=table, friction=friction),
        p=[0.4, 1.0], corners=[AT],
    )  # fmt: skip


@pytest.mark.parametrize("law", ["moreau", "stronge"])
@pytest.mark.parametrize(
    "method", [EventDriven(), Located(1e-2), Located(1e-2, order=4), Moreau(1e-2, tolerance=1e-6)]
)
def test_friction_changes_nothing_of_that(method, law):
    m = simulate(rough(law), method)
    assert m.status is Status.DONE
    np.testing.assert_allclose(m.v[-1], [0.0, 0.4], rtol=0, atol=1e-6)
    np.testing.assert_allclose(m.q[-1], [0.0, 0.02], rtol=0, atol=1e-6)


@pytest.mark.parametrize("scene", ["friction", "joint"])
@pytest.mark.parametrize("method", [EventDriven(), Located(1e-2), Located(1e-2, order=4)])
def test_the_log_tells_the_velocity_before_the_jump(method, scene):
    """What rested had u- = 0: with the jump in it the log would say that a contact with r = 0.5 did not rebound."""
    asked = rough("moreau")
    if scene == "joint":
        asked = replace(
            asked, contacts=replace(asked.contacts, friction=None), joints=LinearJoints([[1.0, 0.0]])
        )
    m = simulate(asked, method)
    struck = m.impacts[m.impacts.kind == Kind.IMPACT]
    np.testing.assert_allclose(struck.time, [AT], rtol=1e-12)
    np.testing.assert_allclose(struck.impulse, [0.8], rtol=1e-9)
    np.testing.assert_allclose([struck.before, struck.after], 0.0, rtol=0, atol=1e-12)
