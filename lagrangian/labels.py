"""What names of coordinates with units, as "angle [rad]", tell: the names of their rates, and the unit they share."""

from __future__ import annotations


def rate_label(label: str) -> str:
    """What the rate of a named coordinate is called: "angle [rad]" becomes "rate of angle [rad/s]"."""
    name, bracket, unit = label.partition(" [")
    return f"rate of {name}{bracket}{unit[:-1]}/s]" if bracket else f"rate of {name}"


def common_unit(labels: tuple[str, ...]) -> str:
    """The unit of named coordinates, "m" of "position [m]", where they have one in common; "" where not."""
    units = {label.partition("[")[2].rstrip("]") for label in labels}
    return units.pop() if len(units) == 1 else ""


def units(labels: tuple[str, ...]) -> tuple[str, str]:
    """Units of the coordinates and of the velocities among a scene's labels; "own units" where they share none."""
    n = len(labels) // 2
    return common_unit(labels[:n]) or "own units", common_unit(labels[n:]) or "own units"


def length_unit(labels: tuple[str, ...]) -> str:
    """The unit of length among those of named coordinates, "mm" of "x [mm]"; metres where they name none, or several.

    Angles leave the unit of lengths open.
    """
    found = {label.partition("[")[2].rstrip("]") for label in labels} - {"", "rad", "deg", "°"}
    return found.pop() if len(found) == 1 else "m"
