"""Gauss' quadrature over [0, 1], of four nodes and of eight, as kernels take it."""

from __future__ import annotations

import cython

from lcpstep.kernels.gauss import gauss

NODES_4 = [0.06943184420297371, 0.33000947820757187, 0.6699905217924281, 0.9305681557970263]
WEIGHTS_4 = [0.17392742256872692, 0.32607257743127307, 0.32607257743127307, 0.17392742256872692]
if not cython.compiled:
    NODES_8, WEIGHTS_8 = [0.0] * 8, [0.0] * 8
for place, (node, weight) in enumerate(zip(*gauss(8), strict=True)):
    NODES_8[place], WEIGHTS_8[place] = node, weight
