"""Bodies in corners, grooves and slits without clearance: impacts without end at one instant, by their sums."""

import math
from functools import cache

import numpy as np
import pytest

from lagrangian import Contacts, Coulomb, Harmonic, LinearContacts, LinearJoints, LinearSystem, Scene
from lcpstep import EventDriven, Kind, Located, Moreau, Status, simulate
from lcpstep.gaps import closing_in
from tests.marks import shared

GRAVITY = 9.81
FORCES = {"constant": 1.0, "harmonic": Harmonic(constant=1.0, cosine=2.0, omega=3.0)}


def slit(restitution, force, v0, t_end=10.0):
    return Scene(
        LinearSystem(M=1.0, force=force), 0.0, v0, (0.0, t_end),
        LinearContacts(G=[[1.0], [-1.0]], restitution=restitution), name="slit",
    )  # fmt: skip


@cache
def pushes(force):
    """Impulses of the two walls against a force, in ten seconds."""
    t = np.linspace(0.0, 10.0, 1_000_001)
    f = 1.0 + (2.0 * np.cos(3.0 * t) if force == "harmonic" else 0.0 * t)
    return np.array([np.trapezoid(np.maximum(-f, 0.0), t), np.trapezoid(np.maximum(f, 0.0), t)])


@pytest.mark.parametrize("force", FORCES)
@pytest.mark.parametrize("v0", [-1.0, 0.0, 1.0, 1e-9])
@pytest.mark.parametrize("restitution", [0.0, 0.5, 0.999, (0.3, 0.9), (1.0, 0.5)])
def test_a_body_in_a_slit_without_clearance_comes_to_rest_at_once(restitution, v0, force):
    m = simulate(slit(restitution, FORCES[force], v0), EventDriven())
    assert m.status is Status.DONE, m.message
    np.testing.assert_array_equal(m.q, 0.0)
    np.testing.assert_array_equal(m.v[1:], 0.0)
    # the walls take the blows, a geometric series, and then push against the force
    r = np.broadcast_to(restitution, 2)
    first = 0 if v0 < 0.0 else 1
    blows, ratio = np.zeros(2), r[0] * r[1]
    blows[first] = abs(v0) * (1.0 + r[first]) / (1.0 - ratio)
    blows[1 - first] = abs(v0) * r[first] * (1.0 + r[1 - first]) / (1.0 - ratio)
    np.testing.assert_allclose(m.impulse.sum(0), blows + pushes(force), rtol=1e-9)


@pytest.mark.parametrize("force", FORCES.values(), ids=FORCES)
def test_an_elastic_slit_has_no_end_and_says_so(force):
    m = simulate(slit(1.0, force, 1.0), EventDriven())
    assert m.status is Status.TOO_MANY_EVENTS
    assert "without end at one time" in m.message
    assert "[0, 1]" in m.message


def test_a_body_that_friction_holds_between_elastic_walls_strikes_them_for_ever():
    """By more than the tangent of half their angle: they return it as it came; by less it comes out again."""
    held, out = (simulate(sharp_corner(0.01, True, mu), EventDriven()) for mu in (0.0051, 0.0049))
    assert held.status is Status.TOO_MANY_EVENTS
    assert "without end at one time; the last at contacts [0, 1], closed are []" in held.message
    np.testing.assert_allclose(held.impacts.after[-2:], held.impacts.after[-4:-2], rtol=1e-12)
    assert np.min(held.impacts.after[-4:]) > 0.5
    assert out.status is Status.DONE
    assert np.min(np.asarray(out.scene.contacts.G) @ out.q[-1]) > 0.0


def test_what_strikes_along_a_slit_goes_on_and_across_it_stays():
    # a point that falls along x + 2 y = 0 between two walls, struck against one of them
    n, along = np.array([1.0, 2.0]) / math.sqrt(5.0), np.array([2.0, -1.0]) / math.sqrt(5.0)
    v0 = 0.3 * n + 0.2 * along
    scene = Scene(
        LinearSystem(M=np.eye(2), force=[0.0, -GRAVITY]), [0.0, 0.0], v0, (0.0, 1.0),
        LinearContacts(G=[n, -n], restitution=0.7),
    )  # fmt: skip
    m = simulate(scene, EventDriven())
    assert m.status is Status.DONE
    distance = 0.2 * m.t - 0.5 * GRAVITY * along[1] * m.t**2
    np.testing.assert_allclose(m.q, distance[:, None] * along, rtol=0, atol=1e-14)


