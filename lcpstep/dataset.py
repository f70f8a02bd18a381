"""Labelled results: an xarray dataset with units and all parameters, saved to NetCDF."""

from __future__ import annotations

import errno
import importlib
import json
import os
import shutil
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any

from lagrangian import HybridScene, Scene
from lagrangian.labels import common_unit, own_unit
from lcpstep.files import replacing
from lcpstep.simulation import Method

COMPRESSION = {"zlib": True, "complevel": 4}
FULL = 65536  # bytes: a disk with less than that has had no space for a dataset
UNITS = {  # of variables that results are made of, where lengths are in metres
    "impulse": "N s", "joint_impulse": "N s", "friction_impulse": "N s", "impact_impulse": "N s",
    "impact_before": "m/s", "impact_after": "m/s",
}  # fmt: skip
FIXED = {"t": "s", "impact_time": "s", "switch_time": "s", "impact_phase": "1", "rpm": "1/min"}


def units(labels: Sequence[str]) -> dict[str, str]:
    """Units of variables of a scene with these labels; those of coordinates are its own."""
    n = len(labels) // 2
    known = {name: own_unit(unit, labels) for name, unit in UNITS.items()}
    own = {"q": labels[:n], "v": labels[n:]}
    return known | {name: common_unit(of) or ", ".join(of) for name, of in own.items()}


def labelled(
    variables: Mapping[str, tuple[tuple[str, ...], Any]],
    coordinates: Mapping[str, Any],
    attributes: Mapping[str, Any],
    units: Mapping[str, str] = MappingProxyType({}),
) -> Any:
    """Dataset of named arrays (dimensions, values) with their units."""
    import xarray

    data = xarray.Dataset(dict(variables), coords=dict(coordinates), attrs=dict(attributes))
    for name in data.variables:
        unit = {**FIXED, **units}.get(str(name))
        if unit:
            data[name].attrs["units"] = unit
    return data


def check_free(parameter: str, taken: Iterable[str]) -> None:
    """Refuse a parameter of the name of something else in a dataset, before any work starts.

    Raises
    ------
    TypeError    the name is no text
    ValueError   it is taken
    """
    if not isinstance(parameter, str):
        raise TypeError(f"parameter: expected the name of one, got {parameter!r}")
    if parameter in taken:
        raise ValueError(
            f"parameter: the result has something else of the name {parameter!r}; give it another one, as the "
            f"function that makes scenes calls it"
        )


def provenance(scene: Scene | HybridScene, method: Method) -> dict[str, Any]:
    """Attributes that say what was computed, and how."""
    return {
        "scene": scene.name,
        "parameters": json.dumps(dict(scene.parameters)),
        "method": repr(method),
        "lcpstep": importlib.import_module("lcpstep").__version__,
    }


def check_new(file: Path | str | None, overwrite: bool) -> None:
    """Refuse to write over a file that exists; called before any work starts."""
    if file is not None and Path(file).exists() and not overwrite:
        raise FileExistsError(f"{file} exists already")


def save(data: Any, file: Path | str, *, overwrite: bool = False) -> Path:
    """Write a dataset to NetCDF; the file appears complete or not at all.

    Raises
    ------
    FileExistsError   the file exists and `overwrite` is not set
    NotWritten   there is no space for it, or no permission; a file that was there before is unchanged
    """
    file = Path(file)
    check_new(file, overwrite)
    packed = {name: COMPRESSION for name, x in data.data_vars.items() if x.size > 1 and x.dtype.kind in "fiu"}
    with replacing(file) as draft:
        try:
            data.to_netcdf(draft, engine="netcdf4", encoding=packed)
        except (RuntimeError, PermissionError) as error:  # what the library makes of a disk that is full
            raise _reason(error, file.parent) from error
    return file


def _reason(error: Exception, folder: Path) -> OSError:
    """Why a dataset could not be written: the library has no word for a disk that is full."""
    if shutil.disk_usage(folder).free < FULL:
        return OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
    return error if isinstance(error, OSError) else OSError(f"the NetCDF library says {error}")


Progress = Callable[[int, int], None]
