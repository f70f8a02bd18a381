"""Coefficients of friction that differ between sticking and sliding, or depend on the sliding velocity."""

import math

import numpy as np
import pytest

from lagrangian import Contacts, Coulomb, Harmonic, LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Kind, Located, Moreau, SimulationError, Status, simulate

G0 = 9.81
FLOOR, ALONG = [[0.0, 1.0]], [[1.0, 0.0]]


def belt(friction, x0=0.0, v0=0.2, t_end=10.0, k=40.0, force=None, p=(), m=2.0):
    """A block on a spring, on a belt."""
    return Scene(
        system=LinearSystem(
            m * np.eye(2), K=np.diag([k, 0.0]), force=[0.0, -m * G0] if force is None else force
        ),
        contacts=LinearContacts(FLOOR, friction=friction), q0=[x0, 0.0], v0=[v0, 0.0], t_span=(0.0, t_end), p=list(p),
    )  # fmt: skip


def phases(mu_s, mu, V, k=40.0, m=2.0):
    """How long the block on the belt sticks and slides, and where it begins to slide.

    It rides along with the belt up to k x = mu_s m g. Then x'' = -w^2 (x - x_k), x_k = mu g / w^2, up to the next
    time of x' = V, by symmetry at 2 x_k - x_s.
    """
    w = math.sqrt(k / m)
    x_s, x_k = mu_s * G0 / w**2, mu * G0 / w**2
    A = x_s - x_k
    return 2.0 * A / V, (2.0 * math.pi - 2.0 * math.atan(A * w / V)) / w, x_s


@pytest.mark.parametrize(("mu_s", "mu", "V"), [(0.5, 0.3, 0.2), (0.9, 0.1, 0.05), (0.31, 0.3, 1.0)])
def test_a_block_on_a_belt_sticks_and_slips_at_its_times(mu_s, mu, V):
    stick, slide, x_s = phases(mu_s, mu, V)
    scene = belt(Coulomb(mu, ALONG, slip=-V, mu_s=mu_s), v0=V, t_end=x_s / V + 4.5 * (stick + slide))
    run = simulate(scene, EventDriven())
    begins = run.impacts.time[run.impacts.kind == Kind.SLIP]
    ends = run.impacts.time[run.impacts.kind == Kind.STICK_TANGENT]
    assert run.status == Status.DONE
    assert len(begins) == 5
    expected = x_s / V + (stick + slide) * np.arange(len(begins))
    assert np.max(np.abs(begins - expected)) < 1e-10
    assert np.max(np.abs(ends - expected[: len(ends)] - slide)) < 1e-10
    assert np.max(np.abs(run.at(begins)[0][:, 0] - x_s)) < 1e-10


def test_equal_coefficients_are_the_same_as_one():
    one, two = (
        simulate(belt(Coulomb(0.3, ALONG, slip=-0.2, mu_s=mu_s)), EventDriven(1e-10, 1e-10))
        for mu_s in (None, 0.3)
    )
    assert np.array_equal(one.q, two.q)
    assert np.array_equal(one.impacts, two.impacts)


def test_moreaus_scheme_comes_to_the_same_stick_and_slip():
    scene = belt(Coulomb(0.3, ALONG, slip=-0.2, mu_s=0.5), t_end=3.0)
    t = np.linspace(0.0, 3.0, 61)
    exact = simulate(scene, EventDriven(), keep=t).q
    errors = []
    for n in (500, 2000, 8000):
        steps = [3.0 / round(n * s) for s in (1.0, 1.07, 1.13, 1.21)]
        errors.append(np.mean([np.max(np.abs(simulate(scene, Moreau(h), keep=t).q - exact)) for h in steps]))
    assert errors[1] < 0.4 * errors[0]
    assert errors[2] < 0.4 * errors[1]
    assert errors[2] < 5e-4


def test_steps_by_a_tolerance_come_to_it_too():
    scene = belt(Coulomb(0.3, ALONG, slip=-0.2, mu_s=0.5), t_end=3.0)
    exact = simulate(scene, EventDriven(), keep=[3.0]).q[-1]
    errors = [
        np.max(np.abs(simulate(scene, Moreau(0.1, tolerance=tol), keep=[3.0]).q[-1] - exact))
        for tol in (1e-3, 1e-5)
    ]
    assert errors[0] < 1e-2
    assert errors[1] < 1e-4


def stribeck(t, q, u, p, out):
    """Friction that falls from p[1] to p[0] over velocities of the size of p[2]."""
    for c in range(len(out)):
        out[c] = p[0] + (p[1] - p[0]) / (1.0 + abs(u[c]) / p[2])


