"""Laws of frictional impact by name: what each makes of an impact, and that the one of energy creates none."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lagrangian import Coulomb, LinearContacts, LinearSystem, Scene, scenes
from lagrangian.scenes.kane_pendulum import kinetic_energy
from lcpstep import EventDriven, Kind, Located, Moreau, Status, energy, simulate
from tests.marks import slow
from tests.uncompiled import both_ways

G0 = 9.81


def step_by_step(W, mu, e, u, n=4000):
    """Velocities (u_N, u_T) after an impact, by small steps of the normal impulse; `u` before it."""
    u, taken, given_back = np.array(u, dtype=float), 0.0, 0.0
    dp = abs(u[0]) / W[0, 0] / n
    compressed = False
    while not compressed or given_back < e * e * taken:
        push = W[:, 0] * dp
        wanted = -(u[1] + push[1]) / W[1, 1]
        before = u[0]
        u = u + push + W[:, 1] * max(-mu * dp, min(mu * dp, wanted))
        work = 0.5 * (before + u[0]) * dp
        if compressed:
            given_back += work
        else:
            taken -= work
            compressed = u[0] >= 0.0
    return u


def drawn(seed, contacts=1):
    """A body that strikes, without forces: masses, directions, friction and restitution drawn."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(2, 5)) if contacts == 1 else int(rng.integers(2, 2 * contacts + 1))
    A = rng.normal(size=(n, n))
    M = A @ A.T + 0.1 * np.eye(n)
    G, T, v = rng.normal(size=(contacts, n)), rng.normal(size=(contacts, n)), rng.normal(size=n)
    if contacts == 1 and G[0] @ v > 0.0:
        v = -v
    r = rng.uniform(0.0, 1.0, contacts)
    return Scene(
        system=LinearSystem(M),
        contacts=LinearContacts(
            G, restitution=r, friction=Coulomb(rng.uniform(0.0, 2.0, contacts), T, law="stronge")
        ),
        q0=np.zeros(n), v0=v, t_span=(0.0, 1e-9),
    )  # fmt: skip


def mobility(scene):
    c = scene.contacts
    D = np.vstack([c.G, c.friction.tangent])
    return D, D @ np.linalg.solve(scene.system.M, D.T)


@pytest.mark.parametrize("seed", slow(range(25), longest=range(10, 25)))
def test_an_impact_by_small_steps_of_its_impulse_ends_the_same(seed):
    scene = drawn(seed)
    D, W = mobility(scene)
    r, mu = float(scene.contacts.restitution[0]), float(scene.contacts.friction.mu[0])
    run = simulate(scene, EventDriven())
    expected = step_by_step(W, mu, r, D @ scene.v0)
    scale = np.max(np.abs(D @ scene.v0)) + np.max(np.abs(expected))
    assert np.max(np.abs(D @ run.v[0] - expected)) < 1e-2 * scale


@settings(max_examples=200, deadline=None)
@given(st.integers(0, 10**9))
def test_no_single_impact_creates_energy_and_no_friction_leaves_its_cone(seed):
    scene = drawn(seed)
    run = simulate(scene, EventDriven())
    M, v0, v = scene.system.M, np.asarray(scene.v0), run.v[0]
    assert run.status == Status.DONE
    assert v @ M @ v <= v0 @ M @ v0 * (1.0 + 1e-12)
    assert (scene.contacts.G @ v)[0] >= -1e-12
    assert abs(run.friction_impulse[0, 0]) <= scene.contacts.friction.mu[0] * run.impulse[0, 0] * (
        1.0 + 1e-12
    )


@settings(max_examples=100, deadline=None)
@given(st.integers(0, 10**9), st.integers(2, 4))
def test_no_impact_of_several_contacts_creates_energy(seed, contacts):
    scene = drawn(seed, contacts)
    run = simulate(scene, EventDriven())
    M, v0, v = scene.system.M, np.asarray(scene.v0), run.v[-1]
    assert v @ M @ v <= v0 @ M @ v0 * (1.0 + 1e-9)
    if run.status == Status.DONE:
        assert np.min(scene.contacts.G @ v) >= -1e-9
    else:  # with coefficients up to two they may jam afterwards, and more contacts than directions have nowhere to go
        jams = (Status.PAINLEVE_INCONSISTENT, Status.PAINLEVE_INDETERMINATE)
        assert run.status in jams or (run.status == Status.LCP_FAILED and len(v0) <= contacts + 1)


