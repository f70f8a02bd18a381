"""Event-driven integration: smooth motion up to each event, exactly there the jump, and on from there.

`driven` is the method, and says which kind of run a scene asks for:

    flight      one linear degree of freedom above a flat obstacle, in closed form
    arcs        one contact with friction under a constant force, in closed form
    contacts    any number of contacts and joints, with friction or without, of systems with modes as well
    parabolas   the same without friction under constant forces, in closed form; rows of both: `rows`
    hybrid      modes, guards and resets, without contacts

Each has its `run`, from a scene to a trajectory, and its `loop`, the kernel over events. What they share lies here
(`running`, a run in Python; `scan`, how finely motion is looked at) and in `lcpstep.kernels`.
"""

from lcpstep.events.driven import EventDriven

__all__ = ["EventDriven"]
