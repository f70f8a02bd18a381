"""Motion of one degree of freedom under a constant and a harmonic force, in closed form.

    y'' + 2 delta y' + kappa y = f0 + C cos(Omega t) + S sin(Omega t)

Source: L. Meirovitch, Fundamentals of Vibrations, chapters 2 and 3.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Free:
    """The equation without its obstacle; one that has no stiffness has no damping either."""

    delta: float = 0.0
    kappa: float = 0.0
    f0: float = 0.0
    cosine: float = 0.0
    sine: float = 0.0
    omega: float = 0.0

    def steady(self, t: float) -> tuple[float, float]:
        """Forced oscillation and its velocity."""
        if self.cosine == 0.0 and self.sine == 0.0:
            return 0.0, 0.0
        iw = 1j * self.omega
        x = (self.cosine - 1j * self.sine) / (self.kappa + iw * (iw + 2.0 * self.delta)) * cmath.exp(iw * t)
        return x.real, (iw * x).real

    def at(self, t0: float, y0: float, v0: float, t: float) -> tuple[float, float, float]:
        """y, y' and y'' at t of the motion that passes y0, v0 at t0."""
        tau = t - t0
        (x0, dx0), (x, dx) = self.steady(t0), self.steady(t)
        still = self.f0 / self.kappa if self.kappa != 0.0 else 0.0
        z0, dz0 = y0 - x0 - still, v0 - dx0
        if self.kappa == 0.0:
            z, dz = z0 + tau * (dz0 + 0.5 * self.f0 * tau), dz0 + self.f0 * tau
        else:
            mu = cmath.sqrt(self.delta**2 - self.kappa)
            decay, S = math.exp(-self.delta * tau), _sinhc(mu, tau)
            z = decay * (z0 * cmath.cosh(mu * tau).real + (dz0 + self.delta * z0) * S)
            dz = decay * (dz0 * cmath.cosh(mu * tau).real - (self.kappa * z0 + self.delta * dz0) * S)
        y, v = x + still + z, dx + dz
        force = self.f0 + self.cosine * math.cos(self.omega * t) + self.sine * math.sin(self.omega * t)
        return y, v, force - 2.0 * self.delta * v - self.kappa * y


def _sinhc(mu: complex, tau: float) -> float:
    """sinh(mu tau) / mu, real."""
    x = mu * tau
    return tau * (1.0 + (x * x).real / 6.0) if abs(x) < 1e-5 else (cmath.sinh(x) / mu).real
