"""What a study is asked: its curves, the levels of each, and what a file holds of it already."""

from __future__ import annotations

import logging
import math
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from lagrangian import Scene
from lcpstep.accuracy.dials import changeable, dial, label, with_value
from lcpstep.accuracy.work_precision import Level, Study
from lcpstep.described import checksum, checksum_of
from lcpstep.errors import DamagedFile
from lcpstep.saving import digest
from lcpstep.simulation import Method

LOG = logging.getLogger(__name__)
# Default: steps in the span, how many times more in each further level, levels
COARSEST, FINER, LEVELS = 250, 4, 5
TOLERANCES = (1e-4, 1e-6, 1e-8, 1e-10)  # the same for methods with a tolerance


def curves_of(methods: Any) -> dict[str, list[Method]]:
    """Methods by curve, each coarse to fine."""
    if isinstance(methods, Mapping):
        for name, of_it in methods.items():
            if not isinstance(of_it, Iterable):
                raise TypeError(f"methods: {name}: expected methods in a list, got {of_it!r}")
        named = {str(name): list(of_it) for name, of_it in methods.items()}
    else:
        named = {}
        for method in methods if isinstance(methods, Iterable) else [methods]:
            named.setdefault(label(method), []).append(method)
    for method in (m for of_it in named.values() for m in of_it):
        if isinstance(method, type) or not hasattr(method, "run"):
            raise TypeError(f"methods: expected for example [lcpstep.Moreau()], got {method!r}")
    if not any(named.values()):
        raise ValueError("methods: expected at least one method")
    return named


def levels_of(
    curves: dict[str, list[Method]], scene: Scene, h: Any, tolerances: Any, notes: list[str]
) -> dict[str, list[Method]]:
    """The levels of every curve, coarse to fine; what cannot be used is noted and left out."""
    steps = np.ptp(scene.t_span) / (COARSEST * FINER ** np.arange(LEVELS))
    wanted = {True: (h, steps, "h"), False: (tolerances, TOLERANCES, "tolerances")}
    result = {}
    for name, methods in curves.items():
        which, _ = dial(methods[0])
        values, default, argument = wanted[which == "h"]
        if not changeable(methods[0]):
            result[name] = methods
            continue
        if values is None and len(methods) > 1:
            values, make = [dial(m)[1] for m in methods], methods
        else:
            values = list(default if values is None else values)
            if not values:
                raise ValueError(f"{argument}: expected at least one number, got none")
            make = [methods[0]] * len(values)
        levels: dict[float, Method] = {}
        for value, method in zip(values, make, strict=True):
            try:
                number = float(value)
                if not (math.isfinite(number) and number > 0.0):
                    raise ValueError(f"expected positive numbers, got {value!r}")
                if number in levels:
                    raise ValueError(f"{value!r} is there twice")
                levels[number] = with_value(method, number)
            except (TypeError, ValueError) as error:
                notes.append(f"{argument}: {error}; left out for {name}")
        result[name] = [levels[v] for v in sorted(levels, reverse=True)]
    if not any(result.values()):
        raise ValueError("; ".join(notes) + ", and nothing is left")
    return result


def question_of(
    scene: Scene, measures: Sequence[str], spread: Sequence[float], reference: Any, horizon: float | None
) -> dict[str, Any]:
    """What tells one study from another, as a file keeps it."""
    initial = [np.asarray(x).tolist() for x in (scene.q0, scene.v0, scene.p)]
    return {
        "scene": scene.name, "parameters": dict(scene.parameters), "t_span": list(scene.t_span),
        "q0": initial[0], "v0": initial[1], "p": initial[2], "scene_sha256": checksum(scene),
        "measures": list(measures), "spread": list(spread), "horizon": None if horizon is None else str(horizon),
        "reference": _told(scene.exact if reference is None else reference),
    }  # fmt: skip


def _told(reference: Any) -> str | None:
    """A reference in words that are the same in every process, and of no other."""
    if reference is None:
        return None
    if hasattr(reference, "at") and hasattr(reference, "t"):
        t = np.asarray(reference.t)
        q, v = reference.at(t)
        return f"a motion by {getattr(reference, 'method', None)!r}, {digest({'t': t, 'q': q, 'v': v})}"
    if callable(reference):
        return f"a function, {checksum_of(reference)}"
    return repr(reference)


def earlier(save: str | Path | None, question: dict[str, Any]) -> dict[tuple[str, str], Level]:
    """Levels that are in the file already."""
    if save is None or not Path(save).exists():
        return {}
    if Path(save).suffix != ".json":
        raise FileExistsError(f"save: {save} exists already")
    try:
        earlier = Study.load(save)
    except DamagedFile as error:
        aside = Path(save).with_name(Path(save).name + ".damaged")
        Path(save).replace(aside)
        LOG.warning("%s; it is now %s, and the study starts anew", error, aside.name)
        return {}
    if earlier.question != question:
        raise FileExistsError(f"save: {save} exists already and holds another study")
    return {(x.method, x.settings): x for x in earlier.levels}
