"""What begins at the very edge of its friction cone, under forces that leave it as the square of time."""

import math

import numpy as np
import pytest

from lagrangian import Coulomb, Harmonic, LinearContacts, LinearSystem, Scene, System
from lcpstep import EventDriven, Located, Status, simulate

MU, G0, A, END = 0.5, 10.0, 4.0, 2.0
AT_REST = -0.2647282330291779
METHODS = {
    "event-driven": (EventDriven(), 1e-11),
    "loose": (EventDriven(1e-6, 1e-6), 1e-6),
    "order 2": (Located(1e-2), 1e-4),
    "order 4": (Located(1e-2, order=4), 1e-8),
    "tolerance": (Located(1e-2, order=4, tolerance=1e-6), 1e-6),
}
PUSH = MU * np.array([2.0 * G0, 0.0]), [-MU * G0, 0.0]  # mu m g (2 - cos t), under its weight
LOAD = np.array([MU * G0, A]), [0.0, -A]  # mu m g, under a load that falls to its least
HEAVY = np.array([[2.0, 0.0, 1.0], [0.0, 2.0, 0.0], [1.0, 0.0, 1.0]])


def swing(t, q, v, p, out):
    """A pendulum of 1 kg on a cart of the same mass, its inertia that of small swings."""
    out[0], out[1], out[2] = 0.0, -2.0 * 10.0, -10.0 * math.sin(q[2])


def block(constant, cosine, start, mu_s=None, extra=0.0):
    """A block of 1 kg on a floor that has held it, to the edge; `extra` keeps it out of closed form."""
    force = Harmonic(constant=np.array(constant) - [0.0, G0], cosine=cosine, omega=1.0)
    contact = LinearContacts(
        [[0.0, 1.0]], friction=Coulomb(MU if mu_s is None else 0.5 * MU, [[1.0, 0.0]], mu_s=mu_s)
    )
    system = LinearSystem(np.eye(2), C=np.diag([0.0, extra]), force=force)
    return Scene(system, [0.0, 0.0], [0.0, 0.0], (start, start + END), contacts=contact)


@pytest.mark.parametrize("start", [0.0, 2.0 * math.pi, 64.0 * math.pi], ids=["0", "a period", "32 periods"])
@pytest.mark.parametrize("name", METHODS)
@pytest.mark.parametrize(
    ("force", "pull", "extra"), [(PUSH, MU * G0, 0.0), (PUSH, MU * G0, 1.0), (LOAD, MU * A, 0.0)],
    ids=["push", "push, by steps", "load"],
)  # fmt: skip
def test_a_block_leaves_by_the_square_of_time(force, pull, extra, name, start):
    """x'' = pull (1 - cos t) from the edge on."""
    method, error = METHODS[name]
    run = simulate(block(*force, start, extra=extra), method)
    assert run.status == Status.DONE
    assert run.q[-1, 0] == pytest.approx(pull * (0.5 * END**2 - (1.0 - math.cos(END))), abs=error)
    assert len(run.impacts) < 10


@pytest.mark.parametrize("name", METHODS)
def test_so_does_one_that_has_less_friction_then(name):
    """Held by mu_s = 1/2, to the edge, and by half of it from then on: x'' = mu g (3/2 - cos t).

    When it lets go forces tell to the root of their rounding, 1e-8 s.
    """
    method, error = METHODS[name]
    run = simulate(block(*PUSH, 0.0, mu_s=MU), method)
    assert run.status == Status.DONE
    wanted = MU * G0 * (0.75 * END**2 - (1.0 - math.cos(END)))
    assert run.q[-1, 0] == pytest.approx(wanted, abs=max(error, 1e-7))


@pytest.mark.parametrize("name", METHODS)
def test_a_block_on_one_that_a_belt_takes_along_slides_as_its_spring_begins_to_hold_it(name):
    """Both would move with mu g, by all the friction between them, which the spring adds to."""
    k, m = 10.0, 2.0
    lower, upper = [1.0, 0.0, 0.0, 0.0], [-1.0, 0.0, 1.0, 0.0]
    contacts = LinearContacts(
        [[0.0, 1.0, 0.0, 0.0], [0.0, -1.0, 0.0, 1.0]], friction=Coulomb(MU, [lower, upper], slip=[5.0, 0.0])
    )
    weight = np.array([0.0, -m * G0, 0.0, -m * G0])
    system = LinearSystem(m * np.eye(4), K=np.diag([0.0, 0.0, k, 0.0]), force=Harmonic(constant=weight))
    scene = Scene(system, np.zeros(4), np.zeros(4), (0.0, 0.5), contacts=contacts)
    method, error = METHODS[name]
    run = simulate(scene, method)
    assert run.status == Status.DONE
    w = math.sqrt(k / m)  # the upper one slides: m x'' = -mu m g - k x
    upper = -MU * G0 / w**2 * (1.0 - math.cos(0.5 * w))
    assert run.q[-1, [0, 2]] == pytest.approx([-0.5 * MU * G0 * 0.5**2, upper], abs=error)


