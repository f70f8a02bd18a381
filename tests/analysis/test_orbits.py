"""Periodic orbits: Newton, saltation matrices against differences and closed forms, bifurcations, branches."""

import math

import numpy as np
import pytest

from lagrangian import Contacts, Harmonic, LinearContacts, LinearSystem, Scene, System, scenes
from lcpstep import EventDriven
from lcpstep.analysis.continuation import Steps, continue_point
from lcpstep.analysis.derivative import differences
from lcpstep.analysis.fixed_points import NotConverged, periodic_point
from lcpstep.analysis.orbits import continue_orbit, moved, periodic_orbit
from lcpstep.analysis.variation import PeriodMap
from lcpstep.maps import iterate
from tests.analysis.test_maps import table
from tests.marks import slow

THESIS_CORNER = (
    673.234445  # rpm at which the impact of O(1, 1) meets the flank-nose corner, to its printed digits
)


def logistic(a):
    return lambda x: a * x * (1.0 - x)


def test_newton_finds_unstable_points_of_the_logistic_map_and_their_multipliers():
    found = periodic_point(logistic(3.7), [0.7])
    assert found.points[0, 0] == pytest.approx(1.0 - 1.0 / 3.7, abs=1e-13)
    assert found.multipliers[0] == pytest.approx(2.0 - 3.7, abs=1e-9)
    assert not found.stable
    two = periodic_point(logistic(3.3), [0.45], 2)
    assert two.multipliers[0] == pytest.approx(4.0 + 2.0 * 3.3 - 3.3**2, abs=1e-9)


def test_newton_finds_the_fixed_point_of_a_linear_map_at_once():
    A, b = np.array([[2.0, 1.0], [0.0, -3.0]]), np.array([1.0, 2.0])
    found = periodic_point(lambda x: A @ x + b, [50.0, -70.0])
    assert found.points[0] == pytest.approx(np.linalg.solve(np.eye(2) - A, b))
    assert sorted(found.multipliers.real) == pytest.approx([-3.0, 2.0])


def test_the_tent_map_has_its_points_of_period_three():
    def tent(x):
        return 2.0 * np.minimum(x, 1.0 - x)

    found = periodic_point(tent, [0.22], 3)
    assert found.points[:, 0] == pytest.approx([2 / 9, 4 / 9, 8 / 9])
    assert found.multipliers[0] == pytest.approx(-8.0)


def test_no_fixed_point_is_said():
    with pytest.raises(NotConverged):
        periodic_point(lambda x: x + 1.0 + x * x, [0.3])


@pytest.mark.parametrize("start", [[0.1, 0.4], [0.0, 2.0], [30.0, -1.0]])
def test_what_moves_on_steadily_is_no_fixed_point_however_far_away_it_is_sought(start):
    """Newton's steps are as long as rounding lets them be: no residual is large beside where they lead to."""

    class Conveyed:
        def __call__(self, x):
            return np.array([x[0] + 0.3 + 0.1 * x[1] ** 2, 0.5 * x[1] + 1.0])

        def jacobian(self, x):
            return np.array([[1.0 + 1e-15, 0.2 * x[1]], [0.0, 0.5]])

    with pytest.raises(NotConverged):
        periodic_point(Conveyed(), start)


@pytest.mark.parametrize(
    ("family", "start", "n", "span", "kind", "known"),
    [
        (lambda a: lambda x: a - x * x, 0.5, 1, (-0.5, 0.8), "fold", -0.25),
        (lambda a: lambda x: a - x * x, 0.4, 1, (-0.2, 0.9), "flip", 0.75),
        (logistic, 1.0 - 1.0 / 2.5, 1, (2.1, 3.4), "flip", 3.0),
        (logistic, 0.513, 2, (3.05, 3.6), "flip", 1.0 + math.sqrt(6.0)),
        (logistic, 0.488, 3, (3.7, 3.86), "fold", 1.0 + math.sqrt(8.0)),
    ],
)
def test_folds_and_flips_are_located_to_ten_digits(family, start, n, span, kind, known):
    p = 0.55 if n == 1 and family is not logistic else {1: 2.5, 2: 3.2, 3: 3.84}[n]
    for forward in (True, False):
        branch = continue_point(family, [start], p, span, n=n, forward=forward)
        located = [s.p for s in branch.of_kind(kind)]
        if located:
            break
    assert located[0] == pytest.approx(known, abs=1e-10)


