"""Contacts under loads that begin at zero, or touch it: the forces that follow decide what sticks, slides and opens.

A particle is pressed by w(t) and pulled along by a w(t): it sticks for ever where |a| <= mu, and slides with
sign(a) (|a| - mu) w(t) otherwise. Judges: closed forms, and Moreau's scheme.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from benchmarks.judge.describe import Description
from lagrangian import Coulomb, Harmonic, LinearContacts, LinearJoints, LinearSystem, Scene, System
from lcpstep import EventDriven, Located, Moreau, Status, simulate
from lcpstep.trajectory import Kind

METHODS = {"events": (EventDriven(), 1e-9), "2": (Located(2e-3), 2e-3), "4": (Located(5e-3, 4), 1e-5)}
SOME = settings(max_examples=8, deadline=None)

by_every_method = pytest.mark.parametrize("name", METHODS)
friction = st.floats(0.05, 1.0)
# ratio of pull to load, over the coefficient of friction: clearly on one side of the edge of the cone
ratio = st.one_of(st.floats(0.0, 0.98), st.floats(1.02, 3.0))
signs = st.sampled_from([-1.0, 1.0])


def sine(a):
    """The loads of sin t, and how far it takes a body of mass one from rest."""
    return Harmonic(constant=[0.0, 0.0], sine=[a, -1.0], omega=1.0), 3.0, lambda t: t - math.sin(t)


def touching(a):
    """The loads of 1 - cos 2 t, which touch zero every pi."""
    force = Harmonic(constant=[a, -1.0], cosine=[-a, 1.0], omega=2.0)
    return force, 7.0, lambda t: 0.5 * t * t - 0.5 * math.sin(t) ** 2


def arches(a):
    """The loads of |sin t|, with corners at pi and 2 pi."""

    def force(t, q, v, p, out):
        out[0] = p[0] * abs(math.sin(t))
        out[1] = -abs(math.sin(t))

    def way(t):
        k = math.floor(t / math.pi)
        return k * k * math.pi + 2.0 * k * (t - k * math.pi) + (t - k * math.pi) - math.sin(t - k * math.pi)

    return force, 9.0, way


LOADS = {"sine": sine, "touching": touching, "arches": arches}


def particle(mu, a, load="sine", restitution=0.5, **other):
    """A particle at rest on the floor; how far its load takes it."""
    force, t_end, way = LOADS[load](a)
    given = {"q0": [0.0, 0.0], "v0": [0.0, 0.0], "t_span": (0.0, t_end), "p": [a]}
    if load == "arches":
        given |= {"corners": [math.pi, 2.0 * math.pi]}
    rough = LinearContacts([[0.0, 1.0]], [0.0], [restitution], friction=Coulomb(mu, [[1.0, 0.0]]))
    return Scene(system=LinearSystem(np.eye(2), force=force), contacts=rough, **(given | other)), way


def slid(mu, a, way):
    """How far along the particle comes."""
    return math.copysign(max(0.0, abs(a) - mu), a) * way


def end(scene, method):
    """Where a run ends, which reaches its end."""
    run = simulate(scene, method, keep=[scene.t_span[1]])
    assert run.status == Status.DONE
    return run.q[-1]


@by_every_method
@pytest.mark.parametrize("load", LOADS)
@SOME
@given(mu=friction, share=ratio, sign=signs)
def test_a_load_from_zero_moves_the_particle_only_beyond_the_cone(name, load, mu, share, sign):
    method, close = METHODS[name]
    scene, way = particle(mu, sign * share * mu, load)
    x, y = end(scene, method)
    far = way(scene.t_span[1])
    assert abs(y) < 1e-9
    if share < 1.0:
        assert abs(x) < 1e-12
    assert abs(x - slid(mu, sign * share * mu, far)) < close * (1.0 + far)


@pytest.mark.parametrize("load", LOADS)
@pytest.mark.parametrize("share", [0.4, 2.0])
def test_time_stepping_agrees(load, share):
    scene, _ = particle(0.3, share * 0.3, load)
    assert np.max(np.abs(end(scene, Moreau(1e-3)) - end(scene, EventDriven()))) < 0.02


@by_every_method
@SOME
@given(mu=friction, v=st.floats(2.0, 3.0), sign=signs)
def test_what_slides_is_braked_by_a_load_from_zero(name, mu, v, sign):
    method, close = METHODS[name]
    scene, way = particle(mu, 0.0, v0=[sign * v, 0.0])
    assert abs(end(scene, method)[0] - sign * (3.0 * v - mu * way(3.0))) < 10.0 * close


@by_every_method
@SOME
@given(mu=friction, a=st.floats(-1.0, 1.0))
def test_a_load_from_zero_that_lifts_opens_the_contact(name, mu, a):
    method, close = METHODS[name]
    scene, way = particle(mu, a)
    force = Harmonic(constant=[0.0, 0.0], sine=[a, 1.0], omega=1.0)
    scene = replace(scene, system=LinearSystem(np.eye(2), force=force))
    assert np.max(np.abs(end(scene, method) - way(3.0) * np.array([a, 1.0]))) < 10.0 * close


def cancelling(t, q, v, p, out):
    """The loads of sin t, beside parts that cancel but for 5e-17, which lifts."""
    out[0], out[1] = p[0] * math.sin(t), (0.1 + 0.2 - 0.3) - math.sin(t)


@by_every_method
@pytest.mark.parametrize("a", [0.3, 0.9])
def test_rounding_of_forces_that_cancel_lifts_nothing(name, a):
    """Let go by it, an elastic contact would come back, and hop by hops below rounding for ever."""
    scene, way = particle(0.5, a, restitution=1.0)
    scene = replace(scene, system=LinearSystem(np.eye(2), force=cancelling))
    method, accuracy = METHODS[name]
    run = simulate(scene, replace(method, max_events=50), keep=[3.0])
    assert len(run.impacts) == 1
    np.testing.assert_allclose(run.q[-1], [slid(0.5, a, way(3.0)), 0.0], atol=accuracy)


@by_every_method
@SOME
@given(mu=friction, share=ratio, sign=signs)
def test_what_lands_while_the_load_touches_zero(name, mu, share, sign):
    """It lands at t = pi, when the load is zero, without sliding, and without restitution."""
    method, close = METHODS[name]
    a = sign * share * mu
    scene, way = particle(mu, a, "touching", v0=[-a * math.pi, -1.0], q0=[0.0, math.pi + 0.5 * math.pi**2])
    rough = LinearContacts([[0.0, 1.0]], [0.0], [0.0], friction=Coulomb(mu, [[1.0, 0.0]]))
    scene = replace(scene, contacts=rough)
    x, y = end(scene, method)
    assert abs(y) < 1e-9
    assert abs(x + 0.5 * a * math.pi**2 - slid(mu, a, way(7.0 - math.pi))) < 30.0 * close


@by_every_method
@SOME
@given(
    mus=st.tuples(friction, friction),
    shares=st.tuples(ratio, ratio),
    load=st.sampled_from(["sine", "touching"]),
)
def test_two_particles_are_decided_each_by_its_own_load(name, mus, shares, load):
    method, close = METHODS[name]
    a = np.multiply(mus, shares)
    (one, t_end, way), (two, _, _) = LOADS[load](a[0]), LOADS[load](a[1])
    constant, cosine, sine = np.concatenate([one.terms(2), two.terms(2)], axis=1)
    force = Harmonic(constant=constant, cosine=cosine, sine=sine, omega=one.omega)
    rows, tangents = np.eye(4)[1::2], np.eye(4)[::2]
    scene = Scene(
        system=LinearSystem(np.eye(4), force=force), q0=np.zeros(4), v0=np.zeros(4), t_span=(0.0, t_end),
        contacts=LinearContacts(rows, [0.0, 0.0], [0.5, 0.5], friction=Coulomb(mus, tangents)),
    )  # fmt: skip
    exact = [slid(mu, pull, way(t_end)) for mu, pull in zip(mus, a, strict=True)]
    assert np.max(np.abs(end(scene, method)[::2] - exact)) < close * (1.0 + way(t_end))


@by_every_method
@SOME
@given(mu=friction, share=ratio, sign=signs, height=st.floats(-0.1, 0.1))
def test_a_block_on_two_feet_under_a_load_from_zero(name, mu, share, sign, height):
    method, close = METHODS[name]
    a = sign * share * mu
    force = Harmonic(constant=np.zeros(3), sine=[a, -1.0, 0.0], omega=1.0)
    feet = LinearContacts(
        [[0.0, 1.0, 0.5], [0.0, 1.0, -0.5]], [0.0, 0.0], [0.5, 0.5],
        friction=Coulomb(mu, [[1.0, 0.0, height], [1.0, 0.0, height]]),
    )  # fmt: skip
    M = np.diag([1.0, 1.0, 0.1])
    scene = Scene(
        system=LinearSystem(M, force=force), contacts=feet, q0=[0.0] * 3, v0=[0.0] * 3, t_span=(0.0, 3.0)
    )
    x, y, turn = end(scene, method)
    assert max(abs(y), abs(turn)) < 1e-9
    assert abs(x - slid(mu, a, 3.0 - math.sin(3.0))) < 10.0 * close


@by_every_method
@SOME
@given(mu=friction, share=ratio, sign=signs)
def test_a_joint_shares_the_pull(name, mu, share, sign):
    """The particle draws another one of the same mass along: half the acceleration."""
    method, close = METHODS[name]
    a = sign * share * mu
    force = Harmonic(constant=np.zeros(3), sine=[0.0, -1.0, a], omega=1.0)
    scene = Scene(
        system=LinearSystem(np.eye(3), force=force), joints=LinearJoints([[1.0, 0.0, -1.0]], [0.0]),
        contacts=LinearContacts([[0.0, 1.0, 0.0]], [0.0], [0.5], friction=Coulomb(mu, [[1.0, 0.0, 0.0]])),
        q0=[0.0] * 3, v0=[0.0] * 3, t_span=(0.0, 3.0),
    )  # fmt: skip
    x, _, z = end(scene, method)
    assert abs(x - z) < 1e-9
    assert abs(x - 0.5 * slid(mu, a, 3.0 - math.sin(3.0))) < 10.0 * close


def pulled(share, omega, start=0.0, beside=False):
    """1 - cos x + b sin x = 2 sin(x/2) (sin(x/2) + b cos(x/2)), x = omega t, is negative from 2 pi k - 2 atan b.

    `beside`: with a second coordinate that moves by itself. The scene, and the times at which its wall lets go.
    """
    load = {"constant": [20.3], "cosine": [-20.3], "sine": [20.3 * share]}
    M, K, G, q0 = [2.4], [0.0], [-1.0], [2.5]
    if beside:
        load = {name: [*values, 0.0] for name, values in load.items()}
        M, K, G, q0 = [*M, 1.0], [*K, 1.0], [*G, 0.0], [*q0, 0.1]
    block = LinearSystem(M=np.diag(M), K=np.diag(K), force=Harmonic(omega=omega, **load))
    wall = LinearContacts(G=[G], offset=2.5, restitution=0.0)
    span = (start, start + 10.9)
    scene = Scene(block, q0=q0, v0=np.zeros(len(q0)), t_span=span, contacts=wall, name="pulled for a moment")
    expected = (2.0 * np.pi * np.arange(1, 20) - 2.0 * np.arctan(share)) / omega
    return scene, expected[(expected > span[0]) & (expected < span[1])]


@pytest.mark.parametrize("share", [0.3, 0.0243, 3e-3, 1e-4])
@pytest.mark.parametrize("omega", [5.0, 5.4, 6.2, 6.9])
def test_a_force_that_pulls_for_a_moment_lets_go_wherever_samples_of_it_fall(share, omega):
    scene, expected = pulled(share, omega)
    log = simulate(scene, EventDriven()).impacts
    np.testing.assert_allclose(log.time[log.kind == Kind.RELEASE], expected, atol=1e-9)


@pytest.mark.parametrize("start", [0.0, 0.2589, 0.2697, 0.31, 0.64, 0.87])
@pytest.mark.parametrize("share", [0.0243, 3e-3])
@pytest.mark.parametrize("beside", [False, True])
@pytest.mark.parametrize(
    "method",
    [EventDriven(), Located(0.07, 4), Located(0.07, 4, tolerance=1e-6), Located(0.07, "exact")],
    ids=["event-driven", "located-4", "located-4-tolerance", "located-exact"],
)
def test_it_does_by_every_method_of_high_order_beside_other_motion_and_near_the_end(
    method, beside, share, start
):
    """In steps that are long beside the moment it may come back and leave again within it."""
    scene, expected = pulled(share, 6.2, start, beside)
    log = simulate(scene, method).impacts
    times = log.time[log.kind == Kind.RELEASE]
    assert len(expected) >= 10
    assert np.max(np.min(np.abs(times - expected[:, None]), axis=1)) < 1e-9
    assert len(times) <= len(expected) + 2


@pytest.mark.slow
def test_in_a_slit_the_wall_that_the_load_will_press_bears_it_from_the_start():
    """26208 N of a spring against a force that differs from it by 0.451 (cos 10 t - 1) N, and by rounding.

    At the start the sum is rounding alone, and names the other wall.
    """
    slit = Description(
        M=((0.415,),), q0=(-1.12,), v0=(0.0,), t_span=(0.0, 0.746112), h=0.000384, G=((1.0,), (-1.0,)),
        offset=(1.12, -1.12), restitution=(0.3, 0.81), K=((23400.0,),), constant=(-26207.62331369539,),
        cosine=(-0.451,), force_omega=10.0, general=True, spread=0.656, pendulum=0.357, b=(0.44,),
    )  # fmt: skip
    m = simulate(slit.scene(), EventDriven())
    load = 0.451 * (m.t - np.sin(10.0 * m.t) / 10.0)
    np.testing.assert_allclose(np.cumsum(m.impulse[:, 1]), load, atol=1e-11)
    assert np.max(np.abs(m.impulse[:, 0])) <= 1e-15


def lifted_soon(t, q, v, p, out):
    out[0] = 4.0 * (q[1] - q[0]) - 1.0 + 1e3 * t
    out[1] = 4.0 * (q[0] - q[1])


def test_a_body_that_nothing_presses_does_not_ask_when_another_leaves():
    # one at the end of a relaxed spring, the other lifted off a millisecond later, within the first look
    contacts = LinearContacts([[1.0, 0.0], [0.0, -1.0]], restitution=0.5)
    system = System(2, np.eye(2), lifted_soon)
    m = simulate(Scene(system, [0.0, 0.0], [0.0, 0.0], (0.0, 0.1), contacts), EventDriven(max_events=1000))
    leaves = m.impacts[m.impacts.kind == Kind.RELEASE]
    np.testing.assert_array_equal(leaves.contact, [0])
    np.testing.assert_allclose(leaves.time, 1e-3, rtol=1e-12)


@by_every_method
def test_what_nothing_presses_slides_on_as_it_is_drawn_where_it_keeps_up_with_its_belt(name):
    """A body on a spring, as fast as the belt where it is fastest: then it begins to slide, by the spring."""

    def spring(t, q, v, p, out):
        out[0], out[1] = -10.0 * q[0], 0.0

    (method, close), w = METHODS[name], math.sqrt(5.0)
    contacts = LinearContacts([[0.0, 1.0]], friction=Coulomb(0.5, [[1.0, 0.0]], slip=[-1.0]))
    scene = Scene(System(2, 2.0 * np.eye(2), spring), [0.0, 0.0], [-1.0, 0.0], (0.0, 2.0), contacts)
    for m in (simulate(scene, method), simulate(scene, Located(1e-2))):
        assert m.status is Status.DONE
        np.testing.assert_allclose(m.q[-1], [-math.sin(2.0 * w) / w, 0.0], atol=max(close, 1e-4))
