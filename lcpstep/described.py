"""Answers, scenes and methods as plain data: a tree of names, numbers and texts, and the arrays that it names.

Only classes that are listed here are made again from a tree, and none of their functions is run for it.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import MISSING, fields, is_dataclass
from functools import partial
from typing import Any

import numpy as np

from lagrangian import (
    Contacts,
    Coulomb,
    Guard,
    Harmonic,
    HybridScene,
    HybridSystem,
    Joints,
    LinearContacts,
    LinearJoints,
    LinearSystem,
    Mode,
    Scene,
    Surface,
    System,
)
from lagrangian.checks import ReadOnly
from lagrangian.parameters import Values
from lagrangian.pickling import Pickled
from lagrangian.sparse import is_sparse
from lcpstep.audit.result import Audit, Found, Window
from lcpstep.callbacks import functions
from lcpstep.errorbar.bars import Bar, ErrorBar
from lcpstep.errors import LcpStepError
from lcpstep.events import EventDriven
from lcpstep.events.arcs.run import Arcs
from lcpstep.events.flight.run import Flights
from lcpstep.events.hybrid.trajectory import HybridTrajectory, Pieces
from lcpstep.events.running import Moved
from lcpstep.recording import States
from lcpstep.stepping.again import Again
from lcpstep.stepping.interpolation import Bent, Linear, Parabolic
from lcpstep.stepping.located import Located
from lcpstep.stepping.moreau import Moreau
from lcpstep.trajectory import Counts, Status, Trajectory

MODELS = (
    Contacts, Coulomb, Guard, Harmonic, HybridScene, HybridSystem, Joints, LinearContacts, LinearJoints,
    LinearSystem, Mode, Scene, Surface, System,
)  # fmt: skip
METHODS = (EventDriven, Located, Moreau)
MOTIONS = (Again, Arcs, Bent, Flights, Linear, Moved, Parabolic, Pieces, States)
ANSWERS = (Audit, Bar, Counts, ErrorBar, Found, HybridTrajectory, Trajectory, Window)
KINDS = {kind.__name__: kind for kind in (*MODELS, *METHODS, *MOTIONS, *ANSWERS)}
LEFT_OUT = {"Flights": ("model",)}  # good in one process only
MOVING = (
    "system",
    "contacts",
    "joints",
    "p",
    "corners",
    "period",
)  # of a scene: what decides how a state moves
COLUMNS = {"impacts": "impact", "switches": "switch"}  # what the log's columns begin with
Tree = Any


class Describer:
    """Makes trees, and collects their arrays by name; what occurs twice is written once."""

    def __init__(self) -> None:
        self.arrays: dict[str, np.ndarray] = {}
        self.places: dict[int, str] = {}  # of objects that have been met
        self.met: list[Any] = []  # which keeps their numbers theirs

    def tree(self, x: Any, place: str = "") -> Tree:
        """One object as plain data; `place` is its path, "scene_system_M".

        Raises
        ------
        LcpStepError   it holds something that no file can take, and where
        """
        if x is None or isinstance(x, (bool, str)):
            return x
        if isinstance(x, (int, float, np.number, np.bool_)):
            return x.item() if isinstance(x, np.generic) else x
        if isinstance(x, Mapping):
            return {"names": {str(k): self.tree(y, f"{place}_{k}") for k, y in x.items()}}
        if type(x) in (tuple, list):
            return {type(x).__name__: [self.tree(y, f"{place}_{k}") for k, y in enumerate(x)]}
        if id(x) in self.places:
            return {"as": self.places[id(x)]}
        self.places[id(x)] = place
        self.met.append(x)
        return self._new(x, place)

    def told(self, x: Any, place: str) -> Tree:
        """The same; of what no file can take the name of its class."""
        try:
            return self.tree(x, place)
        except LcpStepError:
            return type(x).__qualname__

    def _new(self, x: Any, place: str) -> Tree:
        if isinstance(x, np.ndarray):
            return self._array(x, place)
        if is_sparse(x):
            parts = {part: self.tree(getattr(x, part), f"{place}_{part}") for part in SPARSE}
            return {"sparse": parts, "shape": [int(n) for n in x.shape]}
        if isinstance(x, partial):
            inner = (self.tree(y, f"{place}_{k}") for k, y in enumerate((x.func, x.args, x.keywords)))
            return {"partial": list(inner)}
        kind = type(x).__name__
        if KINDS.get(kind) is type(x):
            names = [name for name in _names(type(x)) if name not in LEFT_OUT.get(kind, ())]
            inside = f"{place}_" if place else ""
            return {
                "kind": kind,
                "fields": {name: self.tree(getattr(x, name), f"{inside}{name}") for name in names},
            }
        if is_dataclass(x) and not callable(x):
            raise LcpStepError(f"{place}: an object of class {kind} cannot be saved")
        if callable(x):
            return functions.described(x)
        raise LcpStepError(f"{place}: expected numbers, texts or arrays, got {x!r}, which cannot be saved")

    def _array(self, x: np.ndarray, place: str) -> Tree:
        if x.dtype.names:
            start = COLUMNS.get(place, place)
            return {
                "log": {name: self._array(np.asarray(x[name]), f"{start}_{name}") for name in x.dtype.names}
            }
        if x.dtype.kind == "U":
            known, codes = np.unique(x, return_inverse=True)
            coded = self._array(codes.reshape(x.shape), place)
            return {"texts": known.tolist(), "dtype": x.dtype.str, "codes": coded}
        if x.dtype.kind not in "biuf":
            raise LcpStepError(f"{place}: arrays of {x.dtype} cannot be saved")
        if x.size:
            self.arrays[place] = np.ascontiguousarray(x)
        mark = {"parameters": True} if isinstance(x, Values) else {}
        return {"array": place, "dtype": x.dtype.str, "shape": list(x.shape)} | mark


def checksum(scene: Scene | HybridScene) -> str:
    """A number that is the same exactly if states move on alike, in every process: matrices, functions, parameters.

    Initial state, span, name and drawing have no part in it. Classes of a user's own go by their names.
    """
    made = Describer()
    tree = {name: made.told(getattr(scene, name), name) for name in MOVING if hasattr(scene, name)}
    return _digest(made, tree)


def checksum_of(x: Any) -> str:
    """The same of a function, or of what is called like one."""
    made = Describer()
    return _digest(made, made.told(x, "x"))


def _digest(made: Describer, tree: Tree) -> str:
    found = hashlib.sha256(json.dumps(_without_sources(tree), sort_keys=True).encode())
    for name, x in sorted(made.arrays.items()):
        found.update(f"{name} {x.dtype} {x.shape}".encode() + x.tobytes())
    return found.hexdigest()


def _without_sources(tree: Tree) -> Tree:
    """The same with functions told by their checksums alone: a comment, or another name, makes no other motion."""
    if isinstance(tree, list):
        return [_without_sources(x) for x in tree]
    if not isinstance(tree, dict):
        return tree
    if tree.get("sha256"):
        return tree["sha256"]
    return {name: _without_sources(x) for name, x in tree.items()}


class Builder:
    """Makes objects again from trees and arrays."""

    def __init__(self, arrays: Mapping[str, np.ndarray], scene: Any = None) -> None:
        self.arrays, self.scene = arrays, scene
        self.made: dict[str, Any] = {}

    def build(self, tree: Tree, place: str = "") -> Any:
        """The object; ValueError, KeyError or TypeError where the tree is none that this version writes."""
        if not isinstance(tree, dict):
            return tree
        if "names" in tree:
            return {k: self.build(x, f"{place}_{k}") for k, x in tree["names"].items()}
        for kind in (tuple, list):
            if kind.__name__ in tree:
                return kind(self.build(x, f"{place}_{k}") for k, x in enumerate(tree[kind.__name__]))
        if "as" in tree:
            return self.made[tree["as"]]
        if place == "scene" and self.scene is not None:
            self.made[place] = self.scene
        else:
            self.made[place] = self._new(tree, place)
        return self.made[place]

    def _new(self, tree: dict[str, Any], place: str) -> Any:
        if "array" in tree or "texts" in tree or "log" in tree:
            return self._array(tree)
        if "sparse" in tree:
            from scipy.sparse import csr_array

            parts = [self.build(tree["sparse"][part], f"{place}_{part}") for part in SPARSE]
            return csr_array(tuple(parts), shape=tuple(tree["shape"]))
        if "partial" in tree:
            f, given, named = (self.build(x, f"{place}_{k}") for k, x in enumerate(tree["partial"]))
            absent = [x for x in (f, *given, *named.values()) if isinstance(x, functions.Absent)]
            return absent[0] if absent else partial(f, *given, **named)
        if "function" in tree:
            return functions.found(tree["function"], tree["source"], tree["sha256"])
        kind, inside = KINDS[tree["kind"]], f"{place}_" if place else ""
        values = {name: self.build(x, f"{inside}{name}") for name, x in tree["fields"].items()}
        return _made(kind, values)

    def _array(self, tree: dict[str, Any]) -> Any:
        if "log" in tree:
            columns = {name: self._array(x) for name, x in tree["log"].items()}
            dtype = [(name, x.dtype, x.shape[1:]) for name, x in columns.items()]
            log = np.empty(len(next(iter(columns.values()))), dtype=dtype)
            for name, x in columns.items():
                log[name] = x
            return log.view(np.recarray)
        if "texts" in tree:
            return np.array(tree["texts"], dtype=tree["dtype"])[self._array(tree["codes"])]
        dtype, shape = np.dtype(tree["dtype"]), tuple(tree["shape"])
        if 0 in shape:
            x = np.empty(shape, dtype)
        else:
            x = np.ascontiguousarray(self.arrays[tree["array"]].astype(dtype, copy=False).reshape(shape))
        return x.view(Values) if tree.get("parameters") else x


SPARSE = ("data", "indices", "indptr")


def _names(kind: type) -> tuple[str, ...]:
    """Fields of a class."""
    listed: tuple[str, ...] = getattr(kind, "_fields", ())
    return listed or tuple(f.name for f in fields(kind))


def _made(kind: Any, values: dict[str, Any]) -> Any:
    """An object with these fields, which were checked when it was made first."""
    unknown = set(values) - set(_names(kind))
    if unknown:
        raise ValueError(f"{kind.__name__} has no {', '.join(sorted(unknown))} here")
    if kind is States:
        return States(**values)
    if "parameters" in values:
        values["parameters"] = ReadOnly(values["parameters"])
    if kind in (Trajectory, HybridTrajectory):
        values["status"] = Status(values["status"])
    if kind is Flights:
        values["model"] = None
    for f in fields(kind):
        if f.name not in values:
            values[f.name] = _default(kind, f)
    new = object.__new__(kind)
    if isinstance(new, Pickled):
        new.__setstate__(values)
    else:
        for name, x in values.items():
            object.__setattr__(new, name, x)
    return new


def _default(kind: type, f: Any) -> Any:
    """What a field is that the version that wrote the file did not have."""
    if f.default is not MISSING:
        return f.default
    if f.default_factory is not MISSING:
        return f.default_factory()
    raise ValueError(f"{kind.__name__}.{f.name} is missing")