def test_a_coefficient_that_is_constant_is_that_number():
    p = [0.3, 0.3, 1.0]
    fixed = simulate(belt(Coulomb(0.3, ALONG, slip=-0.2)), EventDriven(1e-11, 1e-11))
    function = simulate(belt(Coulomb(stribeck, ALONG, slip=-0.2), p=p), EventDriven(1e-11, 1e-11))
    assert np.max(np.abs(fixed.q[-1] - function.q[-1])) < 1e-9
    assert np.array_equal(fixed.impacts.kind, function.impacts.kind)
    static = simulate(belt(Coulomb(0.3, ALONG, slip=-0.2, mu_s=0.5)), EventDriven(1e-11, 1e-11))
    function = simulate(belt(Coulomb(stribeck, ALONG, slip=-0.2, mu_s=0.5), p=p), EventDriven(1e-11, 1e-11))
    assert np.max(np.abs(static.q[-1] - function.q[-1])) < 1e-9


def falling(t, q, u, p, out):
    """mu = p[0] - p[1] |u|."""
    out[0] = p[0] - p[1] * abs(u[0])


def test_a_block_that_slides_to_its_stop_on_a_surface_with_falling_friction():
    """u' = -g (a - b u): u = (u0 - a/b) exp(b g t) + a/b; it stops at t = log(a / (a - b u0)) / (b g)."""
    a, b, u0 = 0.5, 0.2, 2.0
    scene = belt(Coulomb(falling, ALONG), v0=u0, k=0.0, p=[a, b])
    run = simulate(scene, EventDriven())
    stop = math.log(a / (a - b * u0)) / (b * G0)
    assert abs(run.impacts.time[run.impacts.kind == Kind.STICK_TANGENT][0] - stop) < 1e-11
    way = (u0 - a / b) * math.expm1(b * G0 * stop) / (b * G0) + a / b * stop
    assert abs(run.q[-1, 0] - way) < 1e-11
    assert np.all(run.v[-1] == 0.0)
    errors = [abs(simulate(scene, Moreau(h)).q[-1, 0] - way) for h in (1e-3, 1e-4, 1e-5)]
    assert errors[1] < 0.2 * errors[0]
    assert errors[2] < 0.2 * errors[1]


def thick(t, q, u, p, out):
    """mu = p[0] |u|, which holds nothing at rest."""
    out[0] = p[0] * abs(u[0])


@pytest.mark.parametrize("V", [0.7, -0.7])
def test_friction_in_proportion_to_the_velocity_is_damping(V):
    """x'' = -w^2 x - c (x' - V), c = mu g: around x = c V / w^2 a damped oscillation, through rest and back."""
    mu, w2 = 0.05, 20.0
    run = simulate(belt(Coulomb(thick, ALONG, slip=-V), v0=0.0, p=[mu], t_end=4.0), EventDriven(1e-11, 1e-11))
    c = mu * G0
    w_d = math.sqrt(w2 - 0.25 * c * c)
    x_e, t = c * V / w2, 4.0
    x = x_e - x_e * math.exp(-0.5 * c * t) * (math.cos(w_d * t) + 0.5 * c / w_d * math.sin(w_d * t))
    assert abs(run.q[-1, 0] - x) < 1e-9


def test_feet_that_share_a_direction_hold_together_with_what_each_holds_at_rest():
    """Half the weight on each; the block slides once the force exceeds the sum of both cones, kinetic ones then."""
    scene = Scene(
        system=LinearSystem(
            np.diag([1.0, 1.0, 0.1]), force=Harmonic(constant=[0, -G0, 0], sine=[9.0, 0, 0], omega=1.0)
        ),
        contacts=LinearContacts(
            [[0, 1, 0.3], [0, 1, -0.3]], friction=Coulomb(0.3, [[1, 0, 0.0]] * 2, mu_s=[0.5, 0.7])
        ),
        q0=[0.0] * 3, v0=[0.0] * 3, t_span=(0.0, 1.5),
    )  # fmt: skip
    run = simulate(scene, EventDriven())
    begin = math.asin(0.6 * G0 / 9.0)
    assert abs(np.min(run.impacts.time[run.impacts.kind == Kind.SLIP]) - begin) < 1e-9
    tau = 1.5 - begin
    x = 9.0 * (math.cos(begin) * tau - (math.sin(1.5) - math.sin(begin))) - 0.15 * G0 * tau**2
    assert abs(run.q[-1, 0] - x) < 1e-9
    fine = simulate(scene, Moreau(1e-5)).q[-1, 0]
    assert abs(fine - x) < 1e-4


def on_feet(feet, mu, mu_s, pull, turn=0.0, rate=0.0):
    """A block that is pulled, a little below its centre, by `pull` of its weight, and more with the time."""
    ramp = Harmonic(constant=[pull * G0, -G0, turn], sine=[rate * G0, 0.0, 0.0], omega=1.0)
    friction = Coulomb(mu, [[1.0, 0.0, 0.1]] * len(feet), mu_s=mu_s)
    return Scene(
        system=LinearSystem(np.diag([1.0, 1.0, 0.1]), force=ramp), q0=[0.0] * 3, v0=[0.0] * 3, t_span=(0.0, 0.3),
        contacts=LinearContacts([[0.0, 1.0, x] for x in feet], friction=friction),
    )  # fmt: skip


