"""Methods and units in words, for titles and axes."""

from __future__ import annotations

from typing import Any

from lagrangian import HybridScene

DPI = 150
FEW = 6  # parameters that a title has room for
LONG = 90  # characters of a line of it


def method_words(method: Any) -> str:
    """A method as a reader of a figure wants it: Moreau, h = 0.0001 s, theta = 0.5."""
    name = type(method).__name__
    if getattr(method, "tolerance", None) is not None:
        return f"{name}, tolerance {method.tolerance:g}"
    if hasattr(method, "h"):
        more = f", theta = {method.theta:g}" if hasattr(method, "theta") else ""
        more = f", order {method.order}" if hasattr(method, "order") else more
        return f"{name}, h = {method.h:g} s{more}"
    return f"event-driven, tolerance {method.rtol:g}"


def parameter_label(name: str) -> str:
    """The parameter's name with its unit, where it has one."""
    return "cam speed [rpm]" if name == "rpm" else name


def on_section(label: str) -> str:
    """What a named state is called on the section: "position on the section [m]"."""
    words, bracket, unit = label.partition(" [")
    return f"{words} on the section{bracket}{unit}"


def names_of(scene: Any) -> tuple[str, str]:
    """What moves, and what it strikes."""
    return ("follower", "cam") if "rpm" in scene.parameters else ("body", "obstacle")


def scene_words(scene: Any) -> str:
    """The scene, and how fast its cam turns; of a scene with modes the parameters, where they are few."""
    rpm = scene.parameters.get("rpm")
    if isinstance(scene, HybridScene) and len(scene.parameters) <= FEW:
        values = ", ".join(f"{k} = {x:g}" for k, x in scene.parameters.items() if not isinstance(x, str))
        return f"{scene.name} ({values})"
    return str(scene.name) if rpm is None else f"{scene.name} at {rpm:.9g} rpm"


def title_of(scene: Any, what: str, method: Any) -> str:
    """Scene, what is shown, and by which method."""
    words, more = scene_words(scene), f"{what}; {method_words(method)}"
    return f"{words}: {more}" if len(words) + len(more) < LONG else f"{words}\n{more}"
