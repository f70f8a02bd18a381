"""Users' functions f(t, q, v, p, out): in machine code where they can be, in Python where not, and what goes wrong.

compiling, guarded, integers, writing, unchecked
                          machine code in which indices are checked and exceptions noted; numba's side of it
built, machine_code       what was compiled before: with the library, and on disk; `fingerprint` tells one by
functions, fingerprint    what a function is made of, as a text
prepared                  functions as Python asks them between runs
faults, culprits          exceptions that functions have raised; which of a scene's callbacks has stopped a run
hearing                   interrupts of the keyboard while functions in Python are called by C
"""

from __future__ import annotations

import os


class UncompiledCallback(UserWarning):
    """A user's function that numba cannot compile; it runs in plain Python, some hundred times slower."""


class NotCompiled(Exception):
    """Why, and where: file and line."""

    def __init__(self, reason: str, file: str, line: int) -> None:
        super().__init__(reason)
        self.reason, self.file, self.line = reason, file, line

    def __str__(self) -> str:
        return f"{self.reason} ({os.path.basename(self.file)}, line {self.line})"


class NoCompiler(NotCompiled):
    """Numba cannot be imported."""
