"""`lcpstep scenes`: the catalogue, one line a scene."""

from __future__ import annotations

import argparse
import inspect
import json
from typing import Any

from lagrangian.scenes import CATALOGUE
from lcpstep.cli.common import DONE, defaults


def add(commands: Any) -> None:
    """Arguments of the command."""
    listing = commands.add_parser("scenes", help="list the scenes, one line each, with their parameters")
    listing.add_argument("--json", action="store_true", help="print JSON")
    listing.set_defaults(run=run_scenes)


def run_scenes(options: argparse.Namespace) -> int:
    """`lcpstep scenes`."""
    lines: list[dict[str, Any]] = [
        {"scene": name, "about": (inspect.getdoc(make) or "").splitlines()[0], "parameters": defaults(make)}
        for name, make in CATALOGUE.items()
    ]
    if options.json:
        print(json.dumps(lines, indent=2))
        return DONE
    for line in lines:
        print(f"{line['scene']:20} {line['about']}")
        print(" " * 21 + ", ".join(f"{k}={v}" for k, v in line["parameters"].items()))
    return DONE
