"""The command `lcpstep`, one module a command.

Exit status: 0 done; 1 a run ended early, or lies deep inside an obstacle, and says so; 2 a wrong argument; 130
interrupted.
"""

from __future__ import annotations

import argparse
import errno
import os
import re
import sys
from collections.abc import Sequence
from typing import Any

from lcpstep import __version__
from lcpstep.cli import abs as abs_
from lcpstep.cli import (
    attractor,
    basin,
    bifurcation,
    compare,
    corner,
    explore,
    hard,
    interrupt,
    lyapunov,
    maps,
    new,
    orbit,
    run,
    scenes,
    simulate,
    study,
    thesis,
)
from lcpstep.cli.common import FAILED, INTERRUPTED, USAGE
from lcpstep.errors import LcpStepError, NotWritten, SimulationError

COMMANDS = (
    compare,
    simulate,
    scenes,
    new,
    explore,
    study,
    run,
    hard,
    attractor,
    bifurcation,
    basin,
    orbit,
    lyapunov,
    corner,
    maps,
    abs_,
    thesis,
)
NO_SPACE = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO, None}  # None: a library that does not say why


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit status."""
    options = parser().parse_args(arguments)
    interrupt.begin(options, sys.argv[1:] if arguments is None else arguments)
    try:
        status = int(options.run(options))
        return interrupt.report() if status == INTERRUPTED else status
    except KeyboardInterrupt as stopped:
        return interrupt.report(stopped)
    except SimulationError as error:
        print(f"lcpstep: {error}", file=sys.stderr)
        return FAILED
    except BrokenPipeError:  # who read what is printed has seen enough, as `head`
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return FAILED
    except NotWritten as error:
        print(f"lcpstep: {error}", file=sys.stderr)
        return FAILED if error.code in NO_SPACE else USAGE
    except (LcpStepError, ValueError, OSError) as error:
        print(f"lcpstep: {_said(error)}", file=sys.stderr)
        return USAGE


def _said(error: Exception) -> str:
    """An error in words; of the system's own, such as a folder that cannot be made, without its number."""
    if isinstance(error, PermissionError) and error.filename is not None:
        return (
            f"{error.filename}: {error.strerror}; choose another place, or ask for the right to write there"
        )
    if isinstance(error, OSError) and error.filename is not None:
        return f"{error.filename}: {error.strerror}"
    return str(error)


def command() -> None:
    """The command as a process of its own: any Ctrl-C ends it within about a second."""
    sys.exit(interrupt.ending(main))


class _Parser(argparse.ArgumentParser):
    """To which -4e-7 is a number, as it is to argparse itself from Python 3.14 on, and no option."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self._negative_number_matcher = re.compile(r"-\.?\d")

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Of a command: it says itself what it does not know, and so what it does."""
        found, unknown = super().parse_known_args(args, namespace)
        if unknown:
            self.error(f"unrecognized arguments: {' '.join(unknown)}")
        return found, unknown


def parser() -> argparse.ArgumentParser:
    """Arguments of the command line."""
    top = _Parser(
        prog="lcpstep",
        description="Mechanical systems with impacts: time-stepping and event-driven simulation.",
        epilog="Start with: lcpstep compare cam-follower",
    )
    top.add_argument("--version", action="version", version=f"lcpstep {__version__}")
    commands = top.add_subparsers(required=True, metavar="COMMAND")
    for command in COMMANDS:
        command.add(commands)
    return top
