"""Corner impacts: the orbit, its discontinuity map, and the piecewise-linear map around it."""

import numpy as np
import pytest

from lagrangian import LinearContacts, LinearSystem, Scene, scenes
from lcpstep import EventDriven
from lcpstep.analysis.border_collision import classify
from lcpstep.analysis.chattering import corner_crossings, sequences
from lcpstep.analysis.corner_estimate import agreement, estimate
from lcpstep.analysis.corners import NotDifferentiable, corner_impact, discontinuity_map, local_map
from lcpstep.analysis.orbits import continue_orbit, periodic_orbit
from lcpstep.maps import StroboscopicMap, iterate


def cam(rpm):
    return scenes.cam_follower(rpm=rpm)


def table(t, q, v, p, out):
    """Table that is pushed up in parabolas: position and velocity are continuous, the acceleration jumps."""
    s = t % 1.0
    if s < 0.5:
        out[0, 0], out[0, 1], out[0, 2] = p[0] * s * (0.5 - s), p[0] * (0.5 - 2.0 * s), -2.0 * p[0]
    else:
        out[0, 0], out[0, 1], out[0, 2] = -p[0] * (s - 0.5) * (1.0 - s), -p[0] * (1.5 - 2.0 * s), 2.0 * p[0]


def hammered(a):
    """Ball above that table, with a soft spring and damping."""
    return Scene(
        system=LinearSystem(M=1.0, C=0.1, K=2.0, force=-5.0),
        contacts=LinearContacts(G=1.0, restitution=0.5, motion=table),
        q0=0.4, v0=0.0, t_span=(0.0, 1.0), p=[a], corners=[0.0, 0.5], period=1.0, name="hammered",
    )  # fmt: skip


@pytest.fixture(scope="module")
def orbit():
    x = iterate(StroboscopicMap(cam(700.0), EventDriven()), [0.4, 0.4], 300)[-1]
    return corner_impact(cam, 674.0, x)


@pytest.fixture(scope="module")
def chain(orbit):
    return local_map(orbit)


@pytest.mark.slow
def test_the_orbit_of_the_cam_follower_meets_the_corner_at_the_published_speed(orbit):
    assert orbit.p == pytest.approx(673.234445, abs=5e-7)
    assert orbit.corner == 1  # where the flank meets the nose
    assert orbit.residual < 1e-11
    assert orbit.after == pytest.approx(-0.8 * orbit.before)


def test_the_map_is_continuous_and_keeps_the_determinant_of_the_impact(chain):
    # without damping the flow keeps areas, and an impact shrinks them by r^2
    assert chain.gap()[0] < 1e-9
    for A in (chain.A_minus, chain.A_plus):
        assert np.linalg.det(A) == pytest.approx(0.64, rel=1e-8)


def test_least_squares_on_simulated_perturbations_find_the_same_matrices(orbit, chain):
    found = estimate(orbit, chain)
    assert agreement(found.map, chain) < 1e-6
    assert max(found.rms) < 1e-7


def test_one_sided_differences_of_the_stroboscopic_map_find_the_same_matrices(orbit, chain):
    """Along directions that stay on one side; extrapolated from three step sizes."""
    border = np.append(chain.C, chain.D)
    for z in np.vstack([np.eye(3), [[1e-3, 0.1, 1.0]]]):
        for side, A, B in ((-1.0, chain.A_minus, chain.B_minus), (1.0, chain.A_plus, chain.B_plus)):
            z = z * np.sign(border @ z) * side

            def slope(s, z=z):
                P = StroboscopicMap(cam(orbit.p + s * z[2]), EventDriven())
                return (P(orbit.x + s * z[:2]) - orbit.x) / s

            h = 2e-5
            extrapolated = (slope(4 * h) - 6.0 * slope(2 * h) + 8.0 * slope(h)) / 3.0
            expected = A @ z[:2] + B * z[2]
            np.testing.assert_allclose(extrapolated, expected, atol=3e-6 * np.max(np.abs(expected)))


def test_the_border_is_where_the_impact_changes_sides(orbit, chain):
    rng = np.random.default_rng(1)
    for _ in range(10):
        z = rng.normal(size=3) * [1e-4, 1e-2, 1e-2]
        scene = cam(orbit.p + z[2])
        run = StroboscopicMap(scene, EventDriven()).follow(orbit.x + z[:2], 1)
        early = run.time[0, 0, 0] < scene.corners[orbit.corner]
        assert early == (chain.C @ z[:2] + chain.D * z[2] < 0.0)


def test_the_corner_correction_has_rank_one_and_vanishes_on_the_border(orbit):
    Z = discontinuity_map(orbit)
    by_state, by_parameter = Z.correction
    E = by_state @ Z.H_y / (Z.H_y @ Z.H_y)
    np.testing.assert_allclose(by_state, np.outer(E, Z.H_y), atol=1e-9 * np.max(np.abs(by_state)))
    np.testing.assert_allclose(by_parameter, E * Z.H_p, atol=1e-9 * np.max(np.abs(by_state)))


