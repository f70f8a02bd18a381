"""`lcpstep scenes`: the catalogue, what moves, what usually goes wrong, and the parameters."""

from __future__ import annotations

import argparse
import json
from typing import Any

from lagrangian.scenes import SCENES
from lcpstep.cli.common import DONE


def add(commands: Any) -> None:
    """Arguments of the command."""
    listing = commands.add_parser(
        "scenes", help="list the scenes: what moves, what usually goes wrong, parameters"
    )
    listing.add_argument("--json", action="store_true", help="print JSON")
    listing.set_defaults(run=run_scenes)


def run_scenes(options: argparse.Namespace) -> int:
    """`lcpstep scenes`."""
    lines: list[dict[str, Any]] = [
        {
            "scene": name,
            "about": entry.about,
            "hazard": entry.hazard,
            "answer": entry.answer,
            "parameters": entry.parameters,
        }
        for name, entry in SCENES.items()
    ]
    if options.json:
        print(json.dumps(lines, indent=2))
        return DONE
    for line in lines:
        print(f"{line['scene']:20} {line['about']}")
        print(" " * 21 + f"wrong: {line['hazard']}")
        print(" " * 21 + ", ".join(f"{k}={v}" for k, v in line["parameters"].items()))
    return DONE
