"""Systems with modes are systems: maps, orbits, multipliers, attractors, basins of oscillators known in closed form.

Between switches every one of these oscillators is linear; orbits are found by matching the pieces (mpmath, 30
digits), and their derivatives are products of the pieces' own.
"""

import math

import mpmath as mp
import numpy as np
import pytest

from lagrangian import scenes
from lcpstep import EventDriven
from lcpstep.analysis.attractors import attractors, random_starts
from lcpstep.analysis.basins import basins
from lcpstep.analysis.bifurcation import bifurcation
from lcpstep.analysis.derivative import differences
from lcpstep.analysis.lyapunov import lyapunov
from lcpstep.analysis.orbits import continue_orbit, periodic_orbit
from lcpstep.analysis.variation import PeriodMap
from lcpstep.maps import StroboscopicMap, iterate, periods

METHOD = EventDriven()
MOST = 1e-10  # error of states and times of orbits, which are found to 1e-12 and amplified by the multipliers


def oscillator(k, c, F, omega, t0, x0, v0, held=0):
    """Motion t -> (x, v) of x'' + c x' + k x = F cos(omega t) + held from (x0, v0) at t0, c^2 < 4 k."""
    D = (k - omega**2) ** 2 + (c * omega) ** 2
    a, b = F * (k - omega**2) / D, F * c * omega / D  # a cos + b sin

    def driven(t):
        s, z = mp.sin(omega * t), mp.cos(omega * t)
        return mp.matrix([a * z + b * s + held / k, omega * (b * z - a * s)])

    def motion(t):
        return driven(t) + propagator(k, c, t - t0) * (mp.matrix([x0, v0]) - driven(t0))

    return motion


def propagator(k, c, tau):
    """Exp of the state matrix of x'' + c x' + k x = 0."""
    w = mp.sqrt(k - mp.mpf(c) ** 2 / 4)
    e, s, z = mp.exp(-c * tau / 2), mp.sin(w * tau) / w, mp.cos(w * tau)
    return e * mp.matrix([[z + c * s / 2, s], [-k * s, z - c * s / 2]])


def numbers(matrix):
    return np.array(matrix.tolist(), dtype=float)


def eigenvalues(matrix):
    return sorted(np.linalg.eigvals(numbers(matrix)).tolist(), key=abs, reverse=True)


# --- the driven bilinear oscillator


def bilinear_orbit(left, right, c, F, omega, guess):
    """O(1, 2): times up and down through x = 0, velocities there, and the derivative from just after `down` on."""
    with mp.workdps(30):
        left, right, c, F, omega = map(mp.mpf, (left, right, c, F, omega))
        T = 2 * mp.pi / omega

        def match(up, down, v_up, v_down):
            on_right = oscillator(right, c, F, omega, up, 0, v_up)(down)
            on_left = oscillator(left, c, F, omega, down - T, 0, v_down)(up)
            return [on_right[0], on_right[1] - v_down, on_left[0], on_left[1] - v_up]

        up, down, v_up, v_down = mp.findroot(match, guess)
        # The field is continuous at x = 0, so a passage changes nothing
        J = propagator(right, c, down - up) * propagator(left, c, up - down + T)
        return [float(y) for y in (up, down, v_up, v_down)], eigenvalues(J), float(mp.exp(-c * T))


@pytest.mark.parametrize(
    ("omega", "right", "damping"), [(3.0, 16.0, 0.1), (2.2, 16.0, 0.1), (1.9, 5.0, 0.25), (4.5, 9.0, 0.3)]
)
def test_the_orbit_of_the_bilinear_oscillator_is_that_of_two_pieces_matched(omega, right, damping):
    scene = scenes.driven_bilinear_oscillator(right=right, damping=damping, omega=omega)
    guess = (-0.25, 0.02) if omega != 1.9 else (-0.9, 0.5)
    orbit = periodic_orbit(scene, guess)
    assert orbit.name == "O(1, 2)"
    first = orbit.before[0]
    near = (*orbit.time, first, -orbit.before[1])
    exact, multipliers, product = bilinear_orbit(1.0, right, damping, 1.0, omega, near)
    assert orbit.time == pytest.approx(exact[:2], rel=0, abs=MOST)
    assert [first, -orbit.before[1]] == pytest.approx(exact[2:], rel=0, abs=MOST)
    found = sorted(orbit.multipliers.tolist(), key=abs, reverse=True)
    assert np.sort_complex(found) == pytest.approx(np.sort_complex(multipliers), rel=1e-8)
    assert np.prod(orbit.multipliers) == pytest.approx(product, rel=1e-9)