def test_the_verdict_is_that_of_the_full_system(orbit, chain):
    """Two orbits O(1, 1) above the speed of the corner, one on each side of it, and none below."""
    assert classify(chain).verdict == "nonsmooth fold"
    assert classify(chain).fixed.minus_exists == classify(chain).fixed.plus_exists == (False, True)


@pytest.mark.slow
def test_an_obstacle_of_ones_own_is_treated_alike():
    x = iterate(StroboscopicMap(hammered(4.0), EventDriven(), 0.4), [0.3, 0.0], 400)[-1]
    found = corner_impact(hammered, 4.0, x, corner=0, phase=0.4)
    chain = local_map(found)
    assert found.time == pytest.approx(1.0)
    assert chain.gap()[0] < 1e-8
    assert agreement(estimate(found, chain).map, chain) < 1e-6


def jumping(t, q, v, p, out):
    """Table whose velocity jumps."""
    s = t % 1.0
    out[0, 0], out[0, 1], out[0, 2] = p[0] * min(s, 1.0 - s), p[0] if s < 0.5 else -p[0], 0.0


def test_a_corner_of_degree_one_is_named():
    def make(a):
        return Scene(
            system=LinearSystem(M=1.0, force=-9.81),
            contacts=LinearContacts(G=1.0, restitution=0.8, motion=jumping),
            q0=0.9, v0=0.0, t_span=(0.0, 1.0), p=[a], corners=[0.0, 0.5], period=1.0,
        )  # fmt: skip

    with pytest.raises(NotDifferentiable, match="degree one"):
        corner_impact(make, 0.2, [0.9, 0.0], corner=1)


def test_an_orbit_that_sticks_is_named():
    with pytest.raises(NotDifferentiable, match="closes for good"):
        corner_impact(cam, 130.0, [0.0, 0.0])


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ((lambda p: scenes.bouncing_ball(), 1.0, [1.0, 0.0]), "one contact, a period and corners"),
        ((cam, 700.0, [1.3, -66.0, 0.0]), "x: expected shape"),
    ],
)
def test_wrong_questions_are_named(arguments, said):
    with pytest.raises(ValueError, match=said):
        corner_impact(*arguments)
    with pytest.raises(ValueError, match="corner: expected an index"):
        corner_impact(cam, 700.0, [1.33, -66.2], corner=9)


def resting(rpm):
    return scenes.cam_follower(rpm=rpm, q0=0.0, v0=0.0)


def test_the_follower_chatters_twice_in_a_turn_above_first_detachment():
    assert sequences(resting(114.9)) == []
    first, second = sequences(resting(120.0))
    corners = np.asarray(resting(120.0).corners) / resting(120.0).period
    assert first.release == pytest.approx(corners[1])  # it leaves where the flank meets the nose
    assert first.release < first.impacts[0] < first.accumulation < second.release < second.accumulation
    assert np.all(np.diff(first.impacts) > 0.0)
    # impacts of a sequence shrink by r each, the more exactly the later they come
    assert first.speeds[21] / first.speeds[20] == pytest.approx(0.8, rel=1e-2)


def test_the_detachment_point_reaches_the_end_of_the_nose_at_its_published_speed():
    (crossing,) = [c for c in corner_crossings(resting, (134.5, 135.2), impacts=3) if c.event == "release"]
    assert crossing.corner == 3
    assert crossing.p == pytest.approx(134.873, abs=5e-4)


def test_an_impact_on_a_corner_is_located():
    crossings = corner_crossings(resting, (124.5, 125.5), impacts=1)
    (impact,) = [c for c in crossings if c.event == "impact"]
    corners = np.asarray(resting(impact.p).corners) / resting(impact.p).period
    phase = sequences(resting(impact.p))[impact.sequence].impacts[0]
    assert phase == pytest.approx(corners[impact.corner], abs=1e-10)
    with pytest.raises(ValueError, match="p_range"):
        corner_crossings(resting, (2.0, 1.0))


@pytest.mark.slow
def test_the_command_finds_the_corner_impact_and_keeps_what_is_there(capsys, tmp_path):
    import json

    from lcpstep.cli import main

    call = ["corner", "cam-follower", "--points", "5", "--json", "--no-picture", "--out", str(tmp_path)]
    assert main(call) == 0
    printed = json.loads(capsys.readouterr().out)
    assert printed["value"] == pytest.approx(673.234445, abs=5e-7)
    assert printed["verdict"] == "nonsmooth fold"
    saved = json.loads((tmp_path / "corner.json").read_text())
    assert len(saved["diagrams"]["full"]) == 5
    assert main(call) == 2
    assert "exists already" in capsys.readouterr().err


def test_the_command_names_the_files_it_wrote(capsys, tmp_path):
    from argparse import Namespace

    from lcpstep.cli import corner

    corner._tell_files(Namespace(out=tmp_path, json=False), "corner.json", "corner.png")
    assert capsys.readouterr().out == f"wrote {tmp_path / 'corner.json'}\nwrote {tmp_path / 'corner.png'}\n"
    for quiet in (Namespace(out=None, json=False), Namespace(out=tmp_path, json=True)):
        corner._tell_files(quiet, "corner.json")
    assert capsys.readouterr().out == ""


