"""The refusal of a proof."""

from __future__ import annotations

from lcpstep.errors import LcpStepError


class NotProved(LcpStepError):
    """A scene or an orbit that no proof is given of; the message says why."""