@pytest.mark.slow
def test_the_branch_of_the_bilinear_oscillator_flips_where_the_pieces_do():
    def make(omega):
        return scenes.driven_bilinear_oscillator(damping=0.1, omega=omega)

    orbit = periodic_orbit(make(3.0), (-0.25, 0.02))
    branch = continue_orbit(make, orbit, 3.0, (2.2, 3.1), forward=False)
    flips = [s.p for s in branch.special if s.kind == "flip"]
    assert len(flips) == 1
    at = periodic_orbit(make(flips[0]), (-0.5, 0.05))
    near = (*at.time, at.before[0], -at.before[1])
    _, multipliers, _ = bilinear_orbit(1.0, 16.0, 0.1, 1.0, flips[0], near)
    assert min(abs(m + 1.0) for m in multipliers) < 1e-7


def test_the_map_of_a_system_with_modes_iterates_follows_and_differentiates():
    P = PeriodMap(scenes.driven_bilinear_oscillator(omega=2.6), METHOD, phase=0.3)
    x = np.array([0.4, -0.7])
    orbit = iterate(P, x, 5)
    assert np.array_equal(P.follow(x, 5).states[0], orbit[1:])
    np.testing.assert_allclose(P.jacobian(x), differences(P, x), rtol=0, atol=1e-8)
    run = P.follow(x, 5)
    assert np.array_equal(np.sum(np.isfinite(run.time[0]), axis=1), run.impacts[0])
    assert np.all(np.diff(run.time[0][0][: run.impacts[0, 0]]) > 0.0)


def test_attractors_of_a_bilinear_oscillator_have_exponents_from_their_multipliers():
    scene = scenes.driven_bilinear_oscillator(damping=0.1, omega=2.2)
    starts = random_starts([[-2.0, -3.0], [2.0, 3.0]], 12, seed=3)
    found = attractors(scene, METHOD, starts, transient=300, window=60, longest=20)
    one = next(a for a in found.found if a.name == "O(1, 2)")
    orbit = periodic_orbit(scene, one.points[0])
    assert one.lyapunov.largest == pytest.approx(math.log(abs(orbit.multipliers[0])), rel=1e-6)
    along = lyapunov(PeriodMap(scene, METHOD), one.points[0], 300, drop=20)
    assert along.largest == pytest.approx(one.lyapunov.largest, abs=0.02)


def test_the_sections_of_a_linear_oscillator_are_its_own():
    """Equal stiffness on both sides: switches that change nothing, and an orbit in closed form."""
    scene = scenes.driven_bilinear_oscillator(left=2.0, right=2.0, damping=0.4, omega=1.3)
    motion = oscillator(2.0, 0.4, 1.0, 1.3, 0.0, 0.3, -0.2)
    image = [float(y) for y in motion(2.0 * math.pi / 1.3)]
    assert StroboscopicMap(scene, METHOD)([0.3, -0.2]) == pytest.approx(image, abs=1e-11)
    J = PeriodMap(scene, METHOD).jacobian([0.3, -0.2])
    np.testing.assert_allclose(J, numbers(propagator(2.0, 0.4, 2.0 * math.pi / 1.3)), rtol=0, atol=1e-10)
    data = bifurcation(
        lambda amplitude: scenes.driven_bilinear_oscillator(2.0, 2.0, 0.4, amplitude, 1.3), "amplitude",
        [0.5, 1.0], drop=60, keep=3,
    )  # fmt: skip
    last = data["x"].values[0, :, -1]
    np.testing.assert_allclose(last[1], 2.0 * last[0], rtol=1e-9)  # it is linear
    assert np.all(data["impacts"] == 2)


# --- the driven block on a belt


def block(belt, static, kinetic, F, omega):
    """The return map of the driven block in its sticking phase: x at t = T from x at t = 0, one slip between."""

    def after(x):
        leave = mp.findroot(lambda t: x + belt * t - F * mp.cos(omega * t) - static, (static - x) / belt)
        slip = oscillator(mp.mpf(1), 0, F, omega, leave, x + belt * leave, belt, kinetic)
        stick = mp.findroot(lambda t: slip(t)[1] - belt, leave + mp.mpf("4.0"))
        return leave, stick, slip(stick)[0] + belt * (2 * mp.pi / omega - stick)

    return after


def test_the_orbit_of_a_driven_block_on_a_belt_and_its_multipliers():
    belt, static, kinetic, F, omega = 0.2, 1.0, 0.6, 0.3, 0.9
    scene = scenes.stick_slip_oscillator(amplitude=F, omega=omega)
    orbit = periodic_orbit(scene, [0.39, belt])
    with mp.workdps(30):
        after = block(*map(mp.mpf, (belt, static, kinetic, F, omega)))
        x = mp.findroot(lambda y: after(y)[2] - y, mp.mpf("0.392"))
        leave, stick, _ = after(x)
        slope = mp.diff(lambda y: after(y)[2], x)
    assert orbit.name == "O(1, 2)"
    assert orbit.x[0] == pytest.approx([float(x), belt], rel=0, abs=MOST)
    assert orbit.time == pytest.approx([float(leave), float(stick)], rel=0, abs=MOST)
    assert orbit.multipliers.real == pytest.approx([float(slope), 0.0], rel=1e-8, abs=1e-14)
    assert orbit.multipliers[1] == 0.0  # captured by the belt, it forgets how fast it came


