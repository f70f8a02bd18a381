"""What names of coordinates with units, as "angle [rad]", tell: the names of their rates, and the unit they share."""

from __future__ import annotations

from collections.abc import Sequence

LENGTHS = {"m", "km", "dm", "cm", "mm", "µm", "um", "nm", "in", "ft"}
OF_FORCES = ("N s", "J")


def rate_label(label: str) -> str:
    """What the rate of a named coordinate is called: "angle [rad]" becomes "rate of angle [rad/s]"."""
    name, bracket, unit = label.partition(" [")
    return f"rate of {name}{bracket}{unit[:-1]}/s]" if bracket else f"rate of {name}"


def common_unit(labels: Sequence[str]) -> str:
    """The unit of named coordinates, "m" of "position [m]", where they have one in common; "" where not."""
    units = {label.partition("[")[2].rstrip("]") for label in labels}
    return units.pop() if len(units) == 1 else ""


def units(labels: Sequence[str]) -> tuple[str, str, str]:
    """Units of coordinates, velocities and energies by a scene's labels; "own units" where there is no common one."""
    n = len(labels) // 2
    q, v, energy = common_unit(labels[:n]), common_unit(labels[n:]), own_unit("J", labels)
    return q or "own units", v or "own units", energy or "own units"


def own_unit(unit: str, labels: Sequence[str]) -> str:
    """What "m", "m/s", "N s" or "J" are called among a scene's labels: "mm/s" where its coordinates are in mm.

    Lengths are in metres where the coordinates name no unit of length, or several. Where they are in another one that
    of forces is not known: "".
    """
    found = {label.partition("[")[2].rstrip("]") for label in labels[: len(labels) // 2]} & LENGTHS
    if len(found) != 1 or found == {"m"}:
        return unit
    return found.pop() + unit[1:] if unit[0] == "m" else "" if unit in OF_FORCES else unit
