"""Event-driven integration: smooth motion up to each event, exactly there the jump, and on from there.

`driven` is the method, and says which kind of run a scene asks for:

    flight      one linear degree of freedom above a flat obstacle, in closed form
    single      general systems with one contact or none
    several     several contacts, and joints
    hybrid      modes, guards and resets

Each has its `run`, from a scene to a trajectory, and its `loop`, the kernel over events. What they share lies here:
`run`, `clock`, `contact`, `bookkeeping`, `plan`, `acceleration`, and the steps of `dop853`.
"""

from lcpstep.events.driven import EventDriven

__all__ = ["EventDriven"]
