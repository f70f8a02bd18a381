"""An obstacle that closes upon a body is told, and so are steps beyond the bound of explicit methods."""

import math

import numpy as np
import pytest

from lagrangian import Contacts, Coulomb, LinearSystem, Scene, System
from lcpstep import EventDriven, Located, Moreau, simulate
from lcpstep.doubts.room import closes_upon
from lcpstep.trajectory import Status


def bowl(depth, size, omega):
    """Gap depth - r(q) - size sin(omega t), whose largest value over all q is depth - 1 - size sin(omega t)."""

    def gap(t, q, v, p, out):
        out[0] = depth - math.sqrt(1.0 + q[0] * q[0]) - size * math.sin(omega * t)

    def jacobian(t, q, v, p, out):
        out[0, 0] = -q[0] / math.sqrt(1.0 + q[0] * q[0])

    def rate(t, q, v, p, out):
        out[0] = -size * omega * math.cos(omega * t)

    def curvature(t, q, v, p, out):
        out[0] = size * omega * omega * math.sin(omega * t) - v[0] * v[0] / (1.0 + q[0] * q[0]) ** 1.5

    return Contacts(1, gap, jacobian, gap_t=rate, bias=curvature)


@pytest.mark.parametrize("method", [Located(2e-3), Moreau(2e-3)], ids=["located", "moreau"])
@pytest.mark.parametrize("omega", [5.0, 21.0])
def test_a_bowl_that_closes_upon_a_body_is_told(omega, method):
    system = LinearSystem(M=1.0, K=1.03, force=-9.81)
    m = simulate(Scene(system, 0.1, 0.0, (0.0, 1.3), bowl(1.02, 0.2, omega)), method)
    assert m.status is not Status.DONE or "leaves no room" in m.doubt
    open_always = simulate(Scene(system, 0.1, 0.0, (0.0, 1.3), bowl(1.3, 0.05, omega)), method)
    assert (open_always.status, open_always.doubt) == (Status.DONE, "")


def test_a_bowl_that_closes_upon_a_body_held_on_it_is_named():
    """Held at q = sqrt((1.02 - 0.2 sin 5t)^2 - 1), it is squeezed to the middle at sin 5t = 0.1, ever faster."""
    scene = Scene(LinearSystem(M=1.0, force=1.0), 0.2, 0.0, (0.0, 1.3), bowl(1.02, 0.2, 5.0))
    run = simulate(scene, EventDriven())
    assert run.status is Status.STEP_TOO_SMALL
    assert "the obstacle of contact 0 closes in, and leaves no room" in run.message
    assert run.t[-1] == pytest.approx(math.asin(0.1) / 5.0, rel=1e-9)


@pytest.mark.parametrize("start", [0.0, 1e-10])
@pytest.mark.parametrize("depth", [1.08, 1.13, 1.15])
def test_a_bowl_that_closes_upon_a_body_near_its_middle_is_named(depth, start):
    """At sin 5t = (depth - 1) / 0.2; rounding of the gap is no way out: over its slope it is metres."""
    scene = Scene(LinearSystem(M=1.0), start, 0.0, (0.0, 1.3), bowl(depth, 0.2, 5.0))
    run = simulate(scene, EventDriven())
    assert run.status is (Status.LCP_FAILED if start == 0.0 else Status.PROJECTION_FAILED)
    assert "the obstacle of contact 0 closes in" in run.message
    assert run.t[-1] == pytest.approx(math.asin((depth - 1.0) / 0.2) / 5.0, rel=1e-12)
    assert run.q[-1, 0] == pytest.approx(start, abs=1e-12)


@pytest.mark.parametrize(("when", "named"), [(0.02, False), (0.0200334, True)])
def test_an_obstacle_closes_in_only_where_it_leaves_no_room(when, named):
    scene = Scene(LinearSystem(M=1.0, force=1.0), 0.2, 0.0, (0.0, 1.3), bowl(1.02, 0.2, 5.0))
    q = math.sqrt((1.02 - 0.2 * math.sin(5.0 * when)) ** 2 - 1.0)
    assert bool(closes_upon(scene, when + 8e-8 * named, np.array([q]))) is named
    assert closes_upon(scene, 0.0, np.array([0.2])) == ""  # it has not moved


def test_the_largest_gap_is_bounded_from_above():
    system = LinearSystem(M=1.0, K=1.03, force=-9.81)
    m = simulate(Scene(system, 0.1, 0.0, (0.0, 1.3), bowl(1.02, 0.2, 5.0)), Moreau(2e-3))
    words = m.doubt.split()
    t, most = float(words[words.index("t") + 2]), float(words[words.index("most") + 1])
    assert 0.02 - 0.2 * math.sin(5.0 * t) <= most < 0.0


def springs(t, q, v, p, out):
    out[0] = -p[0] * q[0] - (q[0] - q[1])
    out[1] = -(q[1] - q[0])


@pytest.mark.parametrize(("order", "bound"), [(2, 2.0), (4, 2.8)])
def test_steps_beyond_the_bound_are_told(order, bound):
    """Masses of 1 kg on springs: the highest frequency is that of the matrix."""
    stiff = 1e4
    highest = math.sqrt(np.linalg.eigvalsh([[stiff + 1.0, -1.0], [-1.0, 1.0]])[-1])
    for share, told in ((0.95, False), (1.05, True)):
        h = share * bound / highest
        scene = Scene(System(2, np.eye(2), springs), [1e-3, 0.1], [0.3, 0.1], (0.0, 100 * h), p=(stiff,))
        m = simulate(scene, Located(h, order))
        assert m.status is Status.DONE
        assert bool(m.doubt) is told or (
            order == 4 and "lose energy" in m.doubt
        )  # so near the bound order 4 damps
        assert ("change too fast for its steps" in m.message) is told


