"""The command `lcpstep` as a process: a Ctrl-C while it still loads its modules is answered as any later one is."""

from __future__ import annotations

import os
import shlex
import signal
import sys
from types import FrameType

INTERRUPTED = 130  # exit status


def run() -> None:
    """Load the command line, which takes most of a second, and carry out what was typed."""
    signal.signal(signal.SIGINT, loading)
    from lcpstep.cli import command

    command()


def loading(number: int, frame: FrameType | None) -> None:
    """Nothing has begun yet: say so, and end at once, for modules that are half loaded can clean up nothing."""
    again = shlex.join(["lcpstep", *sys.argv[1:]])
    said = f"lcpstep: interrupted\nlcpstep: kept: nothing\nlcpstep: start again with: {again}\n"
    os.write(2, said.encode())
    os._exit(INTERRUPTED)
