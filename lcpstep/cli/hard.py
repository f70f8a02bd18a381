"""`lcpstep hard`: the hard cases by every method that fits, as a table, JSON or Markdown."""

from __future__ import annotations

import argparse
import json
from typing import Any

from lagrangian.scenes import CATALOGUE
from lcpstep.cli import interrupt
from lcpstep.cli.common import DONE, FAILED, say
from lcpstep.cli.studies import work_bar
from lcpstep.hard import METHODS, Row, table
from lcpstep.hard.report import line, markdown, summary


def add(commands: Any) -> None:
    """Arguments of the command."""
    p = commands.add_parser(
        "hard",
        help="run the hard cases and say which methods pass",
        description="Runs the scenes of the catalogue by every method that fits and compares with their known "
        "answers: passed, failed (how far off), or refused. Exit status 1 where a check failed.",
        epilog="Example: lcpstep hard --scene bouncing-ball elastic-gas --method event-driven",
    )
    p.add_argument(
        "--scene",
        nargs="+",
        action="extend",
        default=[],
        metavar="SCENE",
        help="only these (see: lcpstep scenes)",
    )
    p.add_argument(
        "--method",
        nargs="+",
        action="extend",
        default=[],
        metavar="METHOD",
        help=f"only these of: {', '.join(METHODS)}",
    )
    p.add_argument("--full", action="store_true", help="the heavy checks too; takes minutes")
    p.add_argument(
        "--error",
        action="store_true",
        help="error bars of the runs, which tell what the errors are without the answer; a run more each",
    )
    form = p.add_mutually_exclusive_group()
    form.add_argument("--json", action="store_true", help="print JSON")
    form.add_argument("--markdown", action="store_true", help="print the page docs/hard-cases.md")
    p.set_defaults(run=run_hard)


def run_hard(options: argparse.Namespace) -> int:
    """`lcpstep hard`."""
    plain = not (options.json or options.markdown)

    shown: list[str] = []

    def kept() -> str:
        return f"the {len(shown)} lines above" if shown and plain else ""

    interrupt.keeps(options, kept, lambda: _rest(options, shown[-1]))
    with work_bar("checks") as name_stage:

        def show(row: Row) -> None:
            shown.append(row.scene)
            name_stage(row.scene)
            if plain:
                say(line(row))

        rows = table(options.scene, options.method, options.full, show, options.error)
    if options.json:
        print(json.dumps([row.as_json() for row in rows], indent=2))
    elif options.markdown:
        print(markdown(rows))
    else:
        print(summary(rows))
    return FAILED if any(row.outcome == "failed" for row in rows) else DONE


def _rest(options: argparse.Namespace, last: str) -> list[str]:
    """The words of the command for the scenes from the last one on."""
    names = list(CATALOGUE)
    rest = [name for name in names[names.index(last) :] if not options.scene or name in options.scene]
    more = ["--method", *options.method] if options.method else []
    return ["hard", "--scene", *rest, *more, *(f"--{x}" for x in ("full", "error") if getattr(options, x))]
