"""Runs in files: `Trajectory.save(path)` and `lcpstep.load(path)`, as NetCDF that any tool opens.

Variables carry states, impulses and the log with their units. The variable `record`, a text in JSON, says what the
scene was (numbers; functions by name, source and checksum), the method, how the run ended, and which versions it was
made with. A checksum over all of it tells a damaged file. Loading runs nothing that the file brings: functions of the
ready scenes are found by name and checksum, those of others come with `load(path, scene=...)`.
"""

from __future__ import annotations

import hashlib
import importlib
import json
import platform
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from lagrangian.scenes import SCENES
from lcpstep import dataset
from lcpstep.callbacks import functions
from lcpstep.described import COLUMNS, Builder, Describer
from lcpstep.errors import DamagedFile, LcpStepError
from lcpstep.files import file_path

FORMAT = 1
SIGNATURES = (b"\x89HDF\r\n\x1a\n",)  # how a NetCDF file of today begins
RECORD, CHECKSUM = "record", "sha256"
ENDING = ".nc"
DIMENSIONS = {  # of the arrays that every run has
    "t": ("t",), "q": ("t", "coordinate"), "v": ("t", "coordinate"), "impulse": ("t", "contact"),
    "joint_impulse": ("t", "joint"), "friction_impulse": ("t", "contact"),
    "x": ("t", "state"), "mode": ("t",),
}  # fmt: skip


def to_xarray(run: Any) -> Any:
    """States, impulses and the log of a run as an `xarray.Dataset`, with units and what was computed."""
    variables: dict[str, Any] = {}
    for name, dimensions in DIMENSIONS.items():
        x = getattr(run, name, None)
        if name != "t" and x is not None and np.size(x):
            variables[name] = (dimensions, x)
    for log, start in COLUMNS.items():
        lines = getattr(run, log, None)
        if lines is not None:
            variables |= {f"{start}_{name}": _column(start, lines[name]) for name in lines.dtype.names}
    data = dataset.labelled(variables, {"t": run.t}, {}, dataset.units(run.scene.labels))
    return data.assign_attrs(_attributes(run))


def to_dataframe(run: Any, of: str = "states") -> Any:
    """A `pandas.DataFrame`: the kept states with their impulses over the time t, or a line for each event.

    Parameters
    ----------
    of : "states", columns q0, q1, ..., v0, ..., impulse0, ...; or "events", impacts and switches in the order of time
    """
    import pandas

    logs = [lines for lines in (getattr(run, log, None) for log in COLUMNS) if lines is not None]
    if of == "events":
        tables = [
            pandas.DataFrame(_columns({name: np.asarray(lines[name]) for name in lines.dtype.names}))
            for lines in logs
        ]
        if len(tables) == 1:
            return tables[0]
        return pandas.concat(tables, ignore_index=True).sort_values("time", kind="stable", ignore_index=True)
    if of != "states":
        raise ValueError(f'of: expected "states" or "events", got {of!r}')
    arrays = {name: getattr(run, name) for name in DIMENSIONS if name != "t" and hasattr(run, name)}
    kept = {name: x for name, x in arrays.items() if len(x) == len(run.t)}
    return pandas.DataFrame(_columns(kept), index=pandas.Index(run.t, name="t"))