def test_a_branch_turns_at_a_fold_and_shows_its_unstable_half():
    branch = continue_point(lambda a: lambda x: a - x * x, [0.5], 0.55, (-0.5, 0.7), forward=False)
    assert branch.ended == "left the range"
    exact = -0.5 + np.sign(branch.x[:, 0] + 0.5) * np.sqrt(np.maximum(0.25 + branch.p, 0.0))
    assert branch.x[:, 0] == pytest.approx(exact, abs=1e-6)
    assert branch.stable[0]
    assert not branch.stable[-1]
    assert branch.p[-1] == 0.7


def test_a_torus_bifurcation_of_the_delayed_logistic_map_is_located():
    # (x, y) -> (a x (1 - y), x): the fixed point loses stability at a = 2 with multipliers exp(+- i pi/3)
    branch = continue_point(
        lambda a: lambda z: np.array([a * z[0] * (1.0 - z[1]), z[0]]), [0.44, 0.44], 1.8, (1.6, 2.3)
    )
    (torus,) = branch.of_kind("torus")
    assert torus.p == pytest.approx(2.0, abs=1e-10)
    assert np.abs(np.angle(torus.multipliers[0])) == pytest.approx(math.pi / 3, abs=1e-8)


def test_a_branch_of_a_tent_map_jumps_at_its_border():
    # x -> p + 0.5 x for x < 0, p - 1.8 x for x > 0: the multiplier jumps from 0.5 to -1.8 at p = 0
    (jump,) = continue_point(BentMap, [-0.4], -0.2, (-0.5, 0.5)).special
    assert jump.kind == "jump"
    assert jump.p == pytest.approx(0.0, abs=1e-6)


class BentMap:
    def __init__(self, p):
        self.p = p

    def __call__(self, x):
        return self.p + self.jacobian(x)[0] * x

    def jacobian(self, x):
        return np.where(x < 0.0, 0.5, -1.8).reshape(1, 1)


def pendulum_at_a_wall():
    """A driven pendulum that strikes a wall, with all its equations as functions."""
    return Scene(
        System(1, mass=[[1.0]], force=gravity), q0=0.5, v0=0.0, t_span=(0.0, 1.0), period=2.0 * math.pi,
        contacts=Contacts(1, gap=to_wall, jacobian=to_wall_q, gap_t=to_wall_t, bias=to_wall_bias, restitution=0.7),
    )  # fmt: skip


def gravity(t, q, v, p, out):
    out[0] = -math.sin(q[0]) - 0.1 * v[0] + 0.8 * math.cos(t)


def to_wall(t, q, v, p, out):
    out[0] = math.sin(q[0]) + 0.2 + 0.05 * math.sin(2.0 * t)


def to_wall_q(t, q, v, p, out):
    out[0, 0] = math.cos(q[0])


def to_wall_t(t, q, v, p, out):
    out[0] = 0.1 * math.cos(2.0 * t)


def to_wall_bias(t, q, v, p, out):
    out[0] = -math.sin(q[0]) * v[0] ** 2 - 0.2 * math.sin(2.0 * t)


