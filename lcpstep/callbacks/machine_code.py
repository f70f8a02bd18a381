"""Machine code of users' functions kept on disk, so that each is compiled once per machine.

An entry is a file: a checksum, and what numba makes of a compiled function. Its name carries all that the machine
code depends on (`fingerprint`), the types of its arguments, the processor and the versions of what compiled it; so no
entry is ever out of date, and whoever may read one may use it. An entry that is damaged is noticed by its checksum,
before any of it is run or unpickled, and made again. Where no folder takes an entry, machine code lasts as long as
the process, which is said once.

The folders, in the order in which they are tried: `NUMBA_CACHE_DIR` where that is set, otherwise `__pycache__` beside
the source and the user's cache folder; then one in the system's folder for temporary files that only this user may
enter. This module is imported when the first function is compiled or loaded.
"""

from __future__ import annotations

import hashlib
import logging
import os
import pickle
import stat
import sys
import tempfile
from functools import cache
from pathlib import Path
from types import FunctionType
from typing import Any

import llvmlite
import numba
import numpy as np
from numba.core.compiler import CompileResult
from numba.core.serialize import dumps
from numba.misc.appdirs import AppDirs

from lcpstep.errors import NotWritten
from lcpstep.files import replacing

LOG = logging.getLogger(__name__)
HEAD = b"lcpstep machine code\n"
CHECKSUM = hashlib.sha256().digest_size
DIGITS = 20  # of the digest in a name
LONGEST = 80  # characters of a function's name in that of its entry
ENDING = ".kernel"
PRIVATE = 0o700
TOLD: list[str] = []  # what was said of that in this process
HARMLESS = ("NUMBA_CACHE_DIR", "NUMBA_NUM_THREADS")
SHARED = 0o077  # permissions of others


class OnDisk:
    """The entries of one compiled function; takes the place of numba's own cache.

    Parameters
    ----------
    f : function to be compiled, its qualified name carrying the fingerprint of all that it depends on
    """

    def __init__(self, f: FunctionType) -> None:
        self.f = f
        self.source = Path(f.__code__.co_filename)

    @property
    def cache_path(self) -> str:
        """The folder that is tried first."""
        return str(next(iter(folders(self.source)), ""))

    def load_overload(self, signature: Any, target: Any) -> Any:
        """Machine code for these types of arguments; None where it is not kept."""
        target.refresh()
        name = self.entry(signature, target.codegen())
        owners = {0, own_number(), *([self.source.stat().st_uid] if self.source.exists() else [])}
        for folder in [*folders(self.source), *temporary(make=False)]:
            payload = read(folder / name, owners)
            if payload is not None:
                return CompileResult._rebuild(target, *payload)
        return None

    def save_overload(self, signature: Any, result: Any) -> None:
        """Keep machine code in the first folder that takes it."""
        if result.library.has_dynamic_globals:  # addresses that are good in this process only
            return
        name, content = self.entry(signature, result.codegen), packed(result._reduce())
        failures: list[str] = []
        if written(folders(self.source), name, content, failures) is None:
            folder = written(temporary(make=True), name, content, failures)
            tell_once("each process compiles anew" if folder is None else f"{folder} takes it", failures)

    def entry(self, signature: Any, codegen: Any) -> str:
        """Name of the file for these types of arguments."""
        depends = (self.f.__qualname__, str(signature), codegen.magic_tuple())
        digest = hashlib.sha256(f"{depends} {toolchain()}".encode()).hexdigest()[:DIGITS]
        name = "".join(c if c.isalnum() or c in "._" else "" for c in self.title)
        return f"{name[-LONGEST:]}-{digest}{ENDING}"

    @property
    def title(self) -> str:
        """The function's own name."""
        return f"{self.f.__globals__.get('__name__')}.{self.f.__qualname__.rpartition('_')[0]}"


def folders(source: Path) -> list[Path]:
    """Where entries of functions from a source file may lie, the best first."""
    if numba.config.CACHE_DIR:
        return [Path(numba.config.CACHE_DIR)]
    user = Path(AppDirs("lcpstep", appauthor=False).user_cache_dir) / "kernels"
    beside = [source.absolute().parent / "__pycache__"] if source.exists() else []  # a file, not a terminal
    return [*beside, *([user] if user.is_absolute() else [])]


def temporary(make: bool) -> list[Path]:
    """The folder for temporary files that this user alone may enter; none where there is no such."""
    try:
        folder = Path(tempfile.gettempdir()) / f"lcpstep-{own_number()}"
        if make:
            folder.mkdir(mode=PRIVATE, exist_ok=True)
        found = folder.lstat()
    except OSError:
        return []
    mine = stat.S_ISDIR(found.st_mode) and found.st_uid == own_number() and not found.st_mode & SHARED
    return [folder] if mine or os.name == "nt" else []


def own_number() -> int:
    """Of the user, on systems that count them."""
    return os.getuid() if hasattr(os, "getuid") else 0


def written(places: list[Path], name: str, content: bytes, failures: list[str]) -> Path | None:
    """The first of the folders that takes an entry; why the others before it did not."""
    for folder in places:
        try:
            with replacing(folder / name) as draft:
                draft.write_bytes(content)
            return folder
        except NotWritten as error:
            failures.append(f"{folder}: {error.reason}")
    return None


def packed(payload: Any) -> bytes:
    """An entry of what numba makes of a compiled function."""
    body = dumps(payload)
    return HEAD + hashlib.sha256(body).digest() + body


def read(file: Path, owners: set[int]) -> Any:
    """What `packed` was given; None where there is no entry, a damaged one, or one of somebody else."""
    try:
        with file.open("rb") as stream:
            if os.fstat(stream.fileno()).st_uid not in owners:
                return None
            content = stream.read()
    except OSError:
        return None
    body = content[len(HEAD) + CHECKSUM :]
    if content[: len(HEAD) + CHECKSUM] != HEAD + hashlib.sha256(body).digest():
        LOG.warning("%s is damaged and is compiled again", file)
        return None
    return pickle.loads(body)


@cache
def toolchain() -> str:
    """What turns a function into machine code, as a text that changes with it."""
    names = ("fingerprint", "guarded", "integers", "unchecked", "writing")
    own = [Path(__file__).with_name(f"{name}.py").read_bytes() for name in names]
    versions = [sys.implementation.cache_tag, numba.__version__, llvmlite.__version__, np.__version__]
    settings = {k: v for k, v in os.environ.items() if k.startswith("NUMBA_") and k not in HARMLESS}
    return f"{versions} {sorted(settings.items())} {hashlib.sha256(b''.join(own)).hexdigest()}"


def tell_once(what: str, failures: list[str]) -> None:
    """Say that the usual folders take nothing; once per process, and not for every function."""
    if not TOLD:
        TOLD.append(what)
        LOG.warning("machine code cannot be kept where it belongs: %s (%s)", what, "; ".join(failures))
