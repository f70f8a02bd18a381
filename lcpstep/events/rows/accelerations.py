"""Accelerations with the joints alone, or with all that the modes hold, as kernels.

    M a = M a_free + R_h^T lambda,      R_h a + bias_h = 0      h: the rows held

Source: F. Pfeiffer, C. Glocker, Multibody Dynamics with Unilateral Contacts (Wiley 1996), chapter 5.
"""

from __future__ import annotations

import cython

from lcpstep.events.rows.contacts import Contacts, list_multipliers
from lcpstep.events.rows.held import constrain, hold_joints
from lcpstep.kernels.vectors import copy


def accelerate(s: Contacts) -> None:
    """The acceleration with the rows held, into `a`; everything must be measured."""
    copy(s.a, s.a_free, s.n_q)
    constrain(s, s.a, s.bias)


def accelerate_on_joints(s: Contacts) -> None:
    """The same with the joints alone held."""
    hold_joints(s)
    accelerate(s)


def accelerate_as_held(s: Contacts) -> None:
    """The acceleration with the rows held, and their forces by row, into `multiplier`."""
    accelerate(s)
    list_multipliers(s)
