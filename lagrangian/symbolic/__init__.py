"""Mechanisms from their Lagrangian: L(t, q, v), dissipation and gaps as sympy expressions, derived and compiled.

Lagrange's equations of the second kind with Rayleigh's dissipation function D and generalised forces Q,

    d/dt (dL/dv) - dL/dq + dD/dv = Q + G^T lambda,      L = v^T M v / 2 + b^T v + L_0,

written as M v' + N = F + G^T lambda, that is M v' = f + G^T lambda with f = F - N; indices are derivatives:

    N = (M v + b)_q v + M_t v - (v^T M v / 2 + b^T v)_q,      F = (L_0)_q - b_t - D_v + Q
    G = g_q,      g_t = partial g / partial t,      bias = v^T g_qq v + 2 g_qt v + g_tt

Source: E. T. Whittaker, A Treatise on the Analytical Dynamics of Particles and Rigid Bodies (4th ed., Cambridge
1937), chapters II, III (integral of energy) and VIII (dissipation function).

Needs sympy: pip install "lcpstep[symbolic]".
"""

from __future__ import annotations

try:
    import sympy  # noqa: F401
except ImportError as error:
    raise ImportError('lagrangian.symbolic needs sympy: pip install "lcpstep[symbolic]"') from error

from lagrangian.symbolic.deriving import derive
from lagrangian.symbolic.expressions import Equations
from lagrangian.symbolic.mechanism import Mechanism
from lagrangian.symbolic.reading import from_sympy

__all__ = ["Equations", "Mechanism", "derive", "from_sympy"]