def sharp_corner(angle, stiff, mu):
    """A body at the tip of two elastic walls, thrown into it."""
    G, T = [[0.0, 1.0], [math.sin(angle), -math.cos(angle)]], [[1.0, 0.0], [math.cos(angle), math.sin(angle)]]
    friction = None if mu is None else Coulomb(mu=mu, tangent=T)
    return Scene(
        LinearSystem(M=np.eye(2), K=1e-12 * np.eye(2) if stiff else None), [0.0, 0.0], [-1.0, 0.001], (0.0, 1.0),
        LinearContacts(G=G, restitution=1.0, friction=friction),
    )  # fmt: skip


@pytest.mark.parametrize(
    ("stiff", "mu"), [(False, None), (True, None), (True, 0.0)], ids=["constant", "springs", "friction"]
)
@pytest.mark.parametrize("angle", [0.3, 0.05, 0.01, 0.0005])
def test_a_sharp_corner_is_left_after_its_many_impacts(angle, stiff, mu):
    # elastic, at the tip itself: as by billiards in a wedge, out again after finitely many reflections
    scene = sharp_corner(angle, stiff, mu)
    G = scene.contacts.G
    m = simulate(scene, EventDriven())
    assert m.status is Status.DONE, m.message
    assert len(m.impacts) == pytest.approx(
        (math.pi - 0.001) / angle, abs=1
    )  # unfolded, the motion is straight
    np.testing.assert_allclose(np.hypot(*m.v[-1]), math.hypot(1.0, 0.001), rtol=1e-9)
    assert np.min(np.asarray(G) @ m.q[-1]) > 0.0


@pytest.mark.parametrize("restitution", [0.0, 0.5, 1.0])
def test_a_wall_that_is_met_where_the_force_of_another_vanishes_is_struck(restitution):
    # along y = 0 towards x = 0, pressed by the spring between them: its force ends where the wall x = 0 is met
    scene = Scene(
        LinearSystem(M=np.eye(2), K=[[2.0, 0.5], [0.5, 1.0]]), [1.0, 0.0], [0.0, 0.0], (0.0, 6.0),
        LinearContacts(G=np.eye(2), restitution=restitution),
    )  # fmt: skip
    m = simulate(scene, EventDriven())
    w = math.sqrt(2.0)
    strikes = m.impacts[(m.impacts.kind == Kind.IMPACT) & (m.impacts.before < -1e-6)]
    n = 1 if restitution == 0.0 else 3
    np.testing.assert_allclose(strikes.time, (np.arange(n) + 0.5) * math.pi / w, rtol=0, atol=1e-10)
    np.testing.assert_allclose(strikes.before, -w * restitution ** np.arange(n), rtol=0, atol=1e-10)
    assert np.all(strikes.contact == 0)
    np.testing.assert_allclose(m.q[:, 1], 0.0, rtol=0, atol=1e-11)
    gaps = m.at(np.linspace(0.0, 6.0, 601))[0]
    assert gaps.min() > -1e-10


# --- random scenes


def groove(seed):
    """A point that falls between two planes and comes to rest on both of them."""
    random = np.random.default_rng(seed)
    a, b = random.uniform(0.1, 1.4, size=2)
    restitution = float(random.choice([0.0, 0.3, 0.5, 0.8]))
    K = 0.01 * np.eye(2) if random.random() < 0.5 else None
    return Scene(
        LinearSystem(M=np.eye(2), K=K, force=[0.0, -GRAVITY]), [random.uniform(-0.2, 0.2), 1.5],
        0.3 * random.normal(size=2), (0.0, 60.0),
        LinearContacts(G=[[math.sin(a), math.cos(a)], [-math.sin(b), math.cos(b)]], restitution=restitution),
        name=f"groove {seed}",
    )  # fmt: skip


