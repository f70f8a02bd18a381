"""Kernels in C, written by Cython, which reads each header once for all of them.

`cythonize` reads the headers that a module names, and those that these name, anew for each module: three quarters of
its time. Here one process reads all, and forks for each module, so that nothing that the translation of one does to
them is seen by the next. A header also marks what it names of others as used, which has every module that knows them
import it; who marks what is noted, and a module finds the marks of its own headers alone. So it becomes the very C
that `cythonize` makes of it.
"""

from __future__ import annotations

import gc
import os
import sys
import traceback
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from Cython.Compiler import Errors
from Cython.Compiler.Main import CompilationOptions, Context, compile_single, default_options


class Headers(Context):
    """Cython's state, with the headers that have been read.

    marks    by the name of a header: what it has marked as used
    reader   the header that is read now
    """

    def __init__(self, directives: dict[str, Any]) -> None:
        options = CompilationOptions(default_options, compiler_directives=directives, include_path=["."])
        options.configure_language_defaults("py")
        super().__init__(
            options.include_path, options.compiler_directives, options.cplus, options.language_level, options
        )
        Errors.init_thread()
        self.marks: dict[str, list[Any]] = {"": []}
        self.reader = ""

    def process_pxd(self, source_desc: Any, scope: Any, module_name: str) -> Any:
        """Read a header; those that it names are read while this goes on."""
        self.note_marks()
        outer, self.reader = self.reader, module_name
        self.marks[module_name] = []
        result = super().process_pxd(source_desc, scope, module_name)
        self.note_marks()
        self.reader = outer
        return result

    def note_marks(self) -> None:
        """Take the marks away that the header at hand has made."""
        for name, scope in self.modules.items():
            if name not in ("__builtin__", "builtins", "cython"):
                for entry in entries(scope):
                    if entry.used:
                        self.marks[self.reader].append(entry)
                        entry.used = 0

    def see(self, name: str) -> None:
        """Know the headers of a module alone, in the order in which it would have them read."""
        read, self.pxds = self.pxds, {}
        for header in known(self.find_module(name, need_pxd=0), set()):
            if header in read:
                self.pxds[header] = read[header]
            for entry in self.marks.get(header, ()):
                entry.used = 1


def entries(scope: Any) -> Iterator[Any]:
    """What a module declares, what its classes do, and what the modules of a package."""
    for entry in scope.entries.values():
        yield entry
        if entry.is_type and entry.type.is_extension_type and entry.type.scope is not None:
            yield from entry.type.scope.entries.values()
    for module in scope.module_entries.values():
        yield from entries(module)


def known(scope: Any, seen: set[Any]) -> Iterator[str]:
    """Names of the headers that a module names, each after those that it names itself, and its own."""
    seen.add(scope)
    for other in scope.cimported_modules:
        if other not in seen:
            yield from known(other, seen)
    yield scope.qualified_name


def translate(sources: dict[str, tuple[str, str]], directives: dict[str, Any], processes: int) -> list[str]:
    """Translate modules, given by name as source and C file; names of those that this did not do.

    Another Cython may be another within: whatever goes wrong is left to `cythonize`, which says what it is.
    """
    try:
        headers = Headers(directives)
        for name in sources:
            headers.find_module(name, need_pxd=0)
    except Exception:
        return list(sources)
    gc.collect()
    gc.freeze()
    running, left = dict[int, str](), list[str]()
    for k, (name, (source, target)) in enumerate(sources.items()):
        if len(running) == processes:
            left += ended(running)
        print(f"[{k + 1}/{len(sources)}] Cythonizing {source}", flush=True)
        Path(target).parent.mkdir(parents=True, exist_ok=True)
        process = os.fork()
        if process == 0:
            os._exit(translated(headers, name, source, target))
        running[process] = name
    while running:
        left += ended(running)
    return left


def ended(running: dict[int, str]) -> list[str]:
    """Wait for one of the processes; the name of its module where that was not done."""
    process, status = os.wait()
    name = running.pop(process)
    return [name] if status != 0 else []


def translated(headers: Headers, name: str, source: str, target: str) -> int:
    """Translate one module in a process of its own; 0 where that was done."""
    gc.disable()
    try:
        headers.see(name)
        headers.options.output_file = target
        return min(1, compile_single(source, headers.options, name, context=headers).num_errors)
    except BaseException:
        traceback.print_exc(file=sys.stderr)
        return 1
