"""Located impacts with several contacts: gases, cradles, collapse; sequences and simultaneous impacts."""

import numpy as np
import pytest

from lagrangian import Contacts, Harmonic, LinearContacts, LinearSystem, Scene, System, scenes
from lcpstep import EventDriven, Kind, Located, simulate
from tests.models import no_damping
from tests.stepping.test_general_systems import CURVED, GIVEN, LINEAR
from tests.stepping.test_general_systems import scene as two_masses_scene
from tests.stepping.test_order import slope
from tests.stepping.test_several_contacts import line


def tonks(n, t_end, seed=1):
    """Equal elastic beads between walls at 0 and 1, and where they are: free flights, then sorted."""
    rng = np.random.default_rng(seed)
    q0, v0 = np.sort(rng.uniform(0, 1, n)), rng.normal(size=n)
    G = np.vstack([np.eye(n)[0], np.diff(np.eye(n), axis=0), -np.eye(n)[-1]])
    offset = np.zeros(n + 1)
    offset[-1] = 1.0
    scene = Scene(
        system=LinearSystem(M=np.eye(n)), contacts=LinearContacts(G=G, offset=offset, restitution=1.0),
        q0=q0, v0=v0, t_span=(0.0, t_end),
    )  # fmt: skip
    return scene, lambda t: np.sort(np.abs((q0 + v0 * t + 1) % 2 - 1))


@pytest.mark.parametrize("h", [1e-3, 0.03, 1.0])
def test_the_tonks_gas_is_exact_at_any_step(h):
    scene, exact = tonks(20, 20.0)
    m = simulate(scene, Located(h), keep=10 if h < 0.01 else 1)
    assert len(m.impacts) > 5000
    np.testing.assert_allclose(m.q[-1], exact(20.0), rtol=0, atol=1e-11)
    np.testing.assert_allclose(np.sum(m.v**2, axis=1), np.sum(m.v[0] ** 2), rtol=1e-12)
    assert np.min(m.q @ scene.contacts.G.T + scene.contacts.offset) > -1e-12


@pytest.mark.parametrize(("ratio", "impacts"), [(1.0, 3), (100.0, 31), (1e4, 314), (1e6, 3141)])
def test_two_blocks_and_a_wall_count_the_digits_of_pi(ratio, impacts):
    m = simulate(
        line([1.0, 2.0], [0.0, -1.0], 1.0, masses=[1.0, ratio], walls=True, t_end=10.0), Located(0.01)
    )
    assert len(m.impacts) == impacts
    energy = m.v**2 @ [1.0, ratio] / ratio
    assert np.max(np.abs(energy - 1)) < 1e-8


def test_gas_in_which_many_beads_meet_at_one_time_and_place_is_exact():
    # with these numbers three and more beads pass through one another at t = 0.1657 s
    scene = scenes.elastic_gas(100, t_end=0.5)
    for h in (0.01, 0.3):
        m = simulate(scene, Located(h))
        q, v = scene.exact(m.t)
        np.testing.assert_allclose(m.q, q, rtol=0, atol=1e-11)
        np.testing.assert_allclose(m.v[-1], v[-1], rtol=0, atol=1e-11)


@pytest.mark.parametrize("h", [0.25, 1.0, 0.1])
def test_beads_on_a_lattice_pass_through_one_another_also_at_the_end_of_a_step(h):
    # many beads with unlike speeds meet at one time, often at a multiple of h
    place, speed = np.arange(1, 8) / 8, np.array([3.0, 1.0, 2.0, 0.0, -2.0, -1.0, -3.0])
    G = np.vstack([np.eye(7)[0], np.diff(np.eye(7), axis=0), -np.eye(7)[-1]])
    scene = Scene(
        system=LinearSystem(M=np.eye(7)), contacts=LinearContacts(G=G, offset=[*np.zeros(7), 1.0], restitution=1.0),
        q0=place, v0=speed, t_span=(0.0, 3.0),
    )  # fmt: skip
    m = simulate(scene, Located(h))
    exact = np.sort(np.abs((place + speed * m.t[:, None] + 1) % 2 - 1), axis=1)
    np.testing.assert_allclose(m.q, exact, rtol=0, atol=1e-12)