def check_groove(seed):
    m = simulate(groove(seed), EventDriven(1e-10, 1e-10))
    assert m.status is Status.DONE, m.message
    assert len(m.impacts) < 4000  # two planes that are struck in turn, at a restitution of 0.8
    np.testing.assert_allclose(m.q[-1], 0.0, rtol=0, atol=1e-8)
    np.testing.assert_allclose(m.v[-1], 0.0, rtol=0, atol=1e-8)
    gaps = m.q @ np.asarray(m.scene.contacts.G).T
    assert gaps.min() > -1e-9
    energy = 0.5 * np.sum(m.v**2, 1) + GRAVITY * m.q[:, 1] + 0.5 * m.scene.system.K[0, 0] * np.sum(m.q**2, 1)
    assert np.max(np.diff(energy)) < 1e-8


@pytest.mark.parametrize("seed", range(20))
def test_a_point_comes_to_rest_in_a_groove(seed):
    check_groove(seed)


@pytest.mark.parametrize("seed", shared(range(20, 400), 4))
def test_so_it_does_in_many_more_grooves(seed):
    check_groove(seed)


def bundle(seed):
    """One to four coordinates before one to five planes, of which some meet at the start: parallel, opposite, any."""
    random = np.random.default_rng(seed)
    n, m = int(random.integers(1, 5)), int(random.integers(1, 6))
    G = random.normal(size=(m, n))
    kind = random.choice(["any", "parallel", "opposite"])
    if kind != "any" and m > 1:
        G[-1] = random.uniform(0.5, 2.0) * (G[0] if kind == "parallel" else -G[0])
    q0 = random.normal(size=n) * random.choice([0.0, 1.0])
    offset = -G @ q0 + (random.random(m) < 0.6) * random.exponential(size=m)
    if kind == "opposite" and m > 1:
        offset[0], offset[-1] = -G[0] @ q0, -G[-1] @ q0
    force, K = random.normal(size=n) * random.choice([0.0, 1.0, 10.0]), None
    if random.random() < 0.5:
        A = random.normal(size=(n, n))
        K = A @ A.T * 10.0 ** random.uniform(-1.0, 2.0)
        force = Harmonic(constant=force, cosine=random.normal(size=n), omega=random.uniform(0.5, 5.0))
    restitution = (
        random.choice([0.0, 0.3, 0.5, 0.8]) if random.random() < 0.6 else random.uniform(0.0, 0.9, size=m)
    )
    return Scene(
        LinearSystem(M=np.diag(10.0 ** random.uniform(-2.0, 2.0, size=n)), K=K, force=force), q0,
        random.normal(size=n) * random.choice([0.0, 0.1, 1.0]), (0.0, 5.0),
        LinearContacts(G=G, offset=offset, restitution=restitution), name=f"bundle {seed}",
    )  # fmt: skip


def check_bundle(seed):
    m = simulate(bundle(seed), EventDriven(1e-10, 1e-10, max_events=200_000))
    assert m.status is Status.DONE, m.message
    assert np.all(np.isfinite(m.q))
    size = 1.0 + np.abs(m.q).max()
    assert m.penetration.max(initial=0.0) < 1e-8 * size


@pytest.mark.parametrize("seed", range(60))
def test_bundles_of_planes_end_and_hold(seed):
    check_bundle(seed)


@pytest.mark.parametrize("seed", shared(range(60, 1000), 4))
def test_many_more_bundles_of_planes_end_and_hold(seed):
    check_bundle(seed)


@pytest.mark.parametrize("tolerance", [1e-8, 1e-10, 1e-12])
def test_hops_in_a_narrow_wedge_are_not_fed_by_the_closing_of_gaps(tolerance):
    # two planes nearly opposite: a body put onto one of them is lifted off the other; the fewer the better
    scene = bundle(15)
    long = Scene(scene.system, scene.q0, scene.v0, (0.0, 20.0), scene.contacts)
    m = simulate(long, EventDriven(tolerance, tolerance, max_events=20_000))
    assert m.status is Status.DONE, m.message


def closing_walls(t, q, v, p, out):
    """One wall stands, the other comes by 0.1 m/s from 0.05 m."""
    out[0] = 0.0
    out[1] = (-0.05 + 0.1 * t, 0.1, 0.0)


