"""The modes of a contact, and what counts as nothing: numbers that kernels and Python know.

With the gap g, its velocity u and the gap acceleration alpha of the free motion:

    free      g > 0, or g = 0 and u > 0, or g = u = 0 and alpha > 0
    impact    g = 0, u < 0                     -> u+ = -r u-
    closed    g = u = 0, alpha <= 0            -> the contact force keeps g = 0 until alpha turns positive

A chattering sequence is carried to its accumulation point once the error of doing so is below the tolerance. Source:
G. Osorio, Complex Behavior in Impacting Systems, eqs. 3.16 and 4.2; A. Nordmark, P. Piiroinen, Simulation and
stability analysis of impacting systems with complete chattering, Nonlinear Dynamics 58 (2009).
"""

from __future__ import annotations

from lcpstep.kernels.roundings import NOISE, RESOLUTION

FREE, CLOSED = 0.0, 1.0  # modes
ROOM = 4  # events that one round of the loop may note
JUST_RELEASED = 1e-300  # a gap acceleration that is zero, on its way up
ON_THE_SURFACE = NOISE  # a gap this small, relative to the state, is closed
UNSEEN = 4 * RESOLUTION  # of the time: a hop this short is none
NONE = -1.0  # in place of a root's time
STRIDE = 3.0  # scan intervals in one stride, where the obstacle is far