def test_linear_forces_that_are_taken_implicitly_have_no_bound():
    """A spring of 141 rad/s that carries nothing, in steps of 0.1 s; what it may carry: `test_periods`."""
    K = [[1e4, -1e4], [-1e4, 1e4]]
    scene = Scene(LinearSystem(M=np.eye(2), K=K), [0.1, 0.1], [0.3, 0.3], (0.0, 10.0))
    for method in (Located(0.1), Moreau(0.1)):
        run = simulate(scene, method)
        assert run.doubt == ""
        np.testing.assert_allclose(run.q, 0.1 + 0.3 * np.column_stack([run.t, run.t]), rtol=1e-9)


def ground(t, q, v, p, out):
    out[0] = q[1] - 0.3 * q[0] * q[0]


def ground_normal(t, q, v, p, out):
    out[0, 0], out[0, 1] = -0.6 * q[0], 1.0


def ground_curvature(t, q, v, p, out):
    out[0] = -0.6 * v[0] * v[0]


def ground_tangent(t, q, v, p, out):
    out[0, 0], out[0, 1] = 1.0, 0.6 * q[0]


def falls_freely(t, q, v, p, out):
    out[0], out[1] = 0.0, -9.81


@pytest.mark.parametrize("keep", [1, "impacts", [0.6, 1.0]])
def test_a_body_at_rest_on_a_ground_has_room_whatever_is_kept_of_its_run(keep):
    contacts = Contacts(
        1, ground, ground_normal, bias=ground_curvature, friction=Coulomb(0.8, ground_tangent)
    )
    scene = Scene(System(2, np.eye(2), falls_freely), [0.2, 0.1], [0.4, 0.0], (0.0, 1.0), contacts)
    run = simulate(scene, Moreau(2e-4), keep=keep)
    assert np.abs(run.v[-1]).max() < 1e-9  # it has come to rest, somewhat below the surface
    assert -1e-3 < run.q[-1, 1] - 0.3 * run.q[-1, 0] ** 2 < 0.0
    assert (run.status, run.doubt) == (Status.DONE, "")


def between(t, q, v, p, out):
    """Room between two walls, both at p; 0.1 * 3 lies 5.6e-17 behind that at 0.3."""
    out[0], out[1] = p[0] - q[0], q[0] - p[0]


def walls(t, q, v, p, out):
    out[0, 0], out[1, 0] = -1.0, 1.0


@pytest.mark.parametrize("method", [EventDriven(), Located(1e-2), Located(1e-2, 4)])
def test_rounding_of_the_place_of_a_body_at_rest_is_no_lack_of_room(method):
    scene = Scene(LinearSystem(M=1.0), 0.1 * 3, 0.0, (0.0, 1.0), Contacts(2, between, walls), p=[0.3])
    run = simulate(scene, method)
    assert (run.status, run.doubt) == (Status.DONE, "")


def powers(m):
    """Gap d^m of a wall at q = -1/2."""

    def gap(t, q, v, p, out):
        out[0] = (q[0] + 0.5) ** m

    def jacobian(t, q, v, p, out):
        out[0, 0] = m * (q[0] + 0.5) ** (m - 1)

    return Contacts(1, gap, jacobian, restitution=0.7)


@pytest.mark.parametrize("keep", [1, "impacts"], ids=str)
@pytest.mark.parametrize(
    "method", [Located(1e-2), Located(1e-2, order=4), Located(1e-2, tolerance=1e-6), EventDriven()], ids=repr
)
def test_a_gap_that_has_no_gradient_on_its_obstacle_is_told(method, keep):
    """The cube of a distance: one method is right by luck, another off by 0.4 m of 1.5 m, both were DONE."""
    for m, said in ((1, False), (3, True)):
        run = simulate(Scene(LinearSystem(M=1.0, K=4.0), 1.0, 0.0, (0.0, 3.0), powers(m)), method, keep=keep)
        assert run.status is Status.DONE
        assert ("no gradient where it is met" in run.doubt) is said


@pytest.mark.parametrize("method", [Located(1e-2), Located(1e-2, order=4), EventDriven()], ids=repr)
def test_a_needle_that_is_struck_beside_its_tip_has_a_normal(method):
    """Its gradient is (-0.02, 1) there, and (-800, 1) a little further along it, where it has turned."""

    def gap(t, q, v, p, out):
        out[0] = q[1] - math.exp(-((q[0] / 1e-3) ** 2))

    def jacobian(t, q, v, p, out):
        out[0, 0], out[0, 1] = 2.0 * q[0] / 1e-6 * math.exp(-((q[0] / 1e-3) ** 2)), 1.0

    scene = Scene(
        LinearSystem(M=np.eye(2)),
        [1e-8, 2.0],
        [0.0, -1.0],
        (0.0, 1.5),
        Contacts(1, gap, jacobian, restitution=1.0),
    )
    run = simulate(scene, method)
    n = np.array([0.02, 1.0]) / math.hypot(0.02, 1.0)
    assert np.allclose(run.v[-1], [0.0, -1.0] + 2.0 * n[1] * n, rtol=1e-6)
    assert run.doubt == ""


def test_a_gradient_that_grows_fast_but_is_there_is_not_told():
    def gap(t, q, v, p, out):
        out[0] = math.expm1(100.0 * (q[0] + 0.5))

    def jacobian(t, q, v, p, out):
        out[0, 0] = 100.0 * math.exp(100.0 * (q[0] + 0.5))

    run = simulate(
        Scene(LinearSystem(M=1.0, K=4.0), 1.0, 0.0, (0.0, 3.0), Contacts(1, gap, jacobian)), Located(1e-3)
    )
    assert len(run.impacts) > 0
    assert "no gradient" not in run.doubt