def test_a_level_bar_lands_on_both_ends_at_once():
    # restitution 0.5: in sequence the bar would leave turning
    contacts = LinearContacts(G=[[1.0, -0.5], [1.0, 0.5]], restitution=0.5)
    system = LinearSystem(M=np.diag([1.0, 1 / 12]), force=Harmonic(constant=[-9.81, 0.0]))
    scene = Scene(system=system, contacts=contacts, q0=[1.0, 0.0], v0=[0.0, 0.0], t_span=(0.0, 2.0))
    m = simulate(scene, Located(0.01))
    np.testing.assert_allclose(m.q[:, 1], 0.0, rtol=0, atol=1e-14)
    assert np.all(m.v[-1] == 0.0)


@pytest.mark.slow
def test_blocks_of_mass_ratio_a_million_million_collide_three_million_times_without_loss():
    # one step: the Delassus matrix of the blocks rounds the inverse of the heavy mass at the fourth digit
    scene = scenes.galperin(6)
    m = simulate(scene, Located(20.0), keep=[20.0])
    assert len(m.impacts) == 3141592
    assert abs(m.v[-1, 0] ** 2 + 1e12 * m.v[-1, 1] ** 2 - 1e12) < 1e-10 * 1e12


def test_touching_balls_are_struck_together_and_others_in_sequence():
    together = simulate(line([0.0, 0.0, 0.0], [1.0, 0.0, 0.0], 1.0, t_end=0.1), Located(1e-2))
    np.testing.assert_allclose(together.v[-1], [-1 / 3, 2 / 3, 2 / 3], rtol=0, atol=1e-14)
    one_by_one = simulate(line([0.0, 1e-9, 2e-9], [1.0, 0.0, 0.0], 1.0, t_end=0.1), Located(1e-2))
    np.testing.assert_allclose(one_by_one.v[-1], [0.0, 0.0, 1.0], rtol=0, atol=1e-14)


@pytest.mark.parametrize("r", [0.0, 0.02, 0.05, 0.07, 0.08])
def test_inelastic_collapse_of_three_balls(r):
    # infinitely many impacts up to r = 7 - 4 sqrt(3) = 0.0718
    m = simulate(line([0.0, 1.0, 2.0], [1.0, 0.0, -1.3], r, t_end=10.0), Located(0.1))
    assert m.status.name == "DONE"
    assert len(m.impacts) <= 100
    np.testing.assert_allclose(np.sum(m.v, axis=1), -0.3, rtol=0, atol=1e-15)
    if r <= 0.07:
        np.testing.assert_allclose(m.v[-1], -0.1, rtol=0, atol=1e-15)


@pytest.mark.parametrize("r", [0.0, 0.05, 0.0717, 0.072, 0.3])
def test_every_logged_impact_of_three_balls_obeys_its_law(r):
    # near the bound a collapse takes thousands of impacts; what is left of it in the end is no impact of Newton's
    m = simulate(line([0.0, 1.0, 2.0], [1.0, 0.0, -1.3], r, t_end=10.0), Located(0.1))
    log = m.impacts[m.impacts.kind == Kind.IMPACT]
    assert np.all(log.after >= -r * np.minimum(log.before, 0.0) - 1e-12)
    np.testing.assert_allclose(np.sum(m.v, axis=1), -0.3, rtol=0, atol=1e-13)


def test_one_system_written_in_several_ways_moves_in_one_way():
    def motion(system, contacts, h):
        at = np.linspace(0.0, 2.0, 41)
        return simulate(two_masses_scene(system, contacts), Located(h), keep=at)

    fine = motion(LINEAR, two_masses_scene(LINEAR, CURVED).contacts, 1e-5)
    for system in (LINEAR, GIVEN):
        levels, errors = (100, 200, 400, 800, 1600), []
        for n in levels:
            scatter = [motion(system, CURVED, 2.0 / round(n * s)) for s in (1.0, 1.13, 1.29)]
            errors.append(np.mean([np.max(np.abs(m.q - fine.q)) for m in scatter]))
        assert slope(levels, errors) >= 1.8


