"""What sets the accuracy of a method: its step h, or its tolerance; read, changed, and left out of its name."""

from __future__ import annotations

from dataclasses import MISSING, fields, is_dataclass, replace
from typing import Any

DIALS = (
    ("tolerance",),
    ("tol",),
    ("rtol", "atol"),
    ("h",),
)  # a method with a tolerance chooses its steps itself


def dial(method: Any) -> tuple[str, float]:
    """Name and value of the accuracy parameter; ("", nan) for a method that has none."""
    for names in DIALS:
        value = getattr(method, names[0], None)
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            return names[0], float(value)
    return "", float("nan")


def with_value(method: Any, value: float) -> Any:
    """The same method at another step or tolerance; ValueError where the method refuses it."""
    name, _ = dial(method)
    names = next((names for names in DIALS if names[0] == name), ())
    return replace(method, **{n: value for n in names if hasattr(method, n)})


def changeable(method: Any) -> bool:
    """Whether `with_value` works."""
    return is_dataclass(method) and not isinstance(method, type) and dial(method)[0] != ""


def label(method: Any) -> str:
    """Name of the method without its dial: its type and what differs from the defaults."""
    name = type(method).__name__
    if not is_dataclass(method):
        return name
    turned = next((names for names in DIALS if names[0] == dial(method)[0]), ())
    own = [f for f in fields(method) if f.init and f.name not in turned]
    shown = [
        f"{f.name}={getattr(method, f.name)!r}"
        for f in own
        if f.default is MISSING or getattr(method, f.name) != f.default
    ]
    return f"{name}({', '.join(shown)})" if shown else name


def shown(method: Any) -> str:
    """Name of the method with its dial, for people."""
    name, value = dial(method)
    return f"{label(method)}, {name} = {value:.3g}" if name else label(method)
