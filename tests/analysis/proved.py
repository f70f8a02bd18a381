"""What the tests of proofs share: digits of enclosures, scenes, and orbits put together by hand."""

import math
import re
from dataclasses import replace

import mpmath
import numpy as np

from lagrangian import Harmonic, LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, simulate
from lcpstep.analysis.orbits import PeriodicOrbit, periodic_orbit
from lcpstep.maps import StroboscopicMap, iterate


def ball(enclosure):
    """Midpoint and radius of what is printed."""
    found = re.fullmatch(r"\[?([-+\d.e]+)(?: \+/- ([\d.e+-]+)\])?", str(enclosure))
    return mpmath.mpf(found[1]), mpmath.mpf(found[2] or 0)


def holds(enclosure, truth, radius=1e-25):
    """Whether an enclosure is narrow and has the true number in it."""
    middle, width = ball(enclosure)
    inside = abs(middle - truth) <= width + abs(middle) * mpmath.mpf(10) ** -28  # the last printed digit
    return bool(inside) and width < radius and enclosure.lower <= truth <= enclosure.upper


def settled(scene, n=1, transient=200):
    """The orbit that a motion of a scene with several contacts has settled to, as its event-driven run has it."""
    T = scene.period
    start, end = transient * T, (transient + n) * T
    run = simulate(replace(scene, t_span=(0.0, end)), EventDriven())
    log = run.impacts[(run.impacts.time >= start) & (run.impacts.time < end)]
    x = np.concatenate(run.at(start))
    return PeriodicOrbit(
        scene, EventDriven(), 0.0, np.tile(x, (n, 1)), log.time - start, log.before, log.after,
        False, np.zeros(len(x), dtype=complex), 0.0,
    )  # fmt: skip


def attracting(scene, n=1, phase=0.0):
    """The orbit that the scene's motion settles to."""
    x = iterate(StroboscopicMap(scene, EventDriven(), phase), scene.x0, 300)[-1]
    return periodic_orbit(scene, x, n, phase=phase)


def two_walls(restitution=0.7):
    return Scene(
        LinearSystem(M=1.0, C=0.1, K=1.0, force=Harmonic(cosine=2.0, omega=1.2)), q0=0.0, v0=0.0, t_span=(0.0, 1.0),
        contacts=LinearContacts([[1.0], [-1.0]], offset=[0.5, 0.5], restitution=restitution),
        period=2.0 * math.pi / 1.2, name="two walls",
    )  # fmt: skip


def two_masses(**more):
    return Scene(
        LinearSystem(
            M=np.diag([1.0, 0.5]), C=[[0.2, -0.1], [-0.1, 0.1]], K=[[2.0, -1.0], [-1.0, 1.0]],
            force=Harmonic(cosine=[1.5, 0.0], omega=1.3), **more,
        ),
        q0=[0.0, 0.0], v0=[0.0, 0.0], t_span=(0.0, 1.0), period=2.0 * math.pi / 1.3, name="two masses",
        contacts=LinearContacts([[0.0, 1.0]], offset=[0.3], restitution=0.6),
    )  # fmt: skip


def sine(t, q, v, p, out):
    x = p[1] * t + p[2]
    out[0, 0] = p[0] * math.sin(x)
    out[0, 1] = p[0] * p[1] * math.cos(x)
    out[0, 2] = -p[0] * p[1] * p[1] * math.sin(x)


def on_table(motion, p=(0.01, 35.0, 0.0), r=0.5):
    return Scene(
        LinearSystem(M=1.0, force=-9.81), q0=0.5, v0=0.0, t_span=(0.0, 1.0), p=p, period=2.0 * math.pi / p[1],
        contacts=LinearContacts(1.0, restitution=r, motion=motion), name="on a table",
    )  # fmt: skip


def on_table_orbit(motion, p=(0.01, 35.0, 0.0), r=0.5):
    """The orbit of one impact a turn on a table near p[0] sin(p[1] t), seen half a turn after t = 0."""
    A, w, g = p[0], p[1], 9.81
    hit = math.acos(math.pi * g * (1.0 - r) / (A * w**2 * (1.0 + r))) / w
    v = 2.0 * math.pi * g * r / (w * (1.0 + r)) + A * w * math.cos(w * hit)
    later = math.pi / w - hit
    x = [A * math.sin(w * hit) + v * later - 0.5 * g * later**2, v - g * later]
    return periodic_orbit(on_table(motion, p, r), x, phase=0.5)
