"""Several contacts: laws of simultaneous impact, piles, and the solvers of their complementarity problems."""

import numpy as np
import pytest

from lagrangian import Contacts, LinearContacts, LinearSystem, Scene, System, scenes
from lcpstep import Kind, Moreau, simulate
from tests.models import pendulum
from tests.stepping.test_step import three_masses


def line(q0, v0, restitution, masses=None, walls=False, t_end=1.0, force=0.0):
    """Balls of radius zero on a line, each held back by its neighbours."""
    n = len(q0)
    G = np.diff(np.eye(n), axis=0)
    if walls:
        G = np.vstack([np.eye(n)[0], G])
    return Scene(
        system=LinearSystem(M=np.diag(masses or np.ones(n)), force=np.full(n, force)),
        contacts=LinearContacts(G=G, restitution=restitution), q0=q0, v0=v0, t_span=(0.0, t_end), name="line",
    )  # fmt: skip


@pytest.mark.parametrize("r", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("ratio", [0.01, 1.0, 7.0])
def test_two_balls_keep_their_momentum_and_obey_newton(r, ratio):
    m = simulate(line([0.0, 1.0], [2.0, -1.0], r, masses=[1.0, ratio]), Moreau(1e-3))
    log, P = m.impacts[0], 2.0 - ratio
    common = P / (1 + ratio)
    expected = [common - r * 3.0 * ratio / (1 + ratio), common + r * 3.0 / (1 + ratio)]
    np.testing.assert_allclose(m.v[-1], expected, rtol=0, atol=1e-14)
    assert log.time == pytest.approx(1 / 3, abs=2e-3)
    assert log.impulse == pytest.approx((1 + r) * 3.0 * ratio / (1 + ratio), rel=1e-14)


def test_newtons_cradle_obeys_the_simultaneous_law():
    # three touching balls, the first one arriving with speed 1: Newton's law for both contacts at once
    m = simulate(line([0.0, 0.0, 0.0], [1.0, 0.0, 0.0], 1.0, t_end=0.1), Moreau(1e-2))
    np.testing.assert_allclose(m.v[-1], [-1 / 3, 2 / 3, 2 / 3], rtol=0, atol=1e-15)


@pytest.mark.parametrize("n", [2, 5, 12])
def test_a_pile_at_rest_carries_the_weight_above_each_contact(n):
    # the gaps that rounding opens, 1e-20 m, are no gaps
    h = 1e-3
    m = simulate(line(np.zeros(n), np.zeros(n), 0.5, walls=True, force=-9.81), Moreau(h))
    assert np.max(np.abs(m.q)) < 1e-13
    weight = 9.81 * np.arange(n, 0, -1)
    np.testing.assert_allclose(m.impulse[1:] / h, np.tile(weight, (len(m.t) - 1, 1)), rtol=1e-9)


def test_balls_fall_onto_each_other_and_come_to_rest():
    n = 4
    scene = line(0.1 * np.arange(1, n + 1), np.zeros(n), 0.3, walls=True, force=-9.81, t_end=3.0)
    m = simulate(scene, Moreau(1e-3))
    assert np.max(np.abs(m.v[-1])) < 1e-12
    np.testing.assert_allclose(m.impulse[-1] / 1e-3, 9.81 * np.arange(n, 0, -1), rtol=1e-9)
    # an impact is noticed up to half a step late, at no more than sqrt(2 g 0.4) m/s
    assert np.min(m.q @ scene.contacts.G.T) > -0.5e-3 * np.sqrt(2 * 9.81 * 0.4) * 2


# --- solvers

SOLVERS = ["auto", "enumeration", "newton", "qp", "qp:daqp"]


@pytest.mark.parametrize("solver", SOLVERS)
def test_every_solver_gives_the_same_motion(solver):
    if solver == "qp:daqp":
        pytest.importorskip("daqp")
    scene = three_masses(t_end=2.0)
    lemke, other = (simulate(scene, Moreau(1e-3, lcp=name)) for name in ("lemke", solver))
    assert other.status.name == "DONE"
    assert len(lemke.impacts) >= 5
    assert lemke.counts.lcp_calls > 5
    np.testing.assert_array_equal(other.impacts.kind, lemke.impacts.kind)
    # every answer is judged to 1e-10 or better relative to its problem; some hundred active steps of a
    # motion that does not diverge multiply this by a few
    np.testing.assert_allclose(other.q, lemke.q, rtol=0, atol=1e-10)
    np.testing.assert_allclose(other.v, lemke.v, rtol=0, atol=1e-9)
    np.testing.assert_allclose(other.impulse, lemke.impulse, rtol=0, atol=1e-9)
    assert other.counts.lcp_calls == lemke.counts.lcp_calls > 0


def test_named_solvers_solve_scenes_with_one_contact_too():
    scene = scenes.cam_follower(t_end=0.2)
    lemke, qp = (simulate(scene, Moreau(1e-3, lcp=name)) for name in ("lemke", "qp"))
    np.testing.assert_allclose(qp.q, lemke.q, rtol=0, atol=1e-9)


def test_named_solvers_solve_general_systems_too():
    scene = pendulum(1.0, 0.5, 12.0)
    lemke, qp = (simulate(scene, Moreau(1e-2, lcp=name)) for name in ("lemke", "qp"))
    assert len(lemke.impacts) > 1
    np.testing.assert_allclose(qp.q, lemke.q, rtol=0, atol=1e-9)


@pytest.mark.parametrize("solver", ["lemke", "qp"])
def test_redundant_contacts_share_one_impulse(solver):
    # the same floor twice: the sum is determined, the shares are not
    scene = Scene(
        system=LinearSystem(M=1.0, force=-9.81), contacts=LinearContacts(G=[[1.0], [1.0]], restitution=0.5),
        q0=0.0, v0=0.0, t_span=(0.0, 0.1),
    )  # fmt: skip
    m = simulate(scene, Moreau(1e-3, lcp=solver))
    assert np.max(np.abs(m.q)) < 1e-12
    np.testing.assert_allclose(m.impulse[1:].sum(axis=1), 9.81e-3, rtol=1e-9)


def one_rests_and_is_lifted_while_another_falls(t, q, v, p, out):
    out[0] = -1.0 if t < 0.3 else 5.0
    out[1] = -1.0


def curved_gaps(t, q, v, p, out):
    first = int(p[0])
    out[first] = q[0]
    out[1 - first] = q[1] + 3.0 * q[1] * q[1]


def curved_jacobian(t, q, v, p, out):
    first = int(p[0])
    out[:] = 0.0
    out[first, 0] = 1.0
    out[1 - first, 1] = 1.0 + 6.0 * q[1]


def logged(first, height):
    """The log of `Moreau` by body, time and kind; body 0 has this number as a contact."""
    contacts = Contacts(2, curved_gaps, curved_jacobian, restitution=0.5)
    system = System(2, np.eye(2), one_rests_and_is_lifted_while_another_falls)
    scene = Scene(system, [0.0, height], [0.0, 0.0], (0.0, 0.5), contacts, p=[float(first)])
    log = simulate(scene, Moreau(0.05)).impacts
    return {(abs(int(x.contact) - first), x.time, x.kind): (x.before, x.after, x.impulse) for x in log}


def test_an_impact_is_logged_alike_whichever_contact_opens_in_the_same_step():
    together = 0
    for height in np.linspace(0.02, 0.08, 13):
        log = logged(0, height)
        assert log == logged(1, height)
        opened = [time for body, time, kind in log if body == 0 and kind == Kind.RELEASE]
        together += sum((1, time, Kind.IMPACT) in log for time in opened)
    assert together > 0