# --- curved and moving obstacles


def rising_gap(t, q, v, p, out):
    out[0] = q[1] - 0.1 * np.sin(5.0 * t) + q[0] ** 2
    out[1] = 0.5 - q[0]


def rising_jacobian(t, q, v, p, out):
    out[0, 0], out[0, 1], out[1, 0], out[1, 1] = 2.0 * q[0], 1.0, -1.0, 0.0


def rising_gap_t(t, q, v, p, out):
    out[0], out[1] = -0.5 * np.cos(5.0 * t), 0.0


def falling(t, q, v, p, out):
    out[0], out[1] = 0.3, -9.81


def over_a_moving_hollow(restitution, t_end):
    contacts = Contacts(2, rising_gap, rising_jacobian, gap_t=rising_gap_t, restitution=restitution)
    system = System(n_q=2, mass=np.eye(2), force=falling, force_q=no_damping, force_v=no_damping)
    return Scene(system=system, contacts=contacts, q0=[0.2, 0.5], v0=[0.3, 0.0], t_span=(0.0, t_end))


def test_moving_curved_obstacles_are_struck_to_rounding_and_never_entered():
    scene = over_a_moving_hollow(0.6, 3.0)
    m = simulate(scene, Located(1e-2), keep="impacts")
    gaps = np.array([scene.gap(t, q, v) for t, q, v in zip(m.t, m.q, m.v, strict=True)])
    assert len(m.impacts) > 5
    assert np.min(gaps[:, 0]) > -1e-13
    impacts = m.impacts[m.impacts.kind == Kind.IMPACT]
    np.testing.assert_allclose(impacts.after, -0.6 * impacts.before, rtol=1e-12)


@pytest.mark.slow
def test_sliding_in_a_moving_hollow_converges_with_order_two():
    scene = over_a_moving_hollow(0.0, 1.0)
    at = np.linspace(0.0, 1.0, 21)
    fine = simulate(scene, Located(2e-6), keep=at)
    levels, errors = (50, 100, 200, 400, 800, 1600), []
    for n in levels:
        runs = [simulate(scene, Located(1.0 / round(n * s)), keep=at) for s in (1.0, 1.13, 1.29)]
        errors.append(np.mean([np.max(np.abs(m.q - fine.q)) for m in runs]))
        for m in runs:
            assert min(np.min(scene.gap(t, q, v)[0]) for t, q, v in zip(m.t, m.q, m.v, strict=True)) > -1e-12
    assert slope(levels, errors) >= 1.8


@pytest.mark.parametrize("order", [2, pytest.param("exact", marks=pytest.mark.slow)])
def test_the_bound_on_events_ends_a_run_with_all_that_came_before(order):
    scene, _ = tonks(20, 0.5)
    whole = simulate(scene, Located(0.05, order))
    bound = len(whole.impacts) // 2
    m = simulate(scene, Located(0.05, order, max_events=bound))
    assert m.status.name == "TOO_MANY_EVENTS"
    assert f"max_events = {bound}" in m.message
    assert bound < len(m.impacts) <= bound + 2
    np.testing.assert_array_equal(m.impacts.time, whole.impacts.time[: len(m.impacts)])
    assert m.impacts.time[-1] <= m.t[-1] < whole.impacts.time[len(m.impacts)] + 1e-12
    enough = simulate(scene, Located(0.05, order, max_events=len(whole.impacts)))
    assert enough.status.name == "DONE"
    assert "plastic" not in enough.message


def test_the_bound_on_events_of_a_step_ends_it_without_penetration_and_is_told():
    scene, _ = tonks(20, 0.5)
    m = simulate(scene, Located(0.05, max_per_step=5))
    assert m.status.name == "DONE"
    struck = m.impacts[m.impacts.before < 0]
    plastic = struck.time[np.abs(struck.after + struck.before) > 1e-9]
    assert f"{len(set(plastic))} times one plastic impact" in m.message
    assert "max_per_step = 5" in m.message
    assert np.min(m.q @ scene.contacts.G.T + scene.contacts.offset) > -1e-12
    assert np.max(np.diff(np.sum(m.v**2, axis=1))) <= 1e-12


