"""What can go wrong, by name. A wrong question raises; an honest "no" of a method is a status."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Iterable
from functools import cached_property
from typing import Any


class Pickled:
    """Base of exceptions that can be pickled, whatever the arguments of their class: message and attributes."""

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, (type(self), self.args, vars(self))  # type: ignore[attr-defined]


def _again(cls: type[BaseException], args: tuple[Any, ...], attributes: dict[str, Any]) -> BaseException:
    """An exception as it was pickled."""
    error = cls.__new__(cls, *args)
    error.args = args
    for name, value in attributes.items():
        setattr(error, name, value)
    return error


class LcpStepError(Pickled, Exception):
    """Base class of the library's errors."""


class UnknownName(LcpStepError, ValueError):
    """A scene, method or solver that does not exist; the near ones are suggested."""

    def __init__(self, what: str, name: object, known: Iterable[str]) -> None:
        known = sorted(known)
        near = difflib.get_close_matches(str(name), known, n=3, cutoff=0.5)
        hint = f"did you mean {' or '.join(map(repr, near))}?" if near else f"known: {', '.join(known)}"
        super().__init__(f"unknown {what} {name!r}; {hint}")


class MissingSolver(LcpStepError, ImportError):
    """A solver that exists but is not installed; the message carries the command that installs it."""


class SimulationError(LcpStepError):
    """A run that had to stop, with the part of the motion that was computed before.

    Attributes
    ----------
    trajectory : Trajectory   everything up to the failure
    """

    def __init__(self, message: str, trajectory: Any) -> None:
        super().__init__(message)
        self.trajectory = trajectory


class SimulationInterrupted(Pickled, KeyboardInterrupt):
    """The user's interrupt, with the part of the motion that was computed before in `trajectory`.

    `collect()` puts it together, which takes a while where it is long: when somebody asks for it.
    """

    def __init__(self, collect: Callable[[], Any]) -> None:
        super().__init__("interrupted; the motion so far is in the attribute `trajectory`")
        self.collect: Callable[[], Any] | None = collect

    @cached_property
    def trajectory(self) -> Any:
        """Everything up to the interrupt."""
        found, self.collect = self.collect() if self.collect else None, None
        return found

    def __reduce__(self) -> tuple[Any, ...]:
        _ = self.trajectory
        return super().__reduce__()


class StudyInterrupted(Pickled, KeyboardInterrupt):
    """The user's interrupt of a study, with everything measured before in `study`."""

    def __init__(self, study: Any) -> None:
        super().__init__("interrupted; what was measured so far is in the attribute `study`")
        self.study = study


class SweepInterrupted(Pickled, KeyboardInterrupt):
    """The user's interrupt of a long computation; finished parts are kept where it was told to keep them."""


class NotWritten(LcpStepError, OSError):
    """A file that could not be written; the one that was there before is unchanged."""

    def __init__(self, file: object, reason: OSError) -> None:
        self.reason, self.file = reason.strerror or str(reason), str(file)
        self.code = reason.errno  # None where a library does not say
        more = "; choose another place" if isinstance(reason, PermissionError) else ""
        super().__init__(f"{file} could not be written: {self.reason}{more}")


class DamagedFile(LcpStepError, ValueError):
    """A file of the library's own that is not what was written."""


class SweepStopped(LcpStepError):
    """A long computation that could not go on; the parts finished before are kept where it was told to keep them."""