@pytest.mark.parametrize("name", METHODS)
def test_so_does_a_block_on_two_feet(name):
    """It is too low to tip over."""
    method, error = METHODS[name]
    contacts = LinearContacts(
        [[0.0, 1.0, -0.5], [0.0, 1.0, 0.5]], friction=Coulomb(MU, [[1.0, 0.0, 0.1]] * 2)
    )
    constant, cosine = PUSH
    force = Harmonic(constant=[constant[0], -G0, 0.0], cosine=[*cosine, 0.0], omega=1.0)
    system = LinearSystem(np.diag([1.0, 1.0, 0.1]), force=force)
    run = simulate(Scene(system, np.zeros(3), np.zeros(3), (0.0, END), contacts=contacts), method)
    assert run.status == Status.DONE
    assert run.q[-1, 0] == pytest.approx(MU * G0 * (0.5 * END**2 - (1.0 - math.cos(END))), abs=error)


@pytest.mark.parametrize("name", METHODS)
def test_a_bead_braced_between_two_walls_presses_on_none_of_them_from_outside(name):
    """The load goes over from one wall to the other while a spring pulls along them."""
    method = METHODS[name][0] if name != "tolerance" else Located(8e-3, tolerance=1e-4)
    contacts = LinearContacts([[0.0, 1.0], [0.0, -1.0]], 0.0, friction=Coulomb(MU, [[1.0, 0.0]] * 2))
    force = Harmonic(constant=[0.0, -10.0], cosine=[0.0, 20.0], omega=1.0)
    system = LinearSystem(np.eye(2), K=np.diag([1.0, 0.0]), force=force)
    run = simulate(Scene(system, [0.0, 0.0], [1.0, 0.0], (0.0, 2.0), contacts=contacts), method)
    assert run.status == Status.DONE
    assert np.min(run.impulse) > -1e-12


@pytest.mark.parametrize("copies", [1, 2, 3])
@pytest.mark.parametrize("name", ["event-driven", "order 2", "order 4"])
def test_a_bead_stays_between_its_walls_however_often_one_of_them_is_given(name, copies):
    """Its load leaves the upper wall, whose friction is used up; both together hold it while they brace themselves.

    Motion, by scipy: x'' = f - 10 x + mu |N(t)| to its rest at 0.45114883882035 s.
    """
    force = Harmonic([-50.0 / 13.0, 10.0 / 13.0], [0.0, 10.0], omega=1.0)
    normals = np.array([[0.0, 1.0], *[[0.0, -1.0]] * copies])
    contacts = LinearContacts(normals, friction=Coulomb(5.0 / 12.0, np.tile([1.0, 0.0], (1 + copies, 1))))
    system = LinearSystem(np.eye(2), K=np.diag([10.0, 0.0]), force=force)
    method = METHODS[name][0] if name != "order 4" else Located(1e-3, order=4, max_events=1000)
    run = simulate(Scene(system, [0.0, 0.0], [-1.0, 0.0], (0.0, 2.0), contacts=contacts), method)
    assert run.status == Status.DONE
    at_rest = run.t > 0.4512
    assert np.max(np.abs(run.v[at_rest])) < 1e-12
    assert run.q[-1, 0] == pytest.approx(AT_REST, abs=METHODS[name][1])
    assert len(run.impacts) < 20


@pytest.mark.parametrize("beyond", [1e-10, 1e-12, 1e-14, -1e-12])
@pytest.mark.parametrize("name", METHODS)
def test_what_is_pushed_beyond_its_edge_for_a_moment_stays(name, beyond):
    """By so much of mu m g, less than what it is known to, before the push falls as the square of time."""
    pull = System(n_q=3, mass=HEAVY, force=swing)
    contact = LinearContacts([[0.0, 1.0, 0.0]], friction=Coulomb(0.5 * (1.0 - beyond), [[1.0, 0.0, 0.0]]))
    scene = Scene(pull, [0.0, 0.0, -0.5 * math.pi], [0.0, 0.0, 1.0], (0.0, 0.2), contacts=contact)
    run = simulate(scene, METHODS[name][0])
    assert run.status == Status.DONE
    assert abs(run.q[-1, 0]) < 1e-15
    assert len(run.impacts) < 10