def save(run: Any, path: str | Path, *, overwrite: bool = False) -> Path:
    """Write a run to a file; see `Trajectory.save`."""
    path = file_path(path)
    if path.suffix != ENDING:
        raise ValueError(f"path: expected a name that ends in {ENDING}, got {str(path)!r}")
    dataset.check_new(path, overwrite)
    describer = Describer()
    record = {
        "format": FORMAT, "lcpstep": importlib.import_module("lcpstep").__version__, "numpy": np.__version__,
        "python": platform.python_version(), "run": describer.tree(run),
    }  # fmt: skip
    try:
        text = json.dumps(record)
    except (TypeError, ValueError) as error:
        raise LcpStepError(f"scene: it cannot be saved: {error}") from error
    arrays = describer.arrays | {RECORD: np.frombuffer(text.encode(), dtype=np.uint8)}
    arrays = {name: x.astype("u1") if x.dtype.kind == "b" else x for name, x in arrays.items()}
    attributes = _attributes(run) | {CHECKSUM: digest(arrays)}
    lengths = {"t": len(run.t)}
    variables = {name: (_dimensions(name, x, lengths), x) for name, x in arrays.items() if name != "t"}
    data = dataset.labelled(
        variables,
        {"t": ("t", arrays["t"])} if "t" in arrays else {},
        attributes,
        dataset.units(run.scene.labels),
    )
    for x in data.variables.values():
        x.encoding["_FillValue"] = None  # numbers are written as they are
    return dataset.save(data, path, overwrite=overwrite)


def load(path: str | Path, scene: Any = None) -> Any:
    """A run that `Trajectory.save` has written, equal to it to the last bit.

    Parameters
    ----------
    path : the file
    scene : the scene that was run, where it has functions of your own: a file carries their source and checksum to be
        read, and never runs them. Without it the loaded run holds all its numbers, and what needs such a function
        (another run; states between kept ones, by the methods that compute them anew) says so.

    Returns
    -------
    Trajectory, or HybridTrajectory

    Raises
    ------
    FileNotFoundError, IsADirectoryError   there is no such file
    DamagedFile   the file is damaged, no run, or written by a version whose files this one does not know
    ValueError   scene is another than the one that was run; the message names the first difference
    """
    if file_path(path).is_dir():
        raise IsADirectoryError(f"{path}: expected a file written by Trajectory.save, and this is a folder")
    record, arrays = _read(file_path(path))
    if record.get("format") != FORMAT:
        raise DamagedFile(
            f"{path}: written by lcpstep {record.get('lcpstep')}, whose files this version cannot read"
        )
    if scene is not None:
        _check_scene(scene, record["run"]["fields"]["scene"], arrays)
    try:
        run = Builder(arrays, scene).build(record["run"])
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        words = f"written by lcpstep {record.get('lcpstep')}, whose files this version cannot read"
        raise DamagedFile(f"{path}: {words} ({error!r})") from error
    if scene is None:
        _regain_exact(run.scene)
    return run


def digest(arrays: Mapping[str, np.ndarray]) -> str:
    """A checksum of all arrays, their names and types."""
    sha = hashlib.sha256()
    for name in sorted(arrays):
        x = np.ascontiguousarray(arrays[name])
        little = x.astype(x.dtype.newbyteorder("<"), copy=False)
        sha.update(f"{name} {little.dtype.str} {x.shape}\n".encode())
        sha.update(little.tobytes())
    return sha.hexdigest()


def _read(path: Path) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    """The record and the arrays of a file whose checksum fits."""
    import xarray

    with path.open("rb") as file:
        start = file.read(8)
    if start not in SIGNATURES:
        raise DamagedFile(f"{path}: expected a run written by Trajectory.save, and this is no NetCDF file")
    try:
        with xarray.open_dataset(path.absolute(), engine="netcdf4", decode_cf=False, cache=False) as data:
            arrays = {str(name): np.asarray(x.values) for name, x in data.variables.items()}
            sha = data.attrs.get(CHECKSUM)
    except Exception as error:  # what the libraries below make of damage is not known
        raise DamagedFile(
            f"{path}: damaged, {error}; ask for the file again, or run the scene anew"
        ) from error
    if RECORD not in arrays or sha is None:
        raise DamagedFile(
            f"{path}: expected a run written by Trajectory.save; this NetCDF file holds {_few(arrays)}"
        )
    if digest(arrays) != sha:
        raise DamagedFile(
            f"{path}: damaged, its checksum does not fit; ask for the file again, or run the scene anew"
        )
    record: dict[str, Any] = json.loads(arrays.pop(RECORD).tobytes())
    return record, arrays


