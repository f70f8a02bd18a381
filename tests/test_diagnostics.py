"""Energy balances against closed forms, the audit of contacts, penetration and drift."""

import json
import math

import numpy as np
import pytest
from scipy import sparse

from lagrangian import Coulomb, Harmonic, LinearContacts, LinearJoints, LinearSystem, Scene, System, scenes
from lcpstep import EventDriven, Moreau, energy, simulate
from lcpstep.cli import main
from tests.models import ball_on_table, pendulum_force


def pendulum_potential(t, q, v, p, out):
    out[0] = 1.0 - math.cos(q[0])


def struck_pendulum(t_end=6.0):
    return Scene(
        System(1, 1.0, pendulum_force, potential=pendulum_potential), 1.0, 0.0, (0.0, t_end),
        LinearContacts(1.0, restitution=0.5),
    )  # fmt: skip


def block(mu):
    """A block thrown onto a rough floor: falls from 0.1 m, sliding at 2 m/s."""
    return Scene(
        LinearSystem(np.diag([2.0, 2.0]), force=[0.0, -19.62]), [0.0, 0.1], [2.0, 0.0], (0.0, 2.0),
        LinearContacts([[0.0, 1.0]], restitution=0.5, friction=Coulomb(mu, [[1.0, 0.0]])),
    )  # fmt: skip


CLOSED = {
    "ball": scenes.bouncing_ball(t_end=3.0),
    "driven and damped": scenes.impact_oscillator(t_end=20.0),
    "moving frame": scenes.cam_follower(t_end=0.4),
    "moving obstacle": scenes.cam_follower(t_end=0.4, coordinates="absolute"),
    "table": ball_on_table(0.01, 40.0, 0.3, 0.05, 0.0, 1.0),
    "friction": block(0.3),
}


@pytest.mark.parametrize("never", [False, True])
def test_a_potential_that_gives_no_number_is_named_with_time_and_state(never):
    def potential(t, q, v, p, out):
        if t < 0.5 or not never:
            out[0] = 1.0 - math.cos(q[0]) if t < 0.5 else math.nan

    scene = Scene(System(1, 1.0, pendulum_force, potential=potential), 1.0, 0.0, (0.0, 1.0))
    with pytest.raises(ValueError, match=r"^system\.potential: .*not filled at t = 0\.5, q = \["):
        energy(simulate(scene, Moreau(0.125)))


@pytest.mark.parametrize("name", CLOSED)
def test_the_balance_of_the_trapezoidal_rule_closes_to_rounding(name):
    run = simulate(CLOSED[name], Moreau(2e-3))
    e = energy(run)
    assert e.impacts[-1] > 0.0
    assert np.max(np.abs(e.residual)) < 1e-12 * np.max(e.kinetic + np.abs(e.potential) + np.abs(e.work))
    if (
        name != "table"
    ):  # in chatter Newton's law meets contacts that open inside the table, and pulls them on
        assert len(e.created) == 0


@pytest.mark.parametrize("name", ["ball", "driven and damped", "moving obstacle", "table"])
def test_the_balance_of_the_event_driven_run_closes(name):
    e = energy(simulate(CLOSED[name], EventDriven()))
    assert e.impacts[-1] > 0.0
    assert np.max(np.abs(e.residual)) < 1e-9 * np.max(e.kinetic + np.abs(e.potential))
    assert len(e.created) == 0


def test_a_ball_that_has_come_to_rest_has_lost_its_height_at_impacts():
    e = energy(simulate(scenes.bouncing_ball(t_end=6.0), EventDriven()))
    assert e.impacts[-1] == pytest.approx(9.81, rel=1e-10)
    assert e.total[-1] == pytest.approx(0.0, abs=1e-9)


def test_a_steady_oscillation_dissipates_what_the_force_brings_in():
    # amplitude X: pi c omega X^2 in a period [Meirovitch, Fundamentals of Vibrations, section 3.7]
    m, c, k, F, omega = 2.0, 0.3, 5.0, 3.0, 1.7
    X = F / (k - m * omega**2 + 1j * c * omega)
    scene = Scene(
        LinearSystem(m, c, k, Harmonic(cosine=F, omega=omega)), X.real, (1j * omega * X).real,
        (0.0, 2.0 * math.pi / omega),
    )  # fmt: skip
    for method, rel in ((EventDriven(), 1e-10), (Moreau(1e-3), 1e-5)):
        e = energy(simulate(scene, method))
        assert e.damping[-1] == pytest.approx(math.pi * c * omega * abs(X) ** 2, rel=rel)
        assert e.work[-1] == pytest.approx(e.damping[-1], rel=rel)


def test_the_implicit_rule_dissipates_by_itself_and_the_residual_says_how_much():
    # per step h^2 (theta - 1/2) (v' M v' + v K v) [Acary 2016, proposition 3], here by hand for one mass
    scene = Scene(LinearSystem(2.0, K=50.0), 1.0, 0.0, (0.0, 1.0))
    m = simulate(scene, Moreau(1e-2, theta=1.0))
    e = energy(m)
    lost = 0.5 * np.cumsum(2.0 * np.diff(m.v[:, 0]) ** 2 + 50.0 * np.diff(m.q[:, 0]) ** 2)
    np.testing.assert_allclose(e.residual[1:], -lost, rtol=1e-10)


