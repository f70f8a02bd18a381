"""The joints of a scene in the steps of `Located`: their state, and what they do to a motion."""

from __future__ import annotations


class Joints:
    """Joints at the state last looked at, and work space."""

    def __init__(self, n_j: int) -> None:
        self.n_j = n_j