def _check_scene(scene: Any, tree: Any, arrays: Mapping[str, np.ndarray]) -> None:
    """ValueError where a scene is not the one of a file, with what differs."""
    describer = Describer()
    mine, other = _leaves(describer.tree(scene, "scene"), describer.arrays), _leaves(tree, arrays)
    for place in sorted(set(mine) | set(other)):
        a, b = mine.get(place), other.get(place)
        # Of an object that is called there is none in a file of before
        untold = place.endswith(".sha256") and not (a and b)
        if a != b and not untold and not _aside(place):
            name = place.strip(".").removesuffix(".sha256")
            raise ValueError(f"scene: it is not the one of the file, {name} is another")


def _aside(place: str) -> bool:
    """Whether a motion does not depend on what is there."""
    return place.endswith(".source") or ".exact" in place or ".drawing" in place


def _leaves(tree: Any, arrays: Mapping[str, np.ndarray], place: str = "") -> dict[str, Any]:
    """Everything in a tree by its path, arrays as checksums."""
    if isinstance(tree, dict) and "array" in tree:
        x = arrays.get(tree["array"])
        return {
            place: (
                tree["dtype"],
                tree["shape"],
                None if x is None else digest({"": x.astype(tree["dtype"])}),
            )
        }
    if isinstance(tree, (dict, list)):
        items = tree.items() if isinstance(tree, dict) else enumerate(tree)
        result: dict[str, Any] = {}
        for key, x in items:
            inner = place if key in ("fields", "names") else f"{place}.{key}"
            result |= _leaves(x, arrays, inner)
        return result
    return {place: tree}


def _regain_exact(scene: Any) -> None:
    """The motion of a ready scene in closed form, from the function that makes the scene with these parameters."""
    if not isinstance(scene.exact, functions.Absent):
        return
    entry = SCENES.get(scene.name)
    if entry is None:
        return
    takes = entry.parameters | {"t_end": None}
    values = {name: x for name, x in scene.parameters.items() if name in takes}
    try:
        made = entry.make(**values, t_end=scene.t_span[1])
        made = replace(made, t_span=scene.t_span)
    except (TypeError, ValueError, ArithmeticError):
        return
    describer, own = Describer(), Describer()
    mine = _leaves(describer.tree(made, "scene"), describer.arrays)
    its = _leaves(own.tree(scene, "scene"), own.arrays)
    if not any(mine.get(k) != its.get(k) for k in {*mine, *its} if not _aside(k)):
        object.__setattr__(scene, "exact", made.exact)


def _attributes(run: Any) -> dict[str, Any]:
    """What a reader of the file wants to know without this library."""
    known = dataset.provenance(run.scene, run.method)
    counts = {name: int(x) for name, x in vars(run.counts).items()}
    return known | {
        "status": run.status.name, "message": run.message, "doubt": getattr(run, "doubt", ""),
        "counts": json.dumps(counts),
    }  # fmt: skip


def _dimensions(name: str, x: np.ndarray, lengths: dict[str, int]) -> tuple[str, ...]:
    """Names of an array's axes; its own where an array of the same names has other lengths."""
    log = next((f"{start}_event" for start in COLUMNS.values() if name.startswith(f"{start}_")), None)
    names = DIMENSIONS.get(name) or ((log,) if log and x.ndim == 1 else ())
    if len(names) == x.ndim and all(
        lengths.setdefault(d, n) == n for d, n in zip(names, x.shape, strict=True)
    ):
        return names
    return tuple(f"{name}_{k}" for k in range(x.ndim))


def _column(start: str, x: Any) -> Any:
    x = np.asarray(x)
    return ((f"{start}_event", "state")[: x.ndim], x)


def _columns(arrays: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Columns of a table, one for each number of a line."""
    table: dict[str, np.ndarray] = {}
    for name, x in arrays.items():
        table |= {name: x} if x.ndim == 1 else {f"{name}{k}": x[:, k] for k in range(x.shape[1])}
    return table


def _few(arrays: Mapping[str, Any]) -> str:
    return ", ".join(list(arrays)[:5]) or "nothing"
