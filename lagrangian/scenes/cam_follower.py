"""The cam-follower: a spring-loaded follower on a cam of circular arcs that turns at constant speed.

    m u'' + b u' + k u = -m g_0,   u >= c(t)                              absolute position u, lift c
    m q'' + b q' + k q = -(m c'' + b c' + k c) - m g_0,   q >= 0          relative position q = u - c

Source: G. Osorio, Complex Behavior in Impacting Systems, eqs. 3.35-3.37 and 4.1; parameter values of the
Siconos example of the same authors. Below 114.979 rpm the follower never leaves the cam; at 660 rpm it is
chaotic. What usually goes wrong: chattering, sticking, and release at a corner of the cam.
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np

from lagrangian import checks
from lagrangian.checks import Array
from lagrangian.contacts import LinearContacts
from lagrangian.profiles import Arc, CamProfile, rotating_cam
from lagrangian.scene import Scene
from lagrangian.scenes.catalogue import checked
from lagrangian.scenes.free import Free
from lagrangian.scenes.piecewise import Piecewise
from lagrangian.system import Harmonic, LinearSystem

HALF_TURN = math.pi / 2.0  # cam angle at t = 0: the start of the lift, which is the first corner
PROFILE = CamProfile(
    arcs=(
        Arc(end=math.pi / 2, kappa=0.0, psi=0.0, rho=0.40),  # base circle
        Arc(end=math.pi / 2 + 1.050328174371336, kappa=0.45, psi=-math.pi / 2, rho=0.85),  # flank
        Arc(
            end=math.pi / 2 + 1.22173047639603, kappa=0.40393320723821, psi=math.pi * 8 / 9, rho=0.15
        ),  # nose
        Arc(end=math.pi, kappa=0.0, psi=0.0, rho=0.55393320723821),  # top dwell
    ),
    offset=0.3,
)

NOSE_START, NOSE_END = PROFILE.arcs[1].end, PROFILE.arcs[2].end  # cam angles [rad]


@checked
def cam_follower(
    rpm: float = 358.0,
    q0: float = 0.4,
    v0: float = 0.4,
    t_end: float = 2.0,
    coordinates: str = "relative",
    *,
    m: float = 1.221,
    b: float = 0.0,
    k: float = 1430.8,
    g0: float = 0.0,
    restitution: float = 0.8,
    profile: CamProfile = PROFILE,
) -> Scene:
    """Follower on a cam turning at `rpm`; q0 [m] and v0 [m/s] are relative to the cam at t = 0.

    Parameters
    ----------
    coordinates : "relative" (gap q) or "absolute" (follower position); the motion is the same
    m, b, k, g0 : mass [kg], damping [N s/m], stiffness [N/m], gravity [m/s^2]
    """
    omega = 2.0 * math.pi * checks.positive("rpm", rpm) / 60.0
    p = profile.pack(omega, HALF_TURN)
    period = 60.0 / rpm
    start = np.zeros((1, 3))
    if coordinates == "absolute":
        rotating_cam(0.0, start[0], start[0], p, start)
    elif coordinates != "relative":
        raise ValueError(f'coordinates: expected "relative" or "absolute", got {coordinates!r}')
    relative = coordinates == "relative"

    def lift(t: float) -> tuple[float, float, float]:
        out = np.zeros((1, 3))
        rotating_cam(t, out[0], out[0], p, out)
        return float(out[0, 0]), float(out[0, 1]), float(out[0, 2])

    def exact(times: Array) -> tuple[Array, Array]:
        u, du = motion()(times)
        c = np.array([lift(float(t))[:2] for t in times]).reshape(-1, 2) * relative
        return u - c[:, :1], du - c[:, 1:]

    @cache
    def motion() -> Piecewise:
        c0, dc0, _ = lift(0.0)
        free = Free(delta=0.5 * b / m, kappa=k / m, f0=-g0)
        return Piecewise(free, restitution, (0.0, c0 + q0, dc0 + v0), lift, corners, period)

    corners = np.sort((profile.corners() - HALF_TURN) % (2.0 * math.pi)) / omega
    return Scene(
        system=LinearSystem(
            M=checks.positive("m", m),
            C=checks.number("b", b),
            K=checks.number("k", k),
            force=Harmonic(constant=-m * checks.number("g0", g0)),
            frame=rotating_cam if relative else None,
        ),
        contacts=LinearContacts(
            G=1.0,
            restitution=checks.number("restitution", restitution, least=0.0, most=1.0),
            motion=None if relative else rotating_cam,
        ),
        q0=checks.number("q0", q0) + start[0, 0],
        v0=checks.number("v0", v0) + start[0, 1],
        t_span=(0.0, checks.positive("t_end", t_end)),
        p=p,
        parameters={
            "rpm": rpm,
            "q0": q0,
            "v0": v0,
            "coordinates": coordinates,
            "m": m,
            "b": b,
            "k": k,
            "g0": g0,
            "restitution": restitution,
        },
        corners=corners,
        period=period,
        name="cam-follower",
        # The follower itself is a free oscillator; exact where its damping needs no stiffness to go with it
        exact=exact if k > 0.0 or b == 0.0 else None,
    )


def detachment_rpm(beta: float, m: float = 1.221, k: float = 1430.8, profile: CamProfile = PROFILE) -> float:
    """Speed at which the contact force vanishes at the cam angle beta, c'' = -(k/m) c, without damping and gravity.

    The lift is that just after beta: the first detachment is at the flank-nose corner (`NOSE_START`).

    Raises
    ------
    ValueError   the contact force does not vanish there at any speed
    """
    c, _, ddc = profile.lift(beta + 1e-15)
    if not c * ddc < 0.0:
        raise ValueError(
            f"beta: the contact force does not vanish at any speed where c = {c:g}, c'' = {ddc:g}"
        )
    return 30.0 / math.pi * math.sqrt(-k / m * c / ddc)
