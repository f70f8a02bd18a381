"""`lcpstep thesis`: the figures of the thesis into a folder."""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from typing import Any

from lcpstep.cli import interrupt
from lcpstep.cli.common import DONE, say
from lcpstep.cli.studies import work_bar
from lcpstep.errors import UnknownName
from lcpstep.pace import counted
from lcpstep.thesis import FIGURES, make
from lcpstep.thesis.page import write_page


def add(commands: Any) -> None:
    """Arguments of the command."""
    p = commands.add_parser(
        "thesis",
        help="make the figures of the thesis: PNG, SVG, and the data",
        description="Makes figures of G. Osorio, Complex Behavior in Impacting Systems, into a folder, as PNG and "
        "SVG, each with its data; all of them where none is named.",
        epilog="Example: lcpstep thesis 3.6 4.5 --out figures. Figures: " + ", ".join(FIGURES),
    )
    p.add_argument("figures", nargs="*", metavar="FIGURE", help="numbers; see --list (all)")
    p.add_argument(
        "--list", action="store_true", help="list the figures, and the commands that make them by hand"
    )
    p.add_argument(
        "--out", type=Path, default=Path("thesis"), metavar="DIR", help="where the files go (thesis)"
    )
    p.add_argument("--overwrite", action="store_true", help="write over files that exist")
    p.add_argument(
        "--page", type=Path, metavar="FILE", help="write the page of all figures and numbers (Markdown)"
    )
    p.set_defaults(run=run_thesis)


def run_thesis(options: argparse.Namespace) -> int:
    """`lcpstep thesis`."""
    if options.list:
        for name, figure in FIGURES.items():
            print(f"{name:12} {figure.about}" + (f"   [{figure.command}]" if figure.command else ""))
        return DONE
    if options.page is not None:
        if options.page.exists() and not options.overwrite:
            raise FileExistsError(f"--page: {options.page} exists already; --overwrite replaces it")
        with work_bar("numbers") as name_stage:

            def told(name: str) -> None:
                name_stage(f"figure {name}")
                say(name)

            write_page(options.page, told)
        print(f"wrote {options.page}")
        return DONE
    wanted = options.figures or list(FIGURES)
    for name in wanted:  # before any work starts
        if name not in FIGURES:
            raise UnknownName("figure of the thesis", name, FIGURES)
    finished: list[Path] = []
    rest = list(wanted)
    goes_on = ["--out", str(options.out), *(["--overwrite"] if options.overwrite else [])]
    interrupt.keeps(options, lambda: ", ".join(map(str, finished)), lambda: ["thesis", *rest, *goes_on])
    with work_bar("figures") as name_stage:
        for name in counted(wanted):
            name_stage(f"figure {name}")
            start = time.perf_counter()
            files = make(name, options.out, options.overwrite)
            finished += files
            rest.remove(name)
            shown = ", ".join(file.name for file in files)
            say(f"{name:12} {time.perf_counter() - start:6.1f} s   {shown}")
    return DONE
