"""An environment with every direct dependency at its lower bound in pyproject.toml: .venv-lowest.

python3 .ci/lowest.py
"""

import re
import sys
import tomllib
import venv
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))
import start  # noqa: E402  (the file beside the project, which knows how to find a pip)

EXTRAS = ("solvers", "symbolic", "cluster", "proofs", "explore", "fmu")  # not mpi, which needs an MPI library
TOOLS = {"pytest", "pytest-xdist", "hypothesis", "mpmath"}  # of the extra `test`, what the tests here run by


def lowest() -> list[str]:
    """The dependencies of the package and of its extras, and tools of tests, each once, with == in place of >=."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    named = project["optional-dependencies"]
    tools = [bound for bound in named["test"] if bound.partition(">=")[0] in TOOLS]
    bounds = [*project["dependencies"], *tools, *(bound for extra in EXTRAS for bound in named[extra])]
    return sorted({pinned(bound) for bound in bounds})


def pinned(bound: str) -> str:
    """A requirement at its lower bound; anything but NAME>=VERSION has none and is an error."""
    found = re.fullmatch(r"([A-Za-z0-9_.-]+)>=([0-9.]+)", bound)
    if found is None:
        sys.exit(f"pyproject.toml: expected NAME>=VERSION, got {bound!r}")
    return f"{found[1]}=={found[2]}"


def set_up(environment: Path) -> None:
    """Make the environment afresh, of dependencies alone: tests find the project as it is built beside them."""
    start.ENVIRONMENT = environment
    start.BIN = environment / start.BIN.name
    venv.create(environment, clear=True)
    with start.uv_for_now() as uv:
        start.install(uv, *lowest())


if __name__ == "__main__":
    set_up(ROOT / ".venv-lowest")
