"""Grazing: gaps that close between two looks, for a moment, by hardly anything."""

import math

import numpy as np
import pytest

from lagrangian import LinearContacts, LinearSystem, Scene, System, scenes
from lcpstep import EventDriven, simulate
from lcpstep.trajectory import Kind, Status

ACCELERATION = 8.0
DEPTHS = [10.0**-k for k in range(2, 13)]


def pushed(t, q, v, p, out):
    out[0] = 8.0


CLOSED_FORM = LinearSystem(M=1.0, force=ACCELERATION)
RUNGE_KUTTA = System(n_q=1, mass=1.0, force=pushed)


def dip(system, depth, t_low=1.0, t_end=2.0, restitution=0.5):
    """Gap a (t - t_low)^2/2 - depth; the depth that it really has after rounding is returned with it."""
    top = 0.5 * ACCELERATION * t_low**2
    scene = Scene(
        system=system, contacts=LinearContacts(G=1.0, restitution=restitution), q0=top - depth,
        v0=-ACCELERATION * t_low, t_span=(0.0, t_end),
    )  # fmt: skip
    return scene, top - float(scene.q0[0])


@pytest.mark.parametrize("depth", DEPTHS)
@pytest.mark.parametrize("t_low", [1.0, 0.77, 0.5])
@pytest.mark.parametrize("system", [CLOSED_FORM, RUNGE_KUTTA], ids=["closed form", "Runge-Kutta"])
def test_every_touch_is_found_with_its_speed(system, depth, t_low):
    scene, d = dip(system, depth, t_low)
    m = simulate(scene, EventDriven())
    assert [e.kind for e in m.impacts] == [Kind.IMPACT]
    speed, e = math.sqrt(2 * d * ACCELERATION), m.impacts[0]
    # positions of size 4 are known to 1e-15 (by Runge-Kutta to its tolerance 1e-12), and with them u^2/2a
    known = 4e-15 if system is CLOSED_FORM else 4e-12
    assert abs(e.before**2 - speed**2) <= 2 * ACCELERATION * known
    assert abs(e.before + speed) <= 2 * math.sqrt(2 * ACCELERATION * known)
    assert abs(e.time - (t_low - speed / ACCELERATION)) <= 2 * math.sqrt(2 * known / ACCELERATION)
    assert e.after == -0.5 * e.before


@pytest.mark.parametrize("height", DEPTHS)
@pytest.mark.parametrize("system", [CLOSED_FORM, RUNGE_KUTTA], ids=["closed form", "Runge-Kutta"])
def test_near_misses_are_no_impacts(system, height):
    if system is RUNGE_KUTTA and height < 1e-11:
        return  # below its tolerance nothing can be told
    m = simulate(dip(system, -height)[0], EventDriven())
    assert len(m.impacts) == 0
    np.testing.assert_allclose(m.q[-1], 4.0 + height, rtol=1e-11)


@pytest.mark.parametrize("depth", [1e-13, 1e-14, 1e-15, 1e-16, 0.0])
@pytest.mark.parametrize("restitution", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("system", [CLOSED_FORM, RUNGE_KUTTA], ids=["closed form", "Runge-Kutta"])
def test_touches_at_the_limit_of_rounding_end_and_do_no_harm(system, depth, restitution):
    m = simulate(dip(system, depth, restitution=restitution)[0], EventDriven())
    assert m.status is Status.DONE
    assert len(m.impacts) <= 3
    # whether it was seen or not, the speed lost is that of the touch at most
    assert m.q[-1, 0] == pytest.approx(4.0, abs=4 * math.sqrt(2 * ACCELERATION * 1e-11))


@pytest.mark.parametrize("phase", np.linspace(0.0, 1.0, 11))
def test_an_oscillator_that_grazes_its_stop_is_seen_wherever_the_touch_falls(phase):
    # x = X cos(omega t + phase) with the stop just inside: no transients, one touch per period
    omega, zeta = 2.0, 0.05
    X = 1 / complex(1 - omega**2, 2 * zeta * omega)
    size, shift = abs(X), np.angle(X) + 2 * math.pi * phase
    t0 = 2 * math.pi * phase / omega
    depth = 1e-9
    scene = scenes.impact_oscillator(
        zeta=zeta, omega=omega, stop=size * (1 - depth), restitution=1.0, t_end=1.0
    )
    scene = Scene(
        system=scene.system, contacts=scene.contacts, q0=size * math.cos(shift) * (1 - 2 * depth),
        v0=-size * omega * math.sin(shift), t_span=(t0, t0 + 0.9 * math.pi), period=math.pi, name="grazing",
    )  # fmt: skip
    m = simulate(scene, EventDriven())
    assert m.status is Status.DONE
    assert np.all(scene.contacts.G[0, 0] * m.q + scene.contacts.offset > -1e-14)


@pytest.mark.parametrize("start", [0.0, -3.0, -0.001, 1.0, 17.0, 300.0])
@pytest.mark.parametrize("gap", [0.3, 0.0, -0.2])
def test_a_mass_on_a_spring_comes_back_to_its_wall_once_a_period(start, gap):
    """Beyond the wall the spring would bring it back as fast as it came: a period on, where the scan looks.

    m y'' + k (y - gap) = 0, the wall at 0: with restitution e the flight from the wall lasts 2 (pi - phi) / omega,
    tan phi = u / (omega gap), and less than that where the spring presses it to the wall.
    """
    k, e, u = 0.12, 0.34, 0.45
    scene = Scene(
        system=LinearSystem(M=1.0, K=k, force=k * gap), contacts=LinearContacts(G=1.0, restitution=e), q0=0.0,
        v0=u, t_span=(start, start + 220.0),
    )  # fmt: skip
    omega, times, t = math.sqrt(k), [], 0.0
    while True:
        t += 2.0 * (math.pi - math.atan2(u, omega * gap)) / omega
        if t > 220.0 or u < 1e-7:
            break
        times.append(t)
        u *= e
    m = simulate(scene, EventDriven())
    struck = m.impacts[m.impacts.kind == Kind.IMPACT]
    if gap > 0.0:
        assert len(struck) == len(times)
    np.testing.assert_allclose(struck.time[:8] - start, times[:8], rtol=0, atol=1e-10)
