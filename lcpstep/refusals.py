"""What the methods do not treat, and why: one list, from which the errors are raised and the table is made.

The table of `docs/choosing.md` is written by `python -m lcpstep.refusals docs/choosing.md`.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any, NamedTuple

from lcpstep.errors import LcpStepError

BEGIN, END = "<!-- refusals -->", "<!-- end of refusals -->"


class Refusal(NamedTuple):
    """A method, what it does not treat, the reason in mechanics, and what does."""

    argument: str
    method: str
    feature: str
    reason: str
    instead: str


REFUSALS: dict[str, Refusal] = {
    "exact-joints": Refusal(
        "scene", "Located with order='exact'", "joints",
        "forces of joints follow the motion, which is no polynomial between events then", "order=4",
    ),
    "exact-friction": Refusal(
        "scene", "Located with order='exact'", "friction",
        "what holds a contact that sticks depends on the motion, which is no polynomial between events then",
        "order=4",
    ),
    "exact-forces": Refusal(
        "scene", "Located with order='exact'", "all but a LinearSystem whose force is constant or Harmonic",
        "no Taylor polynomial of the motion is known to rounding", "order=4",
    ),
    "exact-curved": Refusal(
        "scene", "Located with order='exact'", "other contacts than LinearContacts",
        "a curved gap is no polynomial of time along the motion", "order=4",
    ),
    "exact-moving": Refusal(
        "scene", "Located with order='exact'", "more than one coordinate where the frame or an obstacle moves",
        "the forces of a frame are no harmonic ones, and gaps no polynomials", "order=4",
    ),
    "exact-tolerance": Refusal(
        "tolerance", "Located with order='exact'", "a tolerance",
        "it makes no error that steps could control", "None",
    ),
    "solver-beyond-contacts": Refusal(
        "lcp", "Moreau with another solver than 'lemke'", "joints, friction and projected=True",
        "their problem has no symmetric matrix, and is solved within the loop", "lcp='lemke'",
    ),
    "solver-tolerance": Refusal(
        "tolerance", "Moreau with another solver than 'lemke'", "a tolerance",
        "an attempt is three steps that the loop solves itself", "lcp='lemke'",
    ),
    "dense": Refusal(
        "matrix", "a method by dense matrices (all but the sparse steps of Moreau)",
        "sparse matrices of more than 2000 rows or columns",
        "a dense one of that size takes gigabytes, and what is made of it the cube of its rows", "Moreau",
    ),
    "sparse-tolerance": Refusal(
        "tolerance", "Moreau with more than 2000 sparse coordinates", "a tolerance",
        "every other step size has matrices of its own to factorise", "steps of one size",
    ),
    "sparse-solver": Refusal(
        "lcp", "Moreau with more than 2000 sparse coordinates", "another solver",
        "its contact problem is never formed: a saddle point problem is solved in its place", "lcp='lemke'",
    ),
    "sparse-projected": Refusal(
        "projected", "Moreau with more than 2000 sparse coordinates", "projected=True",
        "what moves positions back acts through the mobility of all rows, which is never formed",
        "projected=False and a smaller h",
    ),
    "sparse-stronge": Refusal(
        "friction", "Moreau with more than 2000 sparse coordinates", "Stronge's law",
        "contacts strike in turn, each through the mobility of all, which is never formed",
        "law='moreau' or 'newton'",
    ),
    "sparse-tangents": Refusal(
        "friction", "Moreau with more than 2000 sparse coordinates", "tangents that are callbacks",
        "a callback fills out a dense matrix", "a constant sparse tangent",
    ),
    "sparse-joints": Refusal(
        "joints", "Moreau with more than 2000 sparse coordinates", "curved joints without `pattern`",
        "where their Jacobian has entries is not known, and it would be a dense matrix", "Joints(pattern=...)",
    ),
    "modes-method": Refusal(
        "method", "time-stepping (Moreau, Located)", "systems with modes",
        "a switch has to be located where its guard is zero, and a step that goes past it follows the wrong field",
        "EventDriven",
    ),
    "modes-audit": Refusal(
        "audit", "EventDriven with audit=True", "systems with modes",
        "bounds of guards along the motion are not known, as they are of gaps", "audit=False",
    ),
    "modes-error": Refusal(
        "error", "simulate with error=True", "systems with modes",
        "an error bar is the distance from another method, and one alone runs systems with modes",
        "two tolerances",
    ),
    "modes-surfaces": Refusal(
        "surfaces", "EventDriven of systems with modes and contacts", "surfaces with sliding",
        "the contact force differs on both sides of a surface, and depends on where between them the motion slides",
        "guards",
    ),
    "modes-maps": Refusal(
        "scene", "stroboscopic maps and derivatives (attractors, orbits, exponents, basins)",
        "systems with modes that have contacts",
        "velocities jump and contacts rest between switches, which the flow of the modes' fields alone does not",
        "simulate",
    ),
    "together": Refusal(
        "run", "the derivative of a motion (multipliers, exponents)", "contacts that strike together",
        "neighbours meet them one after the other, in either order: there is no derivative", "an orbit near it",
    ),
    "endless-together": Refusal(
        "run", "the derivative of a motion (multipliers, exponents)", "endless impacts of several contacts in turn",
        "each acts on the next, and what the infinite product of their derivatives comes to is not known",
        "an orbit near it",
    ),
}  # fmt: skip


def refused(key: str, scene: Any = None, argument: str = "") -> LcpStepError:
    """The error of a refusal, to be raised; `scene` has the feature, `argument` is it where the list has another."""
    r = REFUSALS[key]
    having = "" if scene is None else f", as {scene.name!r} has"
    return LcpStepError(
        f"{argument or r.argument}: {r.method} does not treat {r.feature}{having}: {r.reason}; take {r.instead}"
    )


def table() -> str:
    """All refusals as a table in Markdown."""
    lines = ["| method | does not treat | for | take |", "|---|---|---|---|"]
    lines += [f"| {r.method} | {r.feature} | {r.reason} | {r.instead} |" for r in REFUSALS.values()]
    return "\n".join(lines)


def with_table(page: str) -> str:
    """A page whose table between the two marks is the present one."""
    return re.sub(f"{BEGIN}\n.*?{END}", lambda _: f"{BEGIN}\n{table()}\n{END}", page, flags=re.DOTALL)


if __name__ == "__main__":
    file = Path(sys.argv[1])
    file.write_text(with_table(file.read_text()))