@pytest.mark.parametrize(("method", "bound"), [(Moreau(1e-3), 1e-5), (EventDriven(), 1e-9)], ids=str)
def test_a_general_system_knows_its_potential(method, bound):
    e = energy(simulate(struck_pendulum(), method))
    assert e.total[0] == pytest.approx(1.0 - math.cos(1.0), rel=1e-12)
    assert e.impacts[-1] > 0.1
    assert np.max(np.abs(e.residual)) < bound
    assert np.max(np.abs(e.work)) < bound  # all forces have a potential
    assert len(e.created) == 0


@pytest.mark.parametrize(("law", "gain"), [("newton", 0.5875), ("moreau", -0.4376)])
def test_the_audit_flags_an_impact_that_creates_energy(law, gain):
    # Kane's double pendulum: the percentages are the published ones
    e = energy(simulate(scenes.kane_pendulum(law=law, t_end=1e-6), Moreau(1e-7)))
    assert e.total[-1] / e.total[0] - 1.0 == pytest.approx(gain, abs=1e-3)
    if law == "moreau":
        assert len(e.created) == 0
    else:
        assert e.created.energy.sum() == pytest.approx(gain * e.total[0], rel=1e-3)
        assert e.created.time[0] < 1e-6


def test_friction_dissipates_what_a_sliding_block_loses():
    run = simulate(block(0.3), Moreau(1e-3))
    e = energy(run)
    assert run.v[-1, 0] == 0.0
    assert e.friction[-1] + e.impacts[-1] == pytest.approx(e.total[0] - e.total[-1], rel=1e-10)
    assert e.friction[-1] == pytest.approx(0.5 * 2.0 * 2.0**2, rel=1e-3)  # all that was in the sliding


@pytest.mark.usefixtures("sparse_steps")
def test_a_sparse_system_has_the_same_balance():
    n = 20
    G = sparse.diags_array([np.ones(n), -np.ones(n - 1)], offsets=[0, -1]).tocsr()
    L = (G.T @ G).tocsr()
    system = LinearSystem(sparse.eye_array(n), C=0.5 * L, K=50.0 * L, force=np.full(n, -9.81))
    scene = Scene(
        system, 0.02 * np.arange(1, n + 1), np.zeros(n), (0.0, 0.5), LinearContacts(G, restitution=0.4)
    )
    e = energy(simulate(scene, Moreau(1e-3)))
    assert min(e.impacts[-1], e.damping[-1]) > 0.0
    assert np.max(np.abs(e.residual)) < 1e-12 * np.max(np.abs(e.potential))


# --- penetration and drift


@pytest.mark.parametrize("name", ["ball", "moving obstacle"])
def test_penetration_is_the_deepest_gap_of_the_kept_states(name):
    run = simulate(CLOSED[name], Moreau(1e-3))
    gaps = [run.scene.gap(t, q, v)[0][0] for t, q, v in zip(run.t, run.q, run.v, strict=True)]
    assert run.penetration == pytest.approx([-min(gaps)], rel=1e-12)
    assert run.penetration[0] > 1e-5


def test_penetration_of_scenes_without_contacts_or_that_never_touch():
    free = simulate(Scene(LinearSystem(1.0), 0.0, 1.0, (0.0, 1.0)), Moreau(0.1))
    assert free.penetration.shape == free.joint_drift.shape == (0,)
    far = Scene(LinearSystem(1.0), 1.0, 1.0, (0.0, 1.0), LinearContacts(1.0))
    assert simulate(far, Moreau(0.1)).penetration.tolist() == [0.0]


def test_joints_that_hold_exactly_do_not_drift():
    scene = Scene(
        LinearSystem(np.eye(2), force=[1.0, 0.0]), [0.0, 0.0], [0.0, 0.0], (0.0, 1.0),
        joints=LinearJoints([[1.0, -1.0]]),
    )  # fmt: skip
    run = simulate(scene, Moreau(1e-2))
    np.testing.assert_allclose(run.q[-1], 0.25, rtol=1e-9)  # half the acceleration each
    assert 0.0 <= run.joint_drift[0] < 1e-13


def test_the_command_line_shows_both(capsys):
    assert main(["simulate", "bouncing-ball", "--h", "1e-2", "--t-end", "3", "--energy", "--json"]) == 0
    shown = json.loads(capsys.readouterr().out)
    assert shown["penetration"] > 1e-3
    assert shown["energy"]["start"] - shown["energy"]["impacts"] == pytest.approx(
        shown["energy"]["end"], rel=1e-12
    )
    assert shown["energy"]["steps_that_created"] == 0
    assert main(["simulate", "bouncing-ball", "--h", "1e-2", "--t-end", "3", "--energy"]) == 0
    text = capsys.readouterr().out
    assert "largest penetration" in text
    assert "energy: 9.81 J -> " in text


def test_the_work_of_a_shaken_belt_is_in_the_balance():
    """A belt that runs to and fro with cos(2 t) under a block that slides on it: friction times the belt's way."""
    rough = Coulomb(mu=0.1, tangent=[[1.0, 0.0]], slip=Harmonic(cosine=[-1.0], omega=2.0))
    scene = Scene(
        LinearSystem(np.eye(2), force=[0.0, -10.0]), [0.0, 0.0], [-1.5, 0.0], (0.0, 0.2),
        LinearContacts([[0.0, 1.0]], friction=rough),
    )  # fmt: skip
    run = simulate(scene, Moreau(1e-4))
    t = float(run.t[-1])
    assert run.v[-1, 0] == pytest.approx(
        -1.5 + t
    )  # it slides backwards all the time: the belt pulls with 1 N
    lost = float(energy(run).friction[-1])
    way = 1.5 * t - 0.5 * t * t + 0.5 * math.sin(2.0 * t)  # of the belt over the block
    assert lost == pytest.approx(way, rel=1e-6)