def bent(angles, rates, mu, r, law):
    """Kane's pendulum just before its tip strikes, in any position."""
    scene = scenes.kane_pendulum(restitution=r, mu=mu, law=law)
    before = np.array(angles) - 1e-3 * np.array(rates)
    floor = math.cos(angles[0]) + math.cos(angles[1])
    return replace(scene, q0=before, v0=rates, p=[0.0, floor], t_span=(0.0, 2e-3))


@pytest.mark.slow
@settings(max_examples=150, deadline=None)
@given(
    st.floats(-1.2, 1.2), st.floats(-1.2, 1.2), st.floats(0.0, 2.0), st.floats(0.0, 1.0), st.floats(0.0, 6.3)
)
def test_kanes_pendulum_never_gains_whatever_its_angles(a, b, mu, r, way):
    rates = [math.cos(way), math.sin(way)]
    closing = rates[0] * math.sin(a) + rates[1] * math.sin(b)
    if closing > 0.0:
        rates = [-rates[0], -rates[1]]
    if (
        abs(closing) < 0.1 or abs(math.sin(a - b)) < 0.05
    ):  # aligned rods have normal and tangent in one direction
        return
    run = simulate(bent([a, b], rates, mu, r, "stronge"), EventDriven(1e-11, 1e-11))
    kept = [kinetic_energy(q, v) for q, v in zip(run.q, run.v, strict=True)]
    assert run.status == Status.DONE
    assert kept[-1] <= kept[0] * (1.0 + 1e-9)
    assert len(energy(run).created) == 0


@pytest.mark.parametrize(("law", "gain"), [("moreau", -0.4376), ("newton", 0.5875), ("stronge", -0.4468)])
def test_kanes_pendulum_by_each_law(law, gain):
    scene = scenes.kane_pendulum(law=law)
    at_rest = kinetic_energy(np.array(scene.q0), np.array(scene.v0))
    for run in (simulate(scene, EventDriven(), keep=[1e-6]), simulate(scene, Moreau(1e-7), keep=[1e-6])):
        assert abs(kinetic_energy(run.q[-1], run.v[-1]) / at_rest - 1.0 - gain) < 1e-4
    run = simulate(bent(np.radians([20.0, 30.0]), [-0.1, -0.2], 0.5, 0.5, law), EventDriven(), keep=1)
    assert (len(energy(run).created) > 0) == (gain > 0.0)


def disc(slip, mu, r, law):
    """A disc that falls onto a floor: its centre strikes, so normal and tangent do not act on each other."""
    return Scene(
        system=LinearSystem(np.diag([1.0, 1.0, 0.5]), force=[0.0, -G0, 0.0]),
        contacts=LinearContacts(
            [[0.0, 1.0, 0.0]], restitution=r, friction=Coulomb(mu, [[1.0, 0.0, 1.0]], law=law)
        ),
        q0=[0.0, 0.2, 0.0], v0=[slip, 0.0, 0.0], t_span=(0.0, 0.3),
    )  # fmt: skip


@pytest.mark.parametrize("mu", [0.02, 0.5])
def test_a_disc_slides_through_its_impact_or_rolls_out_of_it(mu):
    slip, r = 0.5, 0.6
    down = math.sqrt(2.0 * G0 * 0.2)
    push = (1.0 + r) * down
    friction = min(mu * push, slip / 3.0)  # W_TT = 1/m + R^2/J = 3
    for law in ("newton", "stronge"):  # which are one where normal and tangent are independent
        run = simulate(disc(slip, mu, r, law), EventDriven(), keep=[0.3])
        assert run.impacts.impulse[0] == pytest.approx(push, rel=1e-11)
        assert run.v[0, 0] == pytest.approx(slip - friction, abs=1e-11)
        assert run.v[0, 2] == pytest.approx(-2.0 * friction, abs=1e-11)


def slider(law, r):
    """A block on two feet that slides into a wall: the wall's friction presses it to the floor."""
    h = 0.1
    return Scene(
        system=LinearSystem(np.diag([1.0, 1.0, 0.03]), force=[0.0, -G0, 0.0]),
        contacts=LinearContacts(
            [[0, 1, 0.3], [0, 1, -0.3], [-1, 0, 0.02]], offset=[0.0, 0.0, 0.3], restitution=r,
            friction=Coulomb([0.2, 0.2, 0.4], [[1, 0, h], [1, 0, h], [0, 1, 0.3]], law=law),
        ),
        q0=[0.0, 0.0, 0.0], v0=[2.0, 0.0, 0.0], t_span=(0.0, 0.4),
    )  # fmt: skip


