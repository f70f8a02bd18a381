"""`lcpstep run`: carry out a parameter study that is written down in a file."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from lagrangian import Scene
from lcpstep import dataset, parameters
from lcpstep.cli import interrupt, own
from lcpstep.cli.common import DONE, FAILED, made_scene, parameters_of, save_figure, save_text
from lcpstep.cli.studies import parts_bar
from lcpstep.errors import UnknownName
from lcpstep.parameters import ParameterStudy
from lcpstep.saving import load
from lcpstep.trajectory import Status, Trajectory

SHOWN = 20  # lines of the table that are printed
NAME = "run-{:04}.nc"  # of a run by its number


def add(commands: Any) -> None:
    """Arguments of the command."""
    p = commands.add_parser(
        "run",
        help="carry out a parameter study written in TOML",
        description="Runs a scene over all combinations of its swept parameters, as a TOML file says: scene, t_end, "
        "[method], [parameters], [sweep], [outputs]; see docs/parameter-studies.md. The result carries the text.",
        epilog="Example: lcpstep run study.toml",
    )
    p.add_argument("file", type=Path, metavar="FILE", help="the study (.toml)")
    p.add_argument("--overwrite", action="store_true", help="write over files of an earlier run")
    p.set_defaults(run=run_file)


def run_file(options: argparse.Namespace) -> int:
    """`lcpstep run`."""
    study = parameters.read_file(options.file)
    folder = options.file.parent
    scene = str(folder / study.scene) if own.is_file(study.scene) else study.scene
    known = parameters_of(scene)
    for name in (*study.fixed, *study.sweep):
        if name not in known:
            raise UnknownName(f"parameter of {study.scene}", name, known)
    names = {
        key: folder / study.outputs[key]
        for key in ("file", "table", "picture", "runs")
        if key in study.outputs
    }
    for key in ("file", "table", "picture"):
        if key in names and names[key].exists() and not options.overwrite:
            where = f"{options.file.name}: [outputs]: {key}"
            raise FileExistsError(f"{where}: {names[key]} exists already; --overwrite replaces it")
    if "picture" in names and not study.sweep:
        raise ValueError(
            f"{options.file.name}: [outputs]: picture: expected a parameter in [sweep] to draw over"
        )
    kept = found = None
    if "runs" in names:
        kept = _keeper(names["runs"], options.overwrite)
        found = None if options.overwrite else _finder(names["runs"], study)
        interrupt.keeps(options, lambda: _kept_in(names["runs"]))

    def make(values: Mapping[str, Any]) -> Scene:
        made: Scene = made_scene(scene, values, study.t_end)
        return made

    with parts_bar(options.file.name) as progress:
        result = study.run(make, progress, kept, found)
    _write(result, study, names, options.overwrite)
    return DONE if all(x == Status.DONE.name for x in result.status.values.ravel()) else FAILED


def _keeper(folder: Path, overwrite: bool) -> Any:
    """What saves every run."""

    def keep(k: int, run: Trajectory) -> None:
        run.save(folder / NAME.format(k), overwrite=overwrite)

    return keep


def _finder(folder: Path, study: ParameterStudy) -> Any:
    """What finds the runs of the same study that was interrupted."""

    def find(k: int, scene: Scene) -> Trajectory | None:
        file = folder / NAME.format(k)
        if not file.exists():
            return None
        try:
            run: Trajectory = load(file, scene)
        except ValueError as error:
            raise FileExistsError(
                f"{file}: no run of this study; --overwrite replaces it ({error})"
            ) from None
        if run.method != study.method:
            raise FileExistsError(f"{file}: a run by {run.method}; --overwrite replaces it")
        if study.tells_errors and run.error is None and run.status is Status.DONE:
            raise FileExistsError(f"{file}: a run without an error bar; --overwrite replaces it")
        return run

    return find


def _kept_in(folder: Path) -> str:
    """How many runs are there, in words."""
    n = len(list(folder.glob("run-*.nc")))
    return f"{n} runs in {folder}" if n else ""


def _write(result: Any, study: ParameterStudy, names: Mapping[str, Path], overwrite: bool) -> None:
    """Files, and the table on the terminal."""
    table = result.to_dataframe() if study.sweep else result.expand_dims("run").to_dataframe()
    print(table.head(SHOWN).to_string())
    if len(table) > SHOWN:
        print(f"... {len(table) - SHOWN} lines more")
    if "file" in names:
        interrupt.wrote(dataset.save(result, names["file"], overwrite=overwrite))
    if "table" in names:
        head = "".join(f"# {line}\n" for line in study.text.splitlines())
        save_text(head + table.to_csv().rstrip("\n"), names["table"])
    if "picture" in names:
        from lcpstep.plot.parameters import measures

        save_figure(measures(result, list(study.sweep), study.outputs["measures"]), names["picture"])
    for name in names.values():
        print(f"wrote {name}")