def test_two_walls_that_close_end_the_run_and_are_named():
    def closing(t, q, v, p, out):
        out[:] = 0.0
        out[1, 0], out[1, 1] = 0.1 * t, 0.1
        out[2, 0], out[2, 1] = 0.1 * t, 0.1

    contacts = LinearContacts(G=[[0.0, 1.0], [1.0, 0.0], [-1.0, 0.0]], offset=[5.0, 0.0, 1.0], motion=closing)
    scene = Scene(
        system=LinearSystem(M=np.eye(2)), contacts=contacts, q0=[0.5, 0.0], v0=[0.0, 0.0], t_span=(0.0, 10.0)
    )
    m = simulate(scene, Located(0.01))
    assert m.status.name == "LCP_FAILED"
    assert "[1, 2]" in m.message


@pytest.mark.parametrize("force", [0.0, -9.81])
def test_impacts_taken_in_turn_within_a_step_are_those_found_one_by_one(force):
    # where states are asked for within every step, each impact moves the whole system on
    n, h = 12, 0.1
    masses = (1.0 + 0.7 * np.cos(np.arange(n))).tolist()
    places, speeds = 0.1 * np.arange(1, n + 1), 2.0 * np.sin(3.0 * np.arange(n))
    scene = line(places, speeds, 0.95, masses=masses, walls=True, force=force, t_end=1.0)
    in_turn = simulate(scene, Located(h), keep=[1.0])
    one_by_one = simulate(scene, Located(h), keep=np.arange(0.5 * h, 1.0 + h, h).clip(max=1.0))
    assert len(in_turn.impacts) > 30
    for name in ("time", "contact", "before", "after", "impulse"):
        a, b = getattr(in_turn.impacts, name), getattr(one_by_one.impacts, name)
        np.testing.assert_allclose(a, b, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(in_turn.q[-1], one_by_one.q[-1], rtol=0, atol=1e-11)
    np.testing.assert_allclose(in_turn.v[-1], one_by_one.v[-1], rtol=0, atol=1e-10)


@pytest.mark.parametrize("order", [2, 4, "exact"])
def test_a_body_leaves_its_wall_at_speed_while_the_force_on_another_vanishes(order):
    """Three masses that know nothing of each other; the forces on the first and the last begin at zero."""
    scene = Scene(
        system=LinearSystem(M=np.eye(3), force=Harmonic(sine=(1.0, 0.0, -1.0), omega=1.0)),
        contacts=LinearContacts(np.diag([-1.0, 1.0, -1.0])), q0=np.zeros(3), v0=(0.0, 0.1, 0.0), t_span=(0.0, 2.0),
    )  # fmt: skip
    m = simulate(scene, Located(0.01, order))
    np.testing.assert_allclose(m.q[-1], [0.0, 0.2, np.sin(2.0) - 2.0], rtol=0, atol=2e-6)
    assert m.impacts.contact.tolist() == [2]


def test_corners_that_land_as_one_land_together_however_short_the_step():
    """A gap of lengths that the start knows nothing of: two that close at one instant differ by their rounding."""
    scene, turn = scenes.slider_crank(mu=0.0), 2.0 * np.pi / 150.0
    times = np.linspace(*scene.t_span, 300)
    exact = simulate(scene, EventDriven(), keep=times).q
    for n in (1000, 4000, 8000):
        m = simulate(scene, Located(turn / n))
        struck = m.impacts[m.impacts.kind == Kind.IMPACT]
        _, counts = np.unique(struck.time, return_counts=True)
        assert set(counts) == {2}
        assert np.max(np.abs(m.at(times)[0] - exact)) < 250.0 / n**2
        assert not m.q[:, 2].round(15).any()