def two_masses():
    """Two masses in a row, the first of which strikes a stop."""
    return Scene(
        LinearSystem(M=[[1.0, 0.0], [0.0, 0.5]], C=[[0.1, 0.0], [0.0, 0.1]], K=[[2.0, -1.0], [-1.0, 1.5]],
                     force=Harmonic(cosine=[0.0, 1.0], omega=1.1)),
        q0=[0.5, 0.0], v0=[0.0, 0.0], t_span=(0.0, 1.0), period=2.0 * math.pi / 1.1,
        contacts=LinearContacts(G=[[1.0, 0.0]], offset=0.1, restitution=0.6),
    )  # fmt: skip


@pytest.mark.parametrize(
    ("scene", "starts", "error"),
    [
        (scenes.cam_follower(rpm=700.0), [[0.4, 0.4], [0.5, -20.0]], 1e-9),
        (scenes.cam_follower(rpm=700.0, coordinates="absolute", b=2.0), [[0.8, 0.4], [0.9, -20.0]], 1e-8),
        (table(), [[0.05, -0.3], [0.06, 0.1]], 1e-8),
        (pendulum_at_a_wall(), [[0.5, 0.0], [0.1, -1.0]], 1e-7),
        (two_masses(), [[0.5, 0.0, -1.0, 0.3], [0.0, 1.0, -2.0, 0.0]], 1e-8),
    ],
    ids=["cam", "cam-absolute", "table", "pendulum", "two-masses"],
)
def test_saltation_matrices_agree_with_differences(scene, starts, error):
    P = PeriodMap(scene, EventDriven(), phase=0.15)
    for x in starts:
        run = P.follow(x, 1)
        assert run.impacts[0, 0] > 0
        J = P.jacobian(x)
        assert pytest.approx(differences(P, x, 1e-5), abs=error * np.max(np.abs(J)), rel=error) == J


def test_chattering_and_sticking_leave_nothing_of_a_deviation_in_one_coordinate():
    orbit = periodic_orbit(scenes.cam_follower(rpm=125.0), [0.0, 0.0])
    assert orbit.sticks
    assert orbit.name == "O(1, chattering)"
    assert np.all(orbit.multipliers == 0.0)


def test_sticking_takes_two_ranks_in_two_coordinates():
    def landing_pair(t=0.0):
        return Scene(
            LinearSystem(M=[[1.0, 0.2], [0.2, 0.5]], C=[[0.1, 0.0], [0.0, 0.1]], K=[[2.0, -1.0], [-1.0, 1.5]],
                         force=Harmonic(constant=[-2.0, 0.0], cosine=[0.0, 0.2], omega=3.0)),
            q0=[0.5, 0.0], v0=[0.0, 0.0], t_span=(0.0, 1.0), period=2.0 * math.pi / 3.0 * 3.0,
            contacts=LinearContacts(G=[[1.0, 0.0]], restitution=0.3),
        )  # fmt: skip

    P, x = PeriodMap(landing_pair(), EventDriven()), np.array([0.2, 0.1, -0.3, 0.2])
    assert P.follow(x, 1).ends[0, 0] == 1
    J = P.jacobian(x)
    assert pytest.approx(differences(P, x, 1e-4), abs=1e-5) == J
    assert np.linalg.svd(J)[1][2:] == pytest.approx(0.0, abs=1e-6 * np.linalg.norm(J))


def test_the_ball_on_a_table_has_its_phase_and_its_multipliers():
    A, w, e, g = 0.02, 40.0, 0.5, 9.81
    cosine = math.pi * g * (1.0 - e) / (A * w * w * (1.0 + e))
    phase, speed = math.acos(cosine), 2.0 * math.pi * g / w / (1.0 + e)
    # Seen half a period after the impact
    start = phase / w
    v = A * w * cosine + e * speed - g * math.pi / w
    q = A * math.sin(phase) + (A * w * cosine + e * speed) * math.pi / w - 0.5 * g * (math.pi / w) ** 2
    section = (start + math.pi / w) * w / (2.0 * math.pi)
    orbit = periodic_orbit(table(A, w, e, g), [q + 1e-3, v - 1e-2], phase=section)
    assert orbit.name == "O(1, 1)"
    assert orbit.phases[0] * 2.0 * math.pi == pytest.approx(phase, abs=1e-10)
    assert np.prod(orbit.multipliers).real == pytest.approx(e * e, abs=1e-9)
    # trace of the monodromy of the impact map: 2 e ... from the closed-form bouncing-ball map
    trace = 1.0 + e * e - A * w * w * math.sin(phase) * (1.0 + e) ** 2 / g
    assert np.sum(orbit.multipliers).real == pytest.approx(trace, abs=1e-8)


