"""A scene as kernels see it: numbers, arrays and the user's functions; `lcpstep.model` makes it.

linear      M v' + C v + K q = F(t), F = constant + cosine cos(omega t) + sine sin(omega t) or force(t)
otherwise   M(t, q) v' = force(t, q, v), with modes M a of the field (v, a) of the mode at hand
flat        g = G q + offset - s(t)
otherwise   g = gap(t, q),  u = jacobian(t, q) v + gap_t(t, q)
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles, indices
from lcpstep.kernels.function import Function
from lcpstep.pointers import after

ABSENT = Function(0, np.zeros(0), 0, 0, (0,))


class Model:
    """Everything a kernel needs to evaluate a scene's equations; see `lagrangian` for the symbols.

    M, M_inverse, C, K : (n_q, n_q);  constant, cosine, sine : (n_q,);  omega
    G : (n_c, n_q);  offset, restitution : (n_c,)
    M_ends, C_ends, G_ends : (n, 2)   of M_inverse, of C and K, of G: where the entries of a row begin and end
    force, frame, mass, force_q, force_v, motion, gap, jacobian, gap_t, bias : Function, `given` or not
    modes, mode      fields of the modes as `Functions` of x = (q, v), and the one at hand; `moded` or not
    x, x_t : (2 n_q,)   work space: x, its field;  mass_now : (n_q, n_q)   M, beside these
    carried     kernels see q + c, in which the frame rests and obstacles move with it instead
    frame_now : (n_q, 3)    work space: c, c', c''
    motion_now : (n_c, 3)   work space: s, s', s''
    arrays      the arrays by name, for Python
    kept        Python functions that are called back, with what must outlive this object

    Parameters
    ----------
    fields : dict   these by name, arrays contiguous, functions as addresses of C functions (0: none), and `p`;
        `called_back`: what must outlive this object; see `lcpstep.model`
    """

    def __init__(self, fields: dict[str, Any]) -> None:
        own = {name: x for name, x in fields.items() if type(x) is np.ndarray}
        n_c, n_q = own["G"].shape
        self.arrays, self.kept, self.n_q, self.n_c = own, fields["called_back"], n_q, n_c
        self.linear, self.flat, self.carried = fields["linear"], fields["flat"], fields["carried"]
        self.omega = fields["omega"]
        self.M, self.M_inverse = doubles(own["M"]), doubles(own["M_inverse"])
        self.C, self.K = doubles(own["C"]), doubles(own["K"])
        self.constant = doubles(own["constant"])
        self.cosine, self.sine = doubles(own["cosine"]), doubles(own["sine"])
        self.G, self.offset = doubles(own["G"]), doubles(own["offset"])
        self.restitution = doubles(own["restitution"])
        self.M_ends, self.C_ends = indices(own["M_ends"]), indices(own["C_ends"])
        self.G_ends = indices(own["G_ends"])
        self.frame_now, self.motion_now = doubles(own["frame_now"]), doubles(own["motion_now"])
        made = {
            name: Function(fields[name], own["p"], n_q, n_q, shape) if fields[name] else ABSENT
            for name, shape in shapes(n_q, n_c).items()
        }
        self.force, self.frame, self.mass = made["force"], made["frame"], made["mass"]
        self.force_q, self.force_v = made["force_q"], made["force_v"]
        self.motion, self.gap, self.jacobian = made["motion"], made["gap"], made["jacobian"]
        self.gap_t, self.bias = made["gap_t"], made["bias"]
        self.mode, self.moded = 0, "modes" in fields
        if self.moded:
            self.modes = fields["modes"]
            self.of_modes = np.zeros(4 * n_q + n_q * n_q)
            self.x = doubles(self.of_modes)
            self.x_t, self.mass_now = after(self.x, 2 * n_q), after(self.x, 4 * n_q)


def shapes(n_q: int, n_c: int) -> dict[str, tuple[int, ...]]:
    """Shapes of what the functions of a scene fill in."""
    square = n_q, n_q
    return {
        "force": (n_q,), "frame": (n_q, 3), "mass": square, "force_q": square, "force_v": square,
        "motion": (n_c, 3), "gap": (n_c,), "jacobian": (n_c, n_q), "gap_t": (n_c,), "bias": (n_c,),
    }  # fmt: skip
