"""What compiling costs: the first process on a machine, every later one, and a scene never seen before."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from statistics import median
from typing import Any

from benchmarks.stepping.timing import Timing

HERE = Path(__file__).parent
ROOT = HERE.parent.parent
IMPORTS = {"python alone": "pass", "import numpy": "import numpy", "import lcpstep": "import lcpstep"}


def imports(rounds: int) -> dict[str, dict[str, float]]:
    """Wall time of whole processes that import something and end, in turns [s]."""
    seconds: dict[str, list[float]] = {name: [] for name in IMPORTS}
    for _ in range(rounds + 1):
        for name, code in IMPORTS.items():
            begin = time.perf_counter()
            subprocess.run([sys.executable, "-c", code], check=True, cwd=ROOT)
            seconds[name].append(time.perf_counter() - begin)
    return {name: Timing(tuple(times[1:])).per(1) for name, times in seconds.items()}


def processes(rounds: int) -> dict[str, dict[str, float]]:
    """Seconds of each call: with an empty cache; with a full one and new user scenes; with everything seen."""
    with tempfile.TemporaryDirectory() as folder:
        cold = one_process(folder, "first")
        new = [one_process(folder, f"new_{k}") for k in range(rounds)]
        seen = [one_process(folder, "first") for _ in range(rounds)]
    return {"cold": cold, "new scene": medians(new), "warm": medians(seen)}


def one_process(folder: str, name: str) -> dict[str, float]:
    """A fresh process; the user's file is one that the cache knows by its name, or does not."""
    user = Path(folder) / f"{name}.py"
    if not user.exists():
        shutil.copy(HERE / "user_scene.py", user)
    command = [sys.executable, "-m", "benchmarks.stepping.one_process", str(user)]
    environment = os.environ | {"NUMBA_CACHE_DIR": str(Path(folder) / "cache")}
    run = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, cwd=ROOT, env=environment)
    result: dict[str, float] = json.loads(run.stdout.splitlines()[-1])
    return result


def medians(runs: list[dict[str, float]]) -> dict[str, float]:
    return {name: median(run[name] for run in runs) for name in runs[0]}


def first_use(rounds: int) -> dict[str, Any]:
    return {"imports": imports(rounds), "calls": processes(rounds)}