@pytest.mark.parametrize(
    "method",
    [
        EventDriven(),
        Located(0.01),
        Located(0.01, 4),
        Moreau(0.01),
        Moreau(0.01, 1.0),
        Moreau(0.01, tolerance=1e-3),
    ],
)
def test_walls_that_leave_no_room_are_named(method):
    """The slit is closed after a second, whatever moves in it; the third contact has no part in that."""

    def motion(t, q, v, p, out):
        closing_walls(t, q, v, p, out)
        out[2] = 0.0

    contacts = LinearContacts(
        G=[[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0]], offset=(0.05, 0.0, 0.0), restitution=0.0, motion=motion
    )
    scene = Scene(
        LinearSystem(M=np.eye(2), force=(1.0, -9.81)), (-0.05, 0.0), (0.0, 0.0), (0.0, 1.5), contacts
    )
    m = simulate(scene, method)
    assert m.status is Status.LCP_FAILED
    assert "the obstacles of contacts [0, 1] approach each other with nothing left between them" in m.message


def test_obstacles_that_leave_room_are_not_blamed():
    """Walls of a wedge come nearer, and a body between them can give way."""
    scene = slit(0.0, 1.0, 0.0)
    assert closing_in(scene, 0.0, np.zeros(1), [0, 1]) == []
    wedge = LinearContacts(
        G=[[1.0, 0.2], [-1.0, 0.2]], offset=(0.0, 0.0), motion=closing_walls, restitution=0.0
    )
    scene = Scene(LinearSystem(M=np.eye(2)), (0.0, 1.0), (0.0, 0.0), (0.0, 1.0), wedge)
    assert closing_in(scene, 0.5, np.zeros(2), [0, 1]) == []


def test_a_corner_with_a_wall_nearly_along_the_way_is_one_impact():
    """A body slides along one of three walls, by a joint in space, to the point where they meet.

    It nears the second wall 285 times as slowly as the third; whatever steps have led there, it strikes all at once.
    """
    system = LinearSystem(
        M=np.diag([7.2365, 0.1543, 0.8096]),
        K=[[1.3639, 0.8088, 0.2856], [0.8088, 1.3629, 0.6454], [0.2856, 0.6454, 0.4615]],
        force=Harmonic(constant=[-3.6975, 7.5923, 6.5942], cosine=[-1.5456, -0.553, -0.4225], omega=3.4614),
    )
    walls = LinearContacts([[0.0, -1.14, -0.915], [0.33, -0.43, 0.03], [1.52, -0.49, -0.99]], restitution=0.5)
    joint = LinearJoints([[1.12, -0.18, -0.87]])
    v0 = [(0.18 * -1.474 + 0.87 * -0.143) / 1.12, -1.474, -0.143]

    def after_it(method, t_end):
        scene = Scene(system, np.zeros(3), v0, (0.0, t_end), contacts=walls, joints=joint)
        return simulate(scene, method, keep=[0.75]).q[-1]

    expected = after_it(Located(1e-3, order=4), 0.8)
    for t_end in np.linspace(0.8, 3.0, 200):
        np.testing.assert_allclose(after_it(EventDriven(), float(t_end)), expected, rtol=0, atol=1e-9)


def lids(t, q, v, p, out):
    out[0], out[1], out[2] = q[0], q[1], 1.0 - t - q[1]


def normals_of_lids(t, q, v, p, out):
    out[:] = 0.0
    out[0, 0], out[1, 1], out[2, 1] = 1.0, 1.0, -1.0


def closing(t, q, v, p, out):
    out[0], out[1], out[2] = 0.0, 0.0, -1.0


@pytest.mark.parametrize(
    "method", [Located(1e-2, tolerance=1e-4), Located(1e-2, order=4, tolerance=1e-4), EventDriven()], ids=repr
)
def test_the_contacts_that_have_no_forces_are_named_though_steps_have_gone_back(method):
    """A body bounces on its own as a lid comes down on another: named was the contact of the last good step."""
    contacts = Contacts(3, lids, normals_of_lids, gap_t=closing, restitution=[0.5, 0.0, 0.0])
    system = LinearSystem(np.eye(2), force=[-10.0, -10.0])
    m = simulate(Scene(system, contacts=contacts, q0=[1.0, 0.0], v0=[0.0, 0.0], t_span=(0.0, 2.0)), method)
    assert m.t[-1] == pytest.approx(1.0, abs=1e-9)
    assert "the obstacles of contacts [1, 2] approach each other" in m.message
