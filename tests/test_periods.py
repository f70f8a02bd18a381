"""Oscillations that turn by more than a quarter of a period in an implicit step: the run says so, and only then."""

import math

import numpy as np
import pytest
from scipy import sparse

from lagrangian import LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Located, Moreau, simulate
from lcpstep.trajectory import Status

TOLD = "what springs and dampers move turns by"
METHODS = [Moreau, Located]


def oscillator(stiff, h, steps=100, q0=0.1, v0=0.0, contacts=None, made=np.asarray):
    """1 kg on a spring, for so many steps."""
    matrices = made([[1.0]]), None, made([[stiff]])
    return Scene(LinearSystem(*matrices), q0=q0, v0=v0, t_span=(0.0, steps * h), contacts=contacts)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(("turn", "told"), [(0.5, False), (0.95, False), (1.05, True), (3.0, True)])
def test_a_quarter_of_a_period_in_a_step_is_the_bound(method, turn, told):
    """The trapezoidal rule turns by 2 atan(w h/2): by a quarter of a period where w h = 2."""
    stiff = 1e4
    h = 2.0 * turn / math.sqrt(stiff)
    run = simulate(oscillator(stiff, h, v0=3.0), method(h))
    assert run.status is Status.DONE
    assert (TOLD in run.doubt) is (TOLD in run.message) is told
    if told:
        assert float(run.doubt.split()[7]) == pytest.approx(2.0 * math.atan(turn), rel=5e-3)
        w, t = math.sqrt(stiff), run.t
        true = 0.1 * np.cos(w * t) + 3.0 / w * np.sin(w * t)
        assert np.max(np.abs(run.q[:, 0] - true)) > 1.5 * np.max(np.abs(true))


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(("q0", "v0"), [(0.1, 0.0), (0.0, 1.0), (-0.1, 0.3)])
def test_absurd_stiffness_is_told(method, q0, v0):
    """A period of 6e-6 s in steps of 1e-2 s: energy is kept to rounding, and nothing else."""
    run = simulate(oscillator(1e12, 1e-2, q0=q0, v0=v0), method(1e-2))
    energy = 0.5 * run.v[:, 0] ** 2 + 0.5e12 * run.q[:, 0] ** 2
    np.testing.assert_allclose(energy, energy[0], rtol=1e-9)
    assert TOLD in run.doubt


@pytest.mark.parametrize("restitution", [0.0, 0.8, 1.0])
def test_an_absurd_stiffness_at_a_stop_is_told(restitution):
    """It comes back to the stop after every half period, 0.0314 s, with the part r of its speed."""
    h, stop = 0.1, LinearContacts(-1.0, 0.0, restitution)
    scene = oscillator(1e4, h, steps=20, q0=0.0, v0=-1.0, contacts=stop)
    run, true = simulate(scene, Moreau(h)), simulate(scene, EventDriven())
    assert TOLD in run.doubt
    first = true.impacts.time[0]
    assert first == pytest.approx(math.pi / 100.0, rel=1e-12)
    assert run.impacts.time[0] > 2.0 * first
    assert simulate(scene, Moreau(1e-4)).doubt == ""


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(("damping", "told"), [(1.0, False), (3.0, False), (200.0, True)])
def test_dampers_that_turn_a_velocity_round_for_long_are_told(method, damping, told):
    """(1 - hc/2)/(1 + hc/2) of a velocity is left in a step: -0.2 at hc = 3, and -0.98 at hc = 200."""
    h = 0.01
    scene = Scene(LinearSystem(1.0, C=damping / h), q0=0.0, v0=1.0, t_span=(0.0, 1.0))
    run = simulate(scene, method(h))
    true = h / damping * (1.0 - np.exp(-damping / h * run.t))
    assert bool(np.max(np.abs(run.q[-40:, 0] - true[-40:])) > 1e-6) is told
    assert (TOLD in run.doubt) is told