def total(scene, q, v):
    return 0.5 * v @ scene.system.M @ v + G0 * q[1]


@pytest.mark.parametrize("order", [2, 4])
@pytest.mark.parametrize("law", ["moreau", "newton", "stronge"])
def test_located_steps_have_the_same_impacts(law, order):
    scene = slider(law, 0.5)
    exact, steps = (
        simulate(scene, method, keep=[0.4]) for method in (EventDriven(), Located(5e-3, order=order))
    )
    assert np.max(np.abs(steps.q[-1] - exact.q[-1])) < 1e-9


@pytest.mark.parametrize("r", slow([0.0, 0.5], 0.0, longest=[0.5]))
def test_moreaus_steps_come_to_the_same_impacts_in_turn(r):
    scene = slider("stronge", r)
    exact = simulate(scene, EventDriven(1e-11, 1e-11), keep=[0.4])
    assert exact.status == Status.DONE
    errors = [
        np.max(np.abs(simulate(scene, Moreau(h), keep=[0.4]).q[-1] - exact.q[-1])) for h in (1e-4, 1e-5, 1e-6)
    ]
    assert errors[2] < 0.2 * errors[0]
    assert errors[2] < 1e-4
    assert total(scene, exact.q[-1], exact.v[-1]) < total(scene, scene.q0, np.asarray(scene.v0))


def test_the_fastest_strikes_first_and_equal_ones_by_number():
    """A bar that falls flat on two feet: the first foot turns it, the other one answers."""
    scene = Scene(
        system=LinearSystem(np.diag([1.0, 0.03])),
        contacts=LinearContacts(
            [[1, 0.3], [1, -0.3]], restitution=0.0, friction=Coulomb(0.1, [[0.0, 0.1]] * 2, law="stronge")
        ),
        q0=[0.0, 0.0], v0=[-1.0, 0.0], t_span=(0.0, 1e-6),
    )  # fmt: skip
    run = simulate(scene, EventDriven(), keep=[1e-6])
    assert np.min(np.asarray(scene.contacts.G) @ run.v[0]) > -1e-12
    assert run.v[0] @ scene.system.M @ run.v[0] < 1.0
    first = run.impacts[run.impacts.kind == Kind.IMPACT]
    assert set(first.contact) == {0, 1}
    tilted = replace(scene, v0=[-1.0, 0.1])  # the second foot is faster
    fast = simulate(tilted, EventDriven(), keep=[1e-6])
    mirrored = replace(scene, v0=[-1.0, -0.1])
    other = simulate(mirrored, EventDriven(), keep=[1e-6])
    assert np.max(np.abs(fast.impulse[0] - other.impulse[0][::-1])) < 1e-9


PROGRAM = """
import numpy as np
from lagrangian import Coulomb, LinearContacts, LinearSystem, Scene, scenes
from lcpstep import EventDriven, Moreau, simulate

def weak(t, q, u, p, out):
    out[0], out[1] = p[0] / (1.0 + abs(u[0])), p[0]

bar = Scene(
    system=LinearSystem(np.diag([1.0, 1.0, 0.03]), force=[0.5, -9.81, 0.0]),
    contacts=LinearContacts([[0, 1, 0.3], [0, 1, -0.3]], offset=[0.001, 0.0], restitution=[0.4, 0.2],
        friction=Coulomb(weak, [[1, 0, 0.1]] * 2, mu_s=0.7, law="stronge")),
    q0=[0.0, 0.0, 0.0], v0=[0.2, 0.0, 0.0], t_span=(0.0, 0.05), p=[0.4],
)
for scene in (bar, scenes.kane_pendulum(law="stronge")):
    for method in (EventDriven(1e-7, 1e-7), Moreau(1e-3)):
        run = simulate(scene, method, keep=1)
        print(len(run.t), run.counts, *(float(x).hex() for x in (*run.q[-1], *run.v[-1], *run.impacts.impulse)))
"""


@pytest.mark.slow
def test_the_kernels_as_plain_python_give_the_same():
    built, plain = both_ways(PROGRAM)
    assert built == plain
    assert len(built) == 4
