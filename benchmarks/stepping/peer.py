"""Siconos as a contestant: a worker under a Python that has it, and its forces compiled as a C plugin."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

HERE = Path(__file__).parent
COMPILE = ("-O3", "-march=native", "-shared", "-fPIC")


class Siconos:
    """A process that answers one request after another; see `peer_worker`."""

    def __init__(self, python: str, folder: Path) -> None:
        self.folder, self.plugin = folder, folder / "forces.so"
        subprocess.run(["gcc", *COMPILE, HERE / "forces.c", "-o", self.plugin, "-lm"], check=True)
        self.process = subprocess.Popen(
            [python, HERE / "peer_worker.py"], text=True, cwd=folder,
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
        )  # fmt: skip
        self.version = self.ask(scene=None)["version"]

    def ask(self, **request: Any) -> dict[str, Any]:
        """The worker's answer; {"error": ...} where Siconos raised something, or died of it."""
        pipes = self.process.stdin, self.process.stdout
        if pipes[0] is None or pipes[1] is None:
            raise RuntimeError("the worker has no pipes")
        pipes[0].write(json.dumps(request | {"plugin": str(self.plugin)}) + "\n")
        pipes[0].flush()
        line = pipes[1].readline()
        return json.loads(line) if line else {"error": "the process ended"}

    def timed(self, **request: Any) -> Callable[[], float]:
        """A contestant for `timing.take_turns`."""

        def run() -> float:
            answer = self.ask(**request)
            return float(answer["seconds"]) if "seconds" in answer else float("nan")

        return run

    def motion(self, **request: Any) -> NDArray[np.float64] | str:
        """Rows (t, q, v) of a run, or what went wrong."""
        path = self.folder / "motion.npy"
        answer = self.ask(save=str(path), **request)
        return answer["error"] if "error" in answer else np.load(path)

    def close(self) -> None:
        """End the worker."""
        if self.process.stdin is not None:
            self.process.stdin.close()
        self.process.wait()


def find(python: str | None) -> str | None:
    """A Python that imports Siconos: the one named, the one on the path, or the system's; None also without gcc."""
    if shutil.which("gcc") is None:
        return None
    for candidate in [python] if python else [sys.executable, shutil.which("python3"), "/usr/bin/python3"]:
        if candidate and _imports_siconos(candidate):
            return candidate
    return None


def _imports_siconos(python: str) -> bool:
    clean = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    try:
        run = subprocess.run([python, "-c", "import siconos.kernel"], capture_output=True, env=clean)
    except OSError:
        return False
    return run.returncode == 0
