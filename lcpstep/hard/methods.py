"""The methods that the hard cases are put to, at their default settings but for the step."""

from __future__ import annotations

from collections.abc import Callable

from lcpstep.events import EventDriven
from lcpstep.simulation import Method
from lcpstep.stepping.located import Located
from lcpstep.stepping.moreau import Moreau

# A method for the step h [s], which event-driven integration does not have
METHODS: dict[str, Callable[[float], Method]] = {
    "event-driven": lambda h: EventDriven(),
    "located": lambda h: Located(h=h),
    "moreau": lambda h: Moreau(h=h),
}
EVENT, LOCATED, MOREAU = "event-driven", "located", "moreau"
