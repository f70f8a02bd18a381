"""Motion of one degree of freedom under a constant and a harmonic force, in closed form.

    y'' + 2 delta y' + kappa y = f0 + C cos(Omega t) + S sin(Omega t)

Source: L. Meirovitch, Fundamentals of Vibrations, chapters 2 and 3.
"""

from __future__ import annotations

import cmath
from dataclasses import dataclass
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Free:
    """The equation without its obstacle; one that has no stiffness has no damping either."""

    delta: float = 0.0
    kappa: float = 0.0
    f0: float = 0.0
    cosine: float = 0.0
    sine: float = 0.0
    omega: float = 0.0

    def steady(self, t: Any, m: Any = cmath) -> tuple[Any, Any]:
        """Forced oscillation and its velocity."""
        if self.cosine == 0.0 and self.sine == 0.0:
            return 0.0, 0.0
        iw = 1j * self.omega
        x = (self.cosine - 1j * self.sine) / (self.kappa + iw * (iw + 2.0 * self.delta)) * m.exp(iw * t)
        return x.real, (iw * x).real

    def at(self, t0: Any, y0: Any, v0: Any, t: Any, m: Any = cmath) -> tuple[Any, Any, Any]:
        """y, y' and y'' at t of the motion that passes y0, v0 at t0: numbers, or arrays where m is numpy."""
        tau = t - t0
        (x0, dx0), (x, dx) = self.steady(t0, m), self.steady(t, m)
        still = self.f0 / self.kappa if self.kappa != 0.0 else 0.0
        z0, dz0 = y0 - x0 - still, v0 - dx0
        if self.kappa == 0.0:
            z, dz = z0 + tau * (dz0 + 0.5 * self.f0 * tau), dz0 + self.f0 * tau
        else:
            mu = cmath.sqrt(self.delta**2 - self.kappa)
            decay, C, S = m.exp(-self.delta * tau).real, m.cosh(mu * tau).real, _sinhc(mu, tau, m)
            z = decay * (z0 * C + (dz0 + self.delta * z0) * S)
            dz = decay * (dz0 * C - (self.kappa * z0 + self.delta * dz0) * S)
        y, v = x + still + z, dx + dz
        cosine, sine = m.cos(self.omega * t).real, m.sin(self.omega * t).real
        force = self.f0 + self.cosine * cosine + self.sine * sine
        return y, v, force - 2.0 * self.delta * v - self.kappa * y


def _sinhc(mu: complex, tau: Any, m: Any) -> Any:
    """sinh(mu tau) / mu, real."""
    x = mu * tau
    if m is np:
        small = np.abs(x) < 1e-5
        return np.where(small, tau * (1.0 + (x * x).real / 6.0), (np.sinh(x) / (mu or 1.0)).real)
    return tau * (1.0 + (x * x).real / 6.0) if abs(x) < 1e-5 else (m.sinh(x) / mu).real