def ridge(t, q, v, p, out):
    """Table whose velocity rises and falls like the sides of a tent, p = (period, share that rises, acceleration)."""
    T, c, a = p[0], p[1], p[2]
    y = (t / T) % 1.0
    rising = a * c * T  # by how much the velocity rises; its mean is zero
    if y < c:
        tau, out[0, 2] = y * T, a
        out[0, 0], out[0, 1] = 0.5 * tau * (a * tau - rising), a * tau - 0.5 * rising
    else:
        tau, out[0, 2] = (y - c) * T, -a * c / (1.0 - c)
        out[0, 0], out[0, 1] = 0.5 * tau * (out[0, 2] * tau + rising), out[0, 2] * tau + 0.5 * rising


def over_a_ridge(weight, T, c, a, r):
    """Ball above that table."""
    contact = LinearContacts(G=1.0, restitution=r, motion=ridge)
    start, forcing = (10.0 * a * T**2, 0.0, (0.0, T)), {"corners": [0.0, c * T], "period": T}
    return Scene(LinearSystem(M=1.0, force=-weight), *start, contacts=contact, p=[T, c, a], **forcing)


@pytest.mark.parametrize("late", [False, True])
def test_a_branch_that_ends_at_a_corner_says_so(late):
    # The table goes no faster than at its corner, and so the ball on it can be no heavier than there
    T, c, a, r = 1.0, 0.4, 6.0, 0.7
    g = (1.0 + r) / (1.0 - r) * a * c
    weight = 0.97 * g
    at = c + (
        0.03 * 0.5 * (1.0 - c) if late else -0.03 * 0.5 * c
    )  # of the impact: its velocity is 0.97 of the highest
    table = np.zeros((1, 3))
    ridge(at, None, None, [T, c, a], table)
    x = [table[0, 0] + 0.125 * weight * T**2, 0.0]
    orbit = periodic_orbit(over_a_ridge(weight, T, c, a, r), x, phase=(at + 0.5) % 1.0)
    assert orbit.phases == pytest.approx([at], abs=1e-9)
    branch = continue_orbit(lambda p: over_a_ridge(p, T, c, a, r), orbit, weight, (0.9 * g, 1.1 * g))
    assert [(s.kind, s.p) for s in branch.special] == [("corner", pytest.approx(g, rel=1e-8))]


@pytest.mark.parametrize(("length", "time"), [(1.0, 1.0), (1e-6, 1.0), (1e-3, 1e-3), (1e5, 1e2)])
def test_a_ball_whose_impact_meets_the_corner_of_a_table_is_found_in_any_units(length, time):
    # One impact a period T: the ball leaves with g T / 2 and comes back so, and the table has g T (1 - r) / (2 + 2 r)
    T, c, a, r = 1.3 * time, 0.4, 6.0 * length / time**2, 0.7
    highest = 0.5 * a * c * T
    g = 2.0 * (1.0 + r) / (1.0 - r) * highest / T

    def make(weight):
        return over_a_ridge(weight, T, c, a, r)

    x = np.array([0.125 * g * T**2, 1e-3 * g * T])  # half way between two impacts, nearly
    found = corner_impact(make, 0.98 * g, x, corner=1, phase=c + 0.5)
    assert found.p == pytest.approx(g, rel=1e-10)
    assert found.before == pytest.approx(-0.5 * g * T - highest, rel=1e-10)
    chain = local_map(found)
    flight = np.array([[1.0, 0.5 * T], [0.0, 1.0]])
    fallen = np.array([-0.125 * T**2, -0.5 * T])  # by the weight, in half a period
    rate, state = np.array([[1.0, time], [1.0 / time, 1.0]]), np.array([length, length / time])
    sides = ((chain.A_minus, chain.B_minus, a), (chain.A_plus, chain.B_plus, -a * c / (1.0 - c)))
    for A, B, bend in sides:
        impact = np.array([[-r, 0.0], [-(1.0 + r) * (g + bend) / found.before, -r]])
        assert A / rate == pytest.approx(flight @ impact @ flight / rate, abs=1e-8)
        expected = flight @ impact @ fallen + fallen
        assert g * (B - expected) / state == pytest.approx([0.0, 0.0], abs=1e-6)


def test_a_velocity_that_jumps_is_one_however_slow_the_motion():
    def make(weight):
        def table(t, q, v, p, out):
            y = t % 1.0
            out[0, 0], out[0, 1], out[0, 2] = 1e-8 * y * (1.0 - y), 1e-8 * (1.0 - 2.0 * y), -2e-8

        contact = LinearContacts(G=1.0, restitution=0.5, motion=table)
        ball = LinearSystem(M=1.0, force=-weight)
        return Scene(ball, 1e-6, 0.0, (0.0, 1.0), contacts=contact, corners=[0.0], period=1.0)

    with pytest.raises(NotDifferentiable, match="degree one"):
        corner_impact(make, 5e-8, [2e-8, 0.0], phase=0.5)
