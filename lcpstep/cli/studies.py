"""What the commands for attractors, diagrams, basins and orbits share: arguments, files, progress."""

from __future__ import annotations

import argparse
import shutil
import sys
import time
from collections.abc import Callable, Generator, Iterable
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import Any

from lagrangian import HybridScene
from lcpstep import dataset
from lcpstep.cli import interrupt
from lcpstep.cli.common import (
    FAILED,
    REFRESH,
    event_driven,
    moreau,
    save_figure,
    scene_arguments,
    scene_of,
    stepping_arguments,
)
from lcpstep.dataset import Progress
from lcpstep.errors import SweepStopped
from lcpstep.pace import Told, telling
from lcpstep.simulation import Method

CAM_BOX = ((0.0, -60.0), (1.5, 60.0))  # relative position [m] and velocity [m/s] of random starts
TAKEN = {  # options of one method: their defaults, and whose they are
    "h": (None, "moreau"), "theta": (0.5, "moreau"), "lcp": ("lemke", "moreau"), "tolerance": (1e-12, "event-driven"),
}  # fmt: skip
PARTS = "parts"  # folder of an unfinished sweep


def study_arguments(p: argparse.ArgumentParser) -> None:
    """Scene, method, section, files, threads."""
    scene_arguments(p)
    p.add_argument("--rpm", type=float, help="cam speed [rpm]")
    p.add_argument(
        "--method", choices=["event-driven", "moreau"], default="event-driven", help="(event-driven)"
    )
    stepping_arguments(p)
    p.add_argument("--tolerance", type=float, default=1e-12, help="rtol and atol, event-driven only (1e-12)")
    p.set_defaults(h=None, theta=None, lcp=None, tolerance=None)  # so that what is given is known
    p.add_argument("--phase", type=float, default=0.0, help="of the section, a share of the period (0)")
    p.add_argument("--seed", type=int, default=0, help="of all random numbers; stored with the result (0)")
    p.add_argument("--jobs", type=int, metavar="N", help="threads; default: all cores")
    p.add_argument("--out", type=Path, default=Path("out"), metavar="DIR", help="where the files go (out)")
    p.add_argument("--overwrite", action="store_true", help="write over files of an earlier run")


def method_of(options: argparse.Namespace, scene: Any, others: Iterable[Any] = ()) -> Method:
    """The method that the options name; others as for `step`."""
    return moreau(options, scene, others) if options.method == "moreau" else event_driven(options)


def _refuse_what_does_not_apply(options: argparse.Namespace) -> None:
    """ValueError for an option of the method that is not used; what is not given is set to its default."""
    for name, (default, method) in TAKEN.items():
        if getattr(options, name, None) is None:
            setattr(options, name, default)
        elif options.method != method and not getattr(options, "compare", None):
            raise ValueError(f"--{name}: {options.method} has none, it belongs to {method}")


def study_scene(options: argparse.Namespace, **more: Any) -> Any:
    """The scene that the options name, at the speed --rpm if it is given.

    ValueError for options of another method.
    """
    if hasattr(options, "method"):
        _refuse_what_does_not_apply(options)
    if options.rpm is not None:
        if options.scene != "cam-follower":
            raise ValueError("--rpm: only the cam-follower turns")
        more["rpm"] = options.rpm
    scene = scene_of(options, **more)
    stepping = options.method == "moreau" or bool(getattr(options, "compare", None))
    if isinstance(scene, HybridScene) and stepping:
        raise ValueError(f"--method, --compare: {scene.name!r} has modes, and is run by event-driven alone")
    return scene


def files(options: argparse.Namespace, name: str) -> tuple[Path, Path]:
    """Data file and picture of a study; FileExistsError where they exist and may not be written over."""
    data, picture = options.out / f"{name}.nc", options.out / f"{name}.png"
    for file in (data, picture):
        if file.exists() and not options.overwrite:
            raise FileExistsError(f"--out: {file} exists already; --overwrite replaces it")
    return data, picture


def finish(options: argparse.Namespace, data: Any, figure: Any, names: tuple[Path, Path]) -> None:
    """Save data and picture, None for none, and drop the parts of the sweep, which are no longer needed.

    What was written is said, beside JSON not among it.
    """
    dataset.save(data, names[0], overwrite=options.overwrite)
    interrupt.wrote(names[0])
    if figure is not None:
        save_figure(figure, names[1])
    shutil.rmtree(options.out / PARTS, ignore_errors=True)
    for name in names[: 1 if figure is None else 2]:
        print(f"wrote {name}", file=sys.stderr if getattr(options, "json", False) else sys.stdout)


def stopped(run: Callable[[argparse.Namespace], int]) -> Callable[[argparse.Namespace], int]:
    """A command for which a sweep that stopped is a failure of the run and not a wrong argument."""

    def guarded(options: argparse.Namespace) -> int:
        try:
            return run(options)
        except SweepStopped as error:
            print(f"lcpstep: {error}", file=sys.stderr)
            return FAILED

    return guarded


def keeps_parts(options: argparse.Namespace) -> None:
    """A sweep begins: what is finished of it is kept part by part, and the same command goes on from there."""
    folder = options.out / PARTS

    def kept() -> str:
        count = sum(1 for _ in folder.rglob("part-*.npz"))
        return f"{count} finished parts in {folder}" if count else ""

    interrupt.keeps(options, kept)


@contextmanager
def work_bar(title: str) -> Generator[Callable[[str], None], None, None]:
    """A bar with the time left over each stage of what is done meanwhile, on a terminal only; ten times a second.

    What it gives names the stage.
    """
    with share_bar(title) as (bar, told), nullcontext() if bar.disable else telling(told):
        yield bar.set_description_str


@contextmanager
def share_bar(title: str) -> Generator[tuple[Any, Told], None, None]:
    """The same bar, and what to tell it: how far a loop is, and of how much."""
    from tqdm import tqdm

    form = "{desc}: {percentage:3.0f}% |{bar}| [{elapsed}<{remaining}]"
    with tqdm(desc=title, total=1.0, bar_format=form, disable=None, leave=False) as bar:
        latest = (0.0, 0.0)  # share done, and when that was shown

        def told(done: float, total: float) -> None:
            nonlocal latest
            share, now = min(done / total, 1.0), time.monotonic()
            if share < latest[0]:  # another stage
                bar.reset(1.0)
            if share < latest[0] or now - latest[1] >= REFRESH:
                bar.n, latest = share, (share, now)
                bar.refresh()

        yield bar, told


@contextmanager
def parts_bar(title: str) -> Generator[Progress, None, None]:
    """A bar over the parts of a sweep, on a terminal only."""
    from tqdm import tqdm

    with tqdm(desc=title, unit="part", disable=None, leave=False) as bar:

        def progress(done: int, total: int) -> None:
            bar.total, bar.n = total, done
            bar.refresh()

        yield progress