def test_a_block_that_passes_the_belt_without_sticking_forgets_nothing():
    """It reaches the belt's speed while the pull is beyond the static friction, and goes on at once."""
    scene = scenes.stick_slip_oscillator(belt=0.2, static=0.35, kinetic=0.3, amplitude=1.6, omega=0.7)
    P = PeriodMap(scene, METHOD)
    x = np.array([0.3, -1.4])
    run = P.follow(x, 1)
    times = run.time[0, 0][np.isfinite(run.time[0, 0])]
    assert np.any(np.diff(times) == 0.0)  # into the sticking mode and out of it at one instant
    np.testing.assert_allclose(P.jacobian(x), differences(P, x), rtol=0, atol=1e-7)
    assert abs(np.linalg.det(P.jacobian(x))) > 1e-3


# --- dry friction, a Filippov system


def den_hartog(drag, F, omega):
    """Symmetric motion of x'' + x = -drag sign(x') + F sin(omega t) without a stop: time and place of the maximum."""
    with mp.workdps(30):
        half = mp.pi / omega
        # F sin(omega t) is F cos(omega (t - T/4)); moving back from the maximum, the drag pushes forwards
        shift = mp.pi / (2 * mp.mpf(omega))

        def match(t, x):
            back = oscillator(mp.mpf(1), 0, mp.mpf(F), mp.mpf(omega), t - shift, x, 0, mp.mpf(drag))
            end = back(t - shift + half)
            return [end[0] + x, end[1]]

        t, x = mp.findroot(match, (0.5 * float(half) if omega < 1.0 else 1.5 * float(half), F))
        turn = mp.mpf(F) * mp.sin(mp.mpf(omega) * t) - x  # acceleration less the friction at the maximum
        passage = mp.matrix([[1, 0], [0, (turn + drag) / (turn - drag)]])
        J = passage * propagator(mp.mpf(1), 0, half)
        return float(t), float(x), [m * m for m in eigenvalues(J)]


@pytest.mark.parametrize("omega", [0.7, 1.6])
def test_dry_friction_without_a_stop_is_den_hartogs_motion(omega):
    drag, F = 0.1, 0.8
    scene = scenes.dry_friction_oscillator(drag=drag, amplitude=F, omega=omega)
    t, x, multipliers = den_hartog(drag, F, omega)
    start = StroboscopicMap(scene, METHOD).follow([x, 0.1], 400).final[0]
    orbit = periodic_orbit(scene, start)
    assert orbit.name == "O(1, 2)"
    assert not orbit.sticks
    turns = np.sort(orbit.time % scene.period)
    assert np.min(np.abs(turns - t % scene.period)) < 1e-9
    assert np.max(np.abs(orbit.run().switches.before[:, 0])) == pytest.approx(abs(x), abs=1e-9)
    found = np.sort_complex(orbit.multipliers)
    assert found == pytest.approx(np.sort_complex(np.array(multipliers, dtype=complex)), abs=1e-7)


@pytest.mark.parametrize("phase", [0.0, 0.2, 0.37])
def test_one_multiplier_is_zero_where_a_motion_slides(phase):
    """Also with a section in the sliding phase, where a start is put on the surface."""
    scene = scenes.dry_friction_oscillator(drag=0.4, amplitude=0.9, omega=0.3)
    P = PeriodMap(scene, METHOD, phase)
    orbit = periodic_orbit(scene, P.follow([0.2, 0.0], 30).final[0], phase=phase)
    assert orbit.sticks
    assert orbit.name.startswith("O(1, ")
    assert "chattering" not in orbit.name
    assert abs(orbit.multipliers[-1]) < 1e-12
    assert orbit.stable


# --- basins


@pytest.mark.slow
def test_every_cell_of_a_basin_goes_where_its_own_motion_goes():
    scene, method = scenes.driven_bilinear_oscillator(), EventDriven(1e-9, 1e-9)
    starts = random_starts([[-2.0, -4.0], [2.0, 4.0]], 20, seed=1)
    known = attractors(scene, method, starts, transient=200, window=24, longest=6)
    assert {a.name for a in known.found} == {"O(1, 2)", "O(3, 6)"}
    data = basins(scene, [-2.0, -4.0], [2.0, 4.0], (9, 9), method=method, known=known, longest=200, sample=0)
    centres = np.array([[q, v] for v in data["v"].values for q in data["q"].values])
    ends = periods(scene, METHOD, centres, 212, drop=200, most=0).states
    once = np.max(np.abs(ends[:, 1:] - ends[:, :-1]), axis=(1, 2)) < 1e-6
    own = np.where(once, "O(1, 2)", "O(3, 6)")
    assert set(own) == {"O(1, 2)", "O(3, 6)"}
    assert np.array_equal(data["name"].values[data["label"].values.ravel()], own)