def test_multipliers_of_an_undamped_flow_multiply_to_the_restitution_squared_per_impact():
    orbit = periodic_orbit(scenes.cam_follower(rpm=358.5), [0.0593541, 8.48880422], 3)
    assert orbit.name == "O(3, 8)"
    assert abs(np.prod(orbit.multipliers)) == pytest.approx(0.8**16, rel=1e-9)
    elsewhere = moved(orbit, 0.4)
    assert np.sort_complex(elsewhere.multipliers) == pytest.approx(
        np.sort_complex(orbit.multipliers), abs=1e-8
    )


@pytest.mark.slow
def test_the_corner_and_the_flip_of_the_single_impact_orbit_are_found():
    P = PeriodMap(scenes.cam_follower(rpm=700.0), EventDriven())
    orbit = periodic_orbit(P.scene, iterate(P, [0.4, 0.4], 150)[-1])
    assert orbit.name == "O(1, 1)"
    # Beyond the corner the branch turns back, unstable: a nonsmooth fold
    steps = Steps(first=0.05, largest=0.3, points=25)
    branch = continue_orbit(cam, orbit, 700.0, (650.0, 745.0), forward=False, steps=steps)
    assert min(branch.points.p) == pytest.approx(THESIS_CORNER, abs=0.02)
    (corner,) = [s for s in branch.special if s.kind == "corner"][:1]
    assert corner.p == pytest.approx(THESIS_CORNER, abs=2e-6)
    branch = continue_orbit(cam, orbit, 700.0, (650.0, 745.0), steps=steps)
    (flip,) = [s for s in branch.special if s.kind == "flip"]
    assert sorted(flip.multipliers.real) == pytest.approx([-1.0, -0.64], abs=1e-8)
    assert branch.orbits[0].stable
    assert not branch.orbits[-1].stable
    assert branch.orbits[-1].name == "O(1, 1)"


@pytest.mark.parametrize("end", slow([0.6, 40.0], 40.0))  # of the range: what it is wide by has no part in it
def test_the_branch_without_impacts_of_an_oscillator_ends_where_it_grazes_its_stop(end):
    # Steady oscillation of amplitude A / |1 - w^2 + 2 i z w|, which touches the stop when it is that far
    w, z, stop = 1.3, 0.05, 0.5
    response = 1.0 / complex(1.0 - w * w, 2.0 * z * w)

    def make(amplitude):
        return scenes.impact_oscillator(zeta=z, omega=w, amplitude=amplitude, stop=stop)

    motion = 0.3 * response
    orbit = periodic_orbit(make(0.3), [motion.real, -motion.imag * w])
    assert orbit.name == "O(1, 0)"
    assert orbit.clearance() == pytest.approx(stop - abs(motion), abs=1e-10)
    branch = continue_orbit(make, orbit, 0.3, (0.2, end))
    (grazing,) = branch.special
    assert grazing.kind == "grazing"
    assert grazing.p == pytest.approx(stop / abs(response), abs=1e-8)


def cam(rpm):
    return scenes.cam_follower(rpm=rpm)


def test_ranges_that_make_no_sense_are_refused():
    for span in ((1.0, 0.0), (2.0, 3.0)):
        with pytest.raises(ValueError, match=r"p_range|p: expected"):
            continue_point(logistic, [0.5], 1.5, span)