@pytest.mark.parametrize("made", [np.asarray, sparse.csr_array], ids=["dense", "sparse"])
@pytest.mark.parametrize(("stretched", "told"), [(0.0, False), (1e-5, False), (0.05, True)])
def test_a_stiff_spring_that_carries_nothing_is_a_rod(made, stretched, told):
    """Two bodies of 1 kg that it joins fly on together: w h = 14, and energy 2 (50 x)^2 beside 0.09 J."""
    K, h = np.array([[1e4, -1e4], [-1e4, 1e4]]), 0.1
    scene = Scene(
        LinearSystem(made(np.eye(2)), K=made(K)), q0=[0.1 - stretched, 0.1 + stretched], v0=[0.3, 0.3],
        t_span=(0.0, 10.0), contacts=LinearContacts(made([[-1.0, 0.0]]), 50.0),
    )  # fmt: skip
    for method in METHODS if made is np.asarray else [Moreau]:
        run = simulate(scene, method(h))
        np.testing.assert_allclose(run.q.mean(axis=1), 0.1 + 0.3 * run.t, rtol=1e-9)
        assert (TOLD in run.doubt) is told


def test_a_load_on_a_stiff_spring_is_where_the_spring_holds_it():
    """Put down with a hundredth of what the spring yields by: it stays there, whatever it does in between."""
    stiff, load, h = 1e12, -9.81, 1e-2
    rest = load / stiff
    for part, told in ((1.0, False), (1.01, False), (0.0, True)):
        scene = Scene(LinearSystem(1.0, K=stiff, force=load), q0=part * rest, v0=0.0, t_span=(0.0, 1.0))
        run = simulate(scene, Moreau(h))
        assert bool(np.max(np.abs(run.q - rest)) > 0.02 * abs(rest)) is told
        assert (TOLD in run.doubt) is told


@pytest.mark.parametrize(
    ("stiff", "theta", "told"), [(1e4, 0.0, True), (1e4, 0.3, True), (-400.0, 0.5, False)]
)
def test_an_oscillation_that_grows_beyond_all_is_told_and_a_fall_is_not(stiff, theta, told):
    """Steps of theta < 1/2 make (1 + (1 - theta)^2 a) / (1 + theta^2 a) of its energy, a = (h w)^2."""
    h, scene = (
        0.1 if told else 1e-3,
        Scene(LinearSystem(1.0, K=stiff), 1e-3, 0.0, (0.0, 1.0 if not told else 10.0)),
    )
    run = simulate(scene, Moreau(h, theta=theta))
    energy = run.v[:, 0] ** 2 + abs(stiff) * run.q[:, 0] ** 2
    assert energy[-1] > 1e15 * energy[0]
    assert (TOLD in run.doubt) is told


@pytest.mark.parametrize("made", [np.asarray, sparse.csr_array], ids=["dense", "sparse"])
@pytest.mark.parametrize("theta", [0.0, 0.2, 0.4, 0.49, 0.5, 0.7])
@pytest.mark.parametrize("turn", [0.01, 0.1, 1.0])
def test_what_steps_of_theta_below_a_half_feed_is_told_where_it_is_a_part_of_the_energy(turn, theta, made):
    """Of free oscillations it is known: at h w = 1, theta = 0.4 it had grown by 1e55, in silence."""
    steps, a = 800, turn * turn
    run = simulate(oscillator(100.0, 0.1 * turn, steps, made=made), Moreau(0.1 * turn, theta))
    grown = ((1.0 + (1.0 - theta) ** 2 * a) / (1.0 + theta**2 * a)) ** steps
    energy = run.v[:, 0] ** 2 + 100.0 * run.q[:, 0] ** 2
    np.testing.assert_allclose(energy[-1] / energy[0], grown, rtol=1e-9)
    if not 1.04 < grown < 1.2:
        assert ("its steps gain energy" in run.doubt) is (grown > 1.2)


@pytest.mark.parametrize("contacts", [None, LinearContacts(1.0, 1.0, 0.7)])
def test_nor_is_a_fall_or_what_dampers_take_again(contacts):
    for system in (LinearSystem(1.0, force=-9.81), LinearSystem(1.0, C=1.0, K=100.0, force=30.0)):
        scene = Scene(system, 1.0, 0.0, (0.0, 10.0 if contacts else 1.0), contacts)
        assert simulate(scene, Moreau(1e-3, theta=0.0)).doubt == ""


def test_runs_that_are_not_asked():
    """Steps that damp it, that follow it in closed form, or are chosen; and states that are too far apart."""
    scene = oscillator(1e4, 0.1)
    for method in (
        Moreau(0.1, theta=1.0),
        Located(0.1, "exact"),
        Located(0.1, tolerance=1e-3),
        EventDriven(),
    ):
        assert simulate(scene, method).doubt == ""
    assert simulate(scene, Moreau(0.1), keep=[10.0]).doubt == ""
