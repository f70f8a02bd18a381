"""Every direct dependency at its lower bound in pyproject.toml, one requirement a line, for pip.

python3 .ci/lowest.py test solvers     those of the package, and of the extras named
"""

import re
import sys
import tomllib
from pathlib import Path

PROJECT = Path(__file__).resolve().parent.parent / "pyproject.toml"


def lowest(extras: list[str]) -> list[str]:
    """The package's dependencies and those of its extras, each once, with == in the place of >=."""
    project = tomllib.loads(PROJECT.read_text())["project"]
    named = project["optional-dependencies"]
    bounds = [*project["dependencies"], *(bound for extra in extras for bound in named[extra])]
    return sorted({pinned(bound) for bound in bounds})


def pinned(bound: str) -> str:
    """A requirement at its lower bound; anything but NAME>=VERSION has none and is an error."""
    found = re.fullmatch(r"([A-Za-z0-9_.-]+)>=([0-9.]+)", bound)
    if found is None:
        sys.exit(f"pyproject.toml: expected NAME>=VERSION, got {bound!r}")
    return f"{found[1]}=={found[2]}"


if __name__ == "__main__":
    print("\n".join(lowest(sys.argv[1:])))
