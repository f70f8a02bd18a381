"""Arguments that several commands share: the scene, its parameters, the methods; and a progress bar."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable, Generator, Iterable, Mapping
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

from lagrangian import HybridScene, Scene
from lagrangian.scenes import SCENES
from lcpstep import EventDriven, Located, Moreau
from lcpstep.cli import interrupt, own
from lcpstep.cli.interrupt import INTERRUPTED as INTERRUPTED
from lcpstep.errors import LcpStepError, UnknownName
from lcpstep.files import replacing

DONE, FAILED, USAGE = 0, 1, 2  # exit status; INTERRUPTED is another
DPI = 150  # of pictures
REFRESH = 0.1  # of a bar [s]
# Steps where --h is not given, at least: in the span, in a period of the forcing
PER_SPAN, PER_PERIOD = 20_000, 500


def scene_arguments(p: argparse.ArgumentParser) -> None:
    """Which scene, how long, and its parameters."""
    p.add_argument(
        "scene",
        metavar="SCENE",
        help="a ready scene (see: lcpstep scenes), or a file with a function scene(), my_scene.py (see: lcpstep new)",
    )
    p.add_argument("--t-end", type=float, help="length of the simulation [s]; default: the scene's own")
    p.add_argument(
        "--set",
        nargs="+",
        action="extend",
        default=[],
        metavar="NAME=VALUE",
        help="parameters of the scene, see: lcpstep scenes",
    )


def stepping_arguments(p: argparse.ArgumentParser) -> None:
    """Step, theta and complementarity solver."""
    p.add_argument(
        "--h",
        type=float,
        help=f"step of the time-stepping [s]; default: 1/{PER_SPAN} of the span, or 1/{PER_PERIOD} of the period of "
        "the forcing where that is shorter",
    )
    p.add_argument("--theta", type=float, default=0.5, help="0 explicit, 0.5 trapezoidal, 1 implicit (0.5)")
    p.add_argument("--lcp", default="lemke", help="complementarity solver: lemke, qp, qp:daqp, ... (lemke)")


def scene_with_contacts(options: argparse.Namespace, **more: Any) -> Scene:
    """The scene that the options name, for tools that compare methods; one with modes has one method only."""
    scene = scene_of(options, **more)
    if isinstance(scene, HybridScene):
        raise LcpStepError(
            f"scene: {scene.name!r} has modes and no contacts, and is run by the event-driven method alone; "
            f"see lcpstep simulate, attractor, bifurcation, basin, orbit"
        )
    return scene


def scene_of(options: argparse.Namespace, **more: Any) -> Any:
    """The scene that the options name, a `Scene` or a `HybridScene`; `more` sets further parameters of it."""
    known = parameters_of(options.scene)
    for name in more:
        if name not in known:
            raise UnknownName(f"parameter of {options.scene}", name, known)
    given = settings(options, known, options.scene)
    for name in (*more, *(["t_end"] if options.t_end is not None else [])):
        if name in given:
            raise ValueError(f"--set: {name} is set by the command itself here, or by another option")
    values = more | {name: read(name, value, known[name]) for name, value in given.items()}
    return made_scene(options.scene, values, options.t_end)


def settings(options: argparse.Namespace, known: Mapping[str, Any], of: str) -> dict[str, str]:
    """Values that --set gives as texts, each of a known parameter, and once."""
    values: dict[str, str] = {}
    for setting in options.set:
        name, equals, value = setting.partition("=")
        if not equals:
            raise ValueError(f"--set: expected NAME=VALUE, got {setting!r}")
        if name not in known:
            raise UnknownName(f"parameter of {of}", name, known)
        if name in values:
            raise ValueError(f"--set: {name} is set twice, to {values[name]} and {value}")
        values[name] = value
    return values


def parameters_of(scene: str) -> dict[str, Any]:
    """Parameters of a scene, ready or in a file, with their defaults; UnknownName where there is no such scene."""
    if own.is_file(scene):
        return own.known_parameters(own.maker(scene))
    if scene not in SCENES:
        raise UnknownName("scene", scene, SCENES)
    return SCENES[scene].parameters


def vary(options: argparse.Namespace) -> None:
    """Know the parameter that varies: a name that the scene knows, or its speed of rotation where none is given."""
    known = parameters_of(options.scene)
    if options.parameter is None:
        if "rpm" not in known:
            names = ", ".join(sorted(known))
            raise ValueError(f"--parameter: expected the one of {options.scene} that varies, of {names}")
        options.parameter = "rpm"
    if options.parameter not in known:
        raise UnknownName(f"parameter of {options.scene}", options.parameter, known)


def arguments_of(options: argparse.Namespace, scene: Any) -> dict[str, Any]:
    """What the scene that the options name was made with: all parameters that have a value."""
    known = parameters_of(options.scene)
    if own.is_file(options.scene):
        texts = settings(options, known, options.scene)
        given = {name: read(name, value, known[name]) for name, value in texts.items()}
        return {name: x for name, x in known.items() if isinstance(x, (int, float, str))} | given
    return {name: x for name, x in scene.parameters.items() if name in known}


def making(options: argparse.Namespace, scene: Any, varied: str) -> Callable[..., Any]:
    """A function of the varied parameter, by name, that makes the scene of the options."""
    fixed = {name: x for name, x in arguments_of(options, scene).items() if name != varied}
    if own.is_file(options.scene):
        return partial(_own_scene, options.scene, **fixed)
    return partial(SCENES[options.scene].make, **fixed)


def _own_scene(file: str, **values: Any) -> Any:
    return own.made(file, values)


def made_scene(scene: str, values: Mapping[str, Any], t_end: float | None) -> Any:
    """A scene, ready or in a file, with these parameters and up to this time."""
    if own.is_file(scene):
        return own.made(scene, values, t_end)
    if scene not in SCENES:
        raise UnknownName("scene", scene, SCENES)
    return SCENES[scene].make(**values, **({} if t_end is None else {"t_end": t_end}))


def read(name: str, value: str, default: Any) -> Any:
    """A parameter given as a text, as what its default is; of a file's function without one, a number."""
    if isinstance(default, str):
        return value
    kind = type(default) if isinstance(default, (bool, int)) else float
    return number(name, value, kind)


