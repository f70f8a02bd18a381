"""What an audit has found: how much of a run is free of unnoticed events, and where that could not be shown."""

from __future__ import annotations

from dataclasses import dataclass

SHOWN = 8  # windows in a report


@dataclass(frozen=True)
class Window:
    """A stretch of time in which no certificate was found.

    Attributes
    ----------
    start, end : [s];  contact : its number
    gap : the smallest gap that could be shown [m]; of what was sampled, the smallest that was seen; -inf where
        nothing could be shown
    why : in words
    sampled : whether it was looked at in samples
    """

    start: float
    end: float
    contact: int
    gap: float
    why: str
    sampled: bool = False

    def __str__(self) -> str:
        seen = "seen" if self.sampled else "shown"
        where = f"{self.start:.9g} .. {self.end:.9g} s, contact {self.contact}"
        return f"{where}: smallest gap {seen} {self.gap:.3g} m; {self.why}"


@dataclass(frozen=True)
class Found:
    """An event that the run had not noticed: a gap below zero, or a force that draws, at this time."""

    time: float
    contact: int
    start: float  # of the window; before it nothing was missed


@dataclass(frozen=True)
class Audit:
    """What is known of a run, contact by contact.

    Attributes
    ----------
    share : of the span, over all contacts, that is certified to hold no unnoticed event
    flights, certified : how many flights there were between events, and how many of them are certified as a whole
    windows : those that are not certified, in the order of time
    taken : events that the run had not noticed, and then took
    missed : events that are still not part of the run
    """

    share: float
    flights: int
    certified: int
    windows: tuple[Window, ...]
    taken: tuple[Found, ...] = ()
    missed: tuple[Found, ...] = ()

    def __str__(self) -> str:
        lines = [
            f"certified free of unnoticed events: {100.0 * self.share:.6g} % of the span, {self.certified} of "
            f"{self.flights} flights"
        ]
        lines += [f"taken, unnoticed before: contact {x.contact} at {x.time:.9g} s" for x in self.taken]
        lines += [f"MISSED: contact {x.contact} at {x.time:.9g} s" for x in self.missed]
        lines += [f"not certified: {x}" for x in self.windows[:SHOWN]]
        if len(self.windows) > SHOWN:
            lines.append(f"and {len(self.windows) - SHOWN} more windows")
        return "\n".join(lines)
