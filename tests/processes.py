"""Fresh interpreters."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import lcpstep

ROOT = Path(lcpstep.__file__).parents[1]


def environment(**more: str) -> dict[str, str]:
    """Of a fresh interpreter that finds this library."""
    return {**os.environ, "PYTHONPATH": str(ROOT), **more}


def python(program: str, *, cwd: Path | None = None, **variables: str) -> str:
    """What the program prints in a fresh interpreter with these variables; it must succeed."""
    done = subprocess.run(
        [sys.executable, "-c", program],
        env=environment(**variables),
        cwd=cwd or ROOT, capture_output=True, text=True, timeout=300, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()
