"""Ctrl-C in a command: it ends within about a second, says what was kept and how to go on; exit status 130.

Loops return to Python every tenth of a second (`lcpstep.pace`); there the interrupt is raised and ends them, and the
command saves what it has. What does not return is the compiler at work, or one long call of a foreign library. These
let other threads run, and one that watches ends the process where the command does not answer. A second Ctrl-C ends
it at once, whatever it is about to save.
"""

from __future__ import annotations

import _thread
import argparse
import os
import shlex
import signal
import socket
import sys
import threading
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from lcpstep import files

INTERRUPTED = 130  # exit status
PATIENCE = 0.6  # until the interrupt has ended what was under way [s]
COLLECTING = 10.0  # until what was computed has been put together, where it has ended it [s]
ENDING = 0.3  # of the interpreter, when the command has ended [s]
LATER = 0.02  # is an interrupt raised again that was raised where nothing hears it [s]
_answered, _over = threading.Event(), threading.Event()
_options = argparse.Namespace()
_written: list[Path] = []


def begin(options: argparse.Namespace, words: Sequence[str]) -> None:
    """A command begins: its options, and the words after `lcpstep` that were typed."""
    global _options
    _options, options.words = options, list(words)
    options.kept = options.go_on = None
    _written.clear()


def wrote(file: Path) -> None:
    """The command has written a file, which an interrupt leaves."""
    _written.append(file)


def keeps(
    options: argparse.Namespace, kept: Callable[[], str], go_on: Callable[[], list[str]] | None = None
) -> None:
    """What is kept of a command that is interrupted from now on, and the words of the one that goes on from there.

    Where this is not called these are the files that were written, and the same command, which starts again.
    """
    options.kept, options.go_on = kept, go_on or (lambda: list(options.words))


def answer() -> None:
    """The command has been interrupted and is about to save what there is."""
    _answered.set()


def report(stopped: BaseException | None = None) -> int:
    """Say how the command ended, what was kept, and how to go on; the exit status."""
    answer()
    motion = vars(stopped).get("trajectory") if stopped is not None else None  # if anybody has asked for it
    print(f"lcpstep: {'interrupted' if motion is None else motion.message}", file=sys.stderr)
    for line in _words(_options):
        print(f"lcpstep: {line}", file=sys.stderr)
    return INTERRUPTED


def _words(options: argparse.Namespace) -> list[str]:
    kept = options.kept() if options.kept else ", ".join(map(str, _written))
    verb, words = "start again with", list(options.words)
    if options.kept and kept:
        verb, words = "go on with", options.go_on()
    elif kept and getattr(options, "overwrite", True) is False:
        words.append("--overwrite")
    return [f"kept: {kept or 'nothing'}", f"{verb}: {shlex.join(['lcpstep', *words])}"]


def ending(main: Callable[[], int]) -> int:
    """Run a command that ends about a second after a Ctrl-C, whatever it is doing; only for a process of its own."""
    reader, writer = socket.socketpair()
    writer.setblocking(False)
    signal.set_wakeup_fd(writer.fileno(), warn_on_full_buffer=False)
    signal.signal(signal.SIGINT, _first)
    sys.unraisablehook = _unheard
    threading.Thread(target=_attend, args=(reader, writer), daemon=True).start()
    status = main()
    _over.set()
    return status


def _first(number: int, frame: Any) -> None:
    """The first interrupt is raised, as Python does it; the second finds another answer."""
    signal.signal(number, _second)
    raise KeyboardInterrupt


def _unheard(raised: Any) -> None:
    """Python drops what is raised in a finalizer, with a traceback: an interrupt is raised again after it."""
    if not issubclass(raised.exc_type, KeyboardInterrupt):
        sys.__unraisablehook__(raised)
        return
    signal.signal(signal.SIGINT, _first)
    again = threading.Timer(LATER, _thread.interrupt_main)
    again.daemon = True
    again.start()


def _second(number: int, frame: Any) -> None:
    """The second ends the process, in the midst of what answers the first."""
    os.write(2, b"lcpstep: interrupted again: nothing more is saved\n")
    for draft in list(files.DRAFTS):
        draft.unlink(missing_ok=True)
    os._exit(INTERRUPTED)


def _raised() -> bool:
    """Whether the main thread is dealing with the interrupt: it may also have been raised where nothing hears it."""
    now: Any = sys._current_exceptions().get(threading.main_thread().ident or 0)
    return isinstance(now[1] if isinstance(now, tuple) else now, KeyboardInterrupt)


def _attend(reader: socket.socket, writer: socket.socket) -> None:
    """In a thread of its own: wait for an interrupt, and see that it ends the process."""
    while signal.SIGINT not in reader.recv(64):
        pass
    if _answered.wait(PATIENCE) or (_raised() and _answered.wait(COLLECTING)):
        _over.wait()
        time.sleep(ENDING)
    else:
        report()
    for draft in list(files.DRAFTS):
        draft.unlink(missing_ok=True)
    for stream in (sys.stdout, sys.stderr):
        with suppress(OSError, ValueError):  # nobody reads it any more
            stream.flush()
    os._exit(INTERRUPTED)