def number(name: str, value: str, kind: type[float] = float) -> float:
    """The value of a parameter given as a text; kind: float, int for a count, or bool."""
    if kind is bool:
        if value.lower() not in ("true", "false"):
            raise ValueError(f"--set: {name}: expected true or false, got {value!r}")
        return value.lower() == "true"
    try:
        return kind(value)
    except ValueError:
        expected = "a whole number" if kind is int else "a number"
        raise ValueError(f"--set: {name}: expected {expected}, got {value!r}") from None


def step(options: argparse.Namespace, scene: Scene, others: Iterable[Scene] = ()) -> float:
    """The step that the options give, or one that suits the span of a scene, and the periods of all [s].

    others : what the scene becomes as its parameter varies, made where that is asked for
    """
    if options.h is not None:
        return float(options.h)
    period = min([scene.period, *(x.period for x in others)])
    return min((scene.t_span[1] - scene.t_span[0]) / PER_SPAN, period / PER_PERIOD)


def moreau(options: argparse.Namespace, scene: Scene, others: Iterable[Scene] = ()) -> Moreau:
    """Time-stepping as the options say."""
    return Moreau(h=step(options, scene, others), theta=options.theta, lcp=options.lcp)


def located(options: argparse.Namespace, scene: Scene) -> Located:
    """Time-stepping with located impacts, as the options say."""
    order = options.order
    return Located(h=step(options, scene), order=int(order) if order.isdigit() else order)


def event_driven(options: argparse.Namespace) -> EventDriven:
    """The event-driven integrator at the tolerance of the options, 1e-12 where none is given."""
    tolerance = 1e-12 if options.tolerance is None else options.tolerance
    return EventDriven(rtol=tolerance, atol=tolerance)


def save_figure(figure: Any, file: Path) -> None:
    """Write a picture, or leave the one that is there as it is."""
    with replacing(file) as draft:
        figure.savefig(draft, dpi=DPI)
    interrupt.wrote(file)


def save_film(run: Any, file: Path) -> None:
    """Write the film of a run, with a bar over its pictures on a terminal."""
    from tqdm import tqdm

    with tqdm(desc="film", unit="picture", disable=None, leave=False) as bar:

        def progress(done: int, total: int) -> None:
            bar.total, bar.n = total, done
            bar.refresh()

        run.animate().save(file, progress)
    interrupt.wrote(file)


def save_text(text: str, file: Path) -> None:
    """Write a text, or leave the file that is there as it is."""
    with replacing(file) as draft:
        draft.write_text(text + "\n")
    interrupt.wrote(file)


def say(line: str) -> None:
    """Print a line at once, above a bar where there is one."""
    from tqdm import tqdm

    tqdm.write(line)
    sys.stdout.flush()


@contextmanager
def progress_bar(scene: Scene | HybridScene, title: str) -> Generator[Callable[[float], None], None, None]:
    """A bar over the scene's time span, on a terminal only."""
    from tqdm import tqdm

    t_start, t_end = scene.t_span
    form = "{desc}: {percentage:3.0f}% |{bar}| {n:.3g}/{total:.3g} s [{elapsed}<{remaining}]"
    with tqdm(total=t_end - t_start, desc=title, bar_format=form, disable=None, leave=False) as bar:
        shown = 0.0

        def progress(t: float) -> None:
            nonlocal shown
            if time.monotonic() - shown >= REFRESH:
                bar.n, shown = min(t, t_end) - t_start, time.monotonic()
                bar.refresh()

        yield progress
