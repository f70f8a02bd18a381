"""A scene as a functional mock-up unit: FMI 3, co-simulation, with what it moves like as outputs.

Another program steps the unit; in it a run by `Located` (or another method) goes as far ahead as it is asked for, and
from the start again where it is asked for more, so that the outputs are those of one run, whatever the communication
steps. The unit needs a Python with lcpstep where it runs, as every unit that pythonfmu3 makes needs its packages.
Source: Functional Mock-up Interface specification 3.0 (Modelica Association 2022), section 4.
"""

from __future__ import annotations

import atexit
import base64
import ctypes
import hashlib
import inspect
import keyword
import pickle
import re
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene, checks
from lcpstep.described import Describer
from lcpstep.errors import LcpStepError
from lcpstep.files import file_path, replacing
from lcpstep.simulation import Method, simulate
from lcpstep.stepping.located import Located, require_exact
from lcpstep.trajectory import Status, blows

ENDING = ".fmu"
OWN = ("lagrangian", "lcpstep")  # installed where the unit runs
AHEAD = 2.0  # how much further than asked for a run goes, of the time asked for
UNIT = '''"""Made by lcpstep.export.fmu: {title}."""

import base64
import pickle

from pythonfmu3 import Float64, Fmi3Causality, Fmi3Slave, Fmi3Status, Fmi3StepResult, Fmi3Variability

from lcpstep.export import Motion, let_go_at_exit

MOTION = "{motion}"


class {name}(Fmi3Slave):
    description = "{title}"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        let_go_at_exit(kwargs["resources"])
        self.motion = pickle.loads(base64.b64decode(MOTION))
        self.time = self.motion.start
        self.register_variable(
            Float64("time", causality=Fmi3Causality.independent, variability=Fmi3Variability.continuous)
        )
        for name in self.motion.names:
            self.register_variable(
                Float64(
                    name, causality=Fmi3Causality.output, variability=Fmi3Variability.continuous,
                    getter=lambda name=name: self.motion.value(name),
                )
            )

    def do_step(self, current_time, step_size):
        self.motion.go_to(current_time + step_size)
        self.time = current_time + step_size
        ended = self.motion.ended(self.time)
        return Fmi3StepResult(status=Fmi3Status.error if ended else Fmi3Status.ok)
'''


class Motion:
    """The motion inside a unit: where it is, and as much of the run as has been asked for.

    names : outputs: q0, q1, ..., v0, ..., impulse0, ... (of each contact's impacts so far [N s]), impacts (how many)
    """

    def __init__(self, scene: Scene, method: Method) -> None:
        self.scene, self.method = scene, method
        self.start = self.now = scene.t_span[0]
        self.run: Any = None
        self.names = [f"q{k}" for k in range(scene.n_q)] + [f"v{k}" for k in range(scene.n_q)]
        self.names += [*(f"impulse{c}" for c in range(scene.n_c)), "impacts"]
        self.values = dict(zip(self.names, self._at(self.start), strict=True))

    def go_to(self, t: float) -> None:
        """Be at a time [s], computing further where that is needed."""
        if self.run is None or t > self.run.scene.t_span[1]:
            until = max(self.scene.t_span[1], self.start + AHEAD * (t - self.start))
            self.run = simulate(replace(self.scene, t_span=(self.start, until)), self.method)
        self.now = t
        if t <= self.run.t[-1]:
            self.values = dict(zip(self.names, self._at(t), strict=True))

    def value(self, name: str) -> float:
        """An output at the time at hand."""
        return self.values[name]

    def ended(self, t: float) -> bool:
        """Whether the run has ended before that time, which it says why in `run.message`."""
        return self.run is not None and self.run.status is not Status.DONE and t > self.run.t[-1]

    def _at(self, t: float) -> list[float]:
        s = self.scene
        if self.run is None:
            q, v, log = np.asarray(s.q0), np.asarray(s.v0), None
        else:
            q, v = self.run.at(t)
            log = blows(self.run.impacts[self.run.impacts.time <= t])
        impulses: NDArray[np.float64] = np.zeros(s.n_c)
        if log is not None:
            np.add.at(impulses, log.contact, log.impulse)
        return [*map(float, (*q, *v, *impulses)), 0.0 if log is None else float(len(log))]

    def __getstate__(self) -> dict[str, Any]:
        """The question, and not how far it has been answered."""
        return vars(self) | {"run": None}


