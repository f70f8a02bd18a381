"""Event-driven integration: smooth motion up to each event, exactly there the jump, and on from there."""

from lcpstep.events.driven import EventDriven

__all__ = ["EventDriven"]