@pytest.mark.parametrize(
    "method", [EventDriven(), Located(0.01), Located(0.01, 4), Moreau(1e-3), Moreau(0.01, tolerance=1e-5)]
)
@pytest.mark.parametrize(
    ("feet", "mu", "mu_s", "pull", "turn"),
    [
        ([0.3, 0.1, -0.1, -0.3], 0.3, 0.6, 0.59, -0.5),  # two feet carry all, or three
        ([0.3, 0.0, -0.3], [0.3, 0.1, 0.3], None, 0.25, 0.0),  # held by the outer feet, not by the middle one
    ],
)
def test_more_feet_than_are_needed_hold_where_their_cones_can(method, feet, mu, mu_s, pull, turn):
    run = simulate(on_feet(feet, mu, mu_s, pull, turn), method)
    assert run.status == Status.DONE
    assert np.max(np.abs(run.q)) < 1e-30


def test_more_feet_than_are_needed_hold_up_to_what_their_cones_can_in_any_way():
    """The outer feet carry what they can: the turning moment leaves nothing to the one in the middle at last."""
    run = simulate(on_feet([0.3, 0.0, -0.3], [0.3, 0.1, 0.3], None, 0.2, rate=1.0), EventDriven())
    begin = math.asin(0.3 - 0.2)
    assert abs(np.min(run.impacts.time[run.impacts.kind == Kind.SLIP]) - begin) < 1e-9
    assert np.max(np.abs(run.at(np.linspace(0.0, begin, 50))[0])) < 1e-15


def test_a_coefficient_that_becomes_negative_on_the_way_is_named():
    """mu = 0.5 - 0.2 u, of a block that is pulled faster and faster."""
    pulled = belt(Coulomb(falling, ALONG), v0=0.1, k=0.0, force=[30.0, -2.0 * G0], p=[0.5, 0.2])
    for method in (EventDriven(), Moreau(1e-3)):
        with pytest.raises(
            SimulationError, match=r"friction\.mu: expected coefficients >= 0, got -.* of contact 0"
        ) as e:
            simulate(pulled, method)
        assert 2.49 < e.value.trajectory.v[-1, 0] < 2.52


def negative(t, q, u, p, out):
    out[0] = -0.1


def nothing(t, q, u, p, out):
    pass


def no_number(t, q, u, p, out):
    out[0] = math.nan


def beyond(t, q, u, p, out):
    """Takes the velocities of the contacts for those of the coordinates."""
    out[0] = 0.3 + u[1]


def slope_gap(t, q, v, p, out):
    out[0] = q[1]


def slope_normal(t, q, v, p, out):
    out[0, 0], out[0, 1] = math.sin(q[0]), 1.0


def straight(t, q, v, p, out):
    out[0, 0], out[0, 1] = 0.0, 2.0


def along_the_normal(t, q, v, p, out):
    out[0, 0], out[0, 1] = 3.0 * math.sin(q[0]), 3.0


def curved(tangent):
    return Scene(
        system=LinearSystem(np.eye(2)), q0=[0.0, 1.0], v0=[0.0, 0.0], t_span=(0.0, 1.0),
        contacts=Contacts(1, slope_gap, slope_normal, friction=Coulomb(0.3, tangent)),
    )  # fmt: skip


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: belt(Coulomb(-0.1, ALONG)), "friction.mu: expected coefficients >= 0"),
        (lambda: belt(Coulomb(0.3, ALONG, mu_s=0.2)), "friction.mu_s: expected .* not below mu"),
        (lambda: belt(Coulomb(0.3, ALONG, mu_s=[0.4, 0.5])), "friction.mu_s"),
        (lambda: belt(Coulomb(stribeck, ALONG, mu_s=0.2), p=[0.1, 0.3, 1.0]), "friction.mu_s"),
        (lambda: belt(Coulomb(negative, ALONG)), "friction.mu: expected coefficients >= 0, got .*-0.1"),
        (
            lambda: belt(Coulomb(nothing, ALONG)),
            r"friction.mu: out .* not filled .* sliding velocities u = \[0.2\]",
        ),
        (lambda: belt(Coulomb(no_number, ALONG)), "friction.mu: out .* not finite"),
        (
            lambda: belt(Coulomb(beyond, ALONG)),
            r"friction.mu: f\(t, q, u, p, out\) with .* velocities u of shape \(1,\)",
        ),
        (lambda: belt(Coulomb(0.3, [[0.0, 2.0]])), "friction.tangent: row 0 is parallel to the normal"),
        (lambda: belt(Coulomb(negative, [[0.0, 2.0]])), "friction.mu"),
        (lambda: curved(along_the_normal), "friction.tangent: row 0 is parallel"),
        (lambda: belt(Coulomb(0.3, ALONG, law="poisson")), "friction.law: expected one of 'moreau'"),
        (lambda: belt(Coulomb(0.3, ALONG, restitution=0.5, law="newton")), "friction.restitution"),
    ],
)
def test_what_is_no_law_of_friction_is_named_before_the_run(make, said):
    with pytest.raises(ValueError, match=said):
        make()


def test_normal_and_tangent_may_be_parallel_at_one_place():
    assert curved(straight).n_c == 1
    assert belt(Coulomb(0.0, [[0.0, 2.0]])).n_c == 1