def let_go_at_exit(resources: str) -> None:
    """Let the library of a unit give back its hold of Python when this Python ends, and not twice after that.

    Under Linux pythonfmu3's library does so in a destructor of C++ and once more in one of its own, with memory that
    the first has freed: results are out by then, but the process may end in "corrupted double-linked list". What has
    been let go of here is not let go of twice. Where that library itself has started Python (no command line of
    Python's then), it must hold it until the process ends, and nothing is changed.
    Source: PySlaveInstance.cpp of pythonfmu3 0.3.4; PythonFMU's issue 228 (the same library for FMI 2).
    """
    if sys.platform != "linux" or not sys.orig_argv:
        return
    loaded = Path("/proc/self/maps").read_text()
    for file in Path(resources).resolve().parent.glob("binaries/*-linux/*.so"):  # none while the unit is made
        if str(file) in loaded:
            library = ctypes.CDLL(str(file))
            if hasattr(library, "finalizePythonInterpreter"):
                atexit.register(library.finalizePythonInterpreter)


def fmu(scene: Scene, path: str | Path, method: Method | None = None) -> Path:
    """Write a scene as a functional mock-up unit (FMI 3, co-simulation).

    Parameters
    ----------
    scene : lagrangian.Scene; functions of its own must stand at the top of modules, whose files go along
    path : a name that ends in .fmu
    method : default: `Located` with a thousandth of the span as its step

    Returns
    -------
    the path; outputs of the unit are q0, q1, ..., v0, ..., impulse0, ... (summed over the impacts), and impacts

    Raises
    ------
    TypeError   scene is none
    ValueError   the path ends in something else
    LcpStepError   pythonfmu3 is not installed, or the method does not treat the scene
    PicklingError   a function of the scene has no name to be found by
    """
    checks.instance("scene", scene, Scene)
    path = file_path(path)
    if path.suffix != ENDING:
        raise ValueError(f"path: expected a name that ends in {ENDING}, got {str(path)!r}")
    try:
        from pythonfmu3.builder import FmuBuilder
    except ImportError as error:
        raise LcpStepError('export.fmu needs pythonfmu3: pip install "lcpstep[fmu]"') from error
    start, end = scene.t_span
    method = Located((end - start) / 1000.0) if method is None else method
    if isinstance(method, Located) and method.order == "exact":
        require_exact(scene)
    name = re.sub(r"\W", "_", path.stem, flags=re.ASCII)
    if keyword.iskeyword(name) or not name.isidentifier() or re.search(rf"\b{name}\b", UNIT):
        name = f"unit_{name}"
    motion = base64.b64encode(pickle.dumps(Motion(scene, method))).decode()
    title = f"{scene.name} by {method!r}".replace("\\", "/").replace('"', "'").replace("\n", " ")
    with tempfile.TemporaryDirectory() as folder:
        text = UNIT.format(name=name, title=title, motion=motion).encode()
        # A Python that runs several units imports each by a name of its own, and none in place of another module
        script = Path(folder) / f"lcpstep_{hashlib.sha256(text).hexdigest()[:16]}.py"
        script.write_bytes(text)
        made = FmuBuilder.build_FMU(script, folder, project_files=_modules(scene))
        with replacing(path) as draft:
            draft.write_bytes(Path(made).read_bytes())
    return path


def _modules(scene: Scene) -> set[Path]:
    """Files of the modules that the scene's own functions stand in, which the unit takes along."""
    tree = Describer().tree(scene)
    files = set()
    for name in sorted({name.partition(":")[0] for name in _functions(tree)}):
        if name.partition(".")[0] in OWN:
            continue
        if name == "__main__":
            raise LcpStepError(
                "scene: its functions stand in the program itself, where no unit finds them; put them into a module"
            )
        found = inspect.getsourcefile(sys.modules[name]) if name in sys.modules else None
        if found is not None and "." not in name:
            files.add(Path(found))
    return files


def _functions(tree: Any) -> Iterator[str]:
    """Names of all functions in a described scene."""
    if isinstance(tree, dict):
        if "function" in tree and ":" in tree["function"]:
            yield tree["function"]
        for part in tree.values():
            yield from _functions(part)
    elif isinstance(tree, list):
        for part in tree:
            yield from _functions(part)
