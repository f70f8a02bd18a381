"""Long computations in parts: in parallel, on any executor, with every finished part on disk.

A sweep is a number of chains of parts. The parts of a chain follow one another, each handed what the one before
left; chains run side by side. A part is written to a file of its own, which appears all at once or not at all, so
that a run killed at any moment has lost only the parts at hand, and the same call goes on from there with the
same result to the last bit.
"""

from __future__ import annotations

import hashlib
import io
import json
import logging
import os
import threading
from collections.abc import Callable, Generator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from lagrangian import checks
from lcpstep.errors import SweepInterrupted, SweepStopped
from lcpstep.files import replacing
from lcpstep.pace import tell, until_given_up

LOG = logging.getLogger(__name__)
Arrays = dict[str, Any]  # named arrays
Work = Callable[[Any, Arrays | None], tuple[Arrays, Arrays | None]]
MANIFEST = "manifest.json"
CARRY = "carry:"  # before the names of what a part hands to the next
SEAL = "seal"
MARK = "of_the_work"  # attribute of errors


def sweep(
    work: Work,
    chains: Sequence[Sequence[Any]],
    inputs: Mapping[str, Any],
    *,
    out: Path | str | None = None,
    executor: Executor | None = None,
    jobs: int | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> list[list[Arrays]]:
    """Do all parts of a sweep, but for those that lie finished on disk.

    Parameters
    ----------
    work : (part, handed) -> (arrays, handed on); must be picklable for executors of processes
    chains : parts in their order; those of different chains do not depend on one another
    inputs : all that the result depends on, as JSON; a folder with other inputs is refused
    out : folder for finished parts; None keeps them in memory only
    executor : any `concurrent.futures.Executor`; a pool of threads on all cores where not given. It is not shut down.
    jobs : number of threads of that pool
    progress : called with the number of finished parts and of all

    Returns
    -------
    The arrays of every part, chain by chain

    Raises
    ------
    TypeError   executor is none
    ValueError   jobs is not positive
    SweepStopped   the executor died, or `out` holds another sweep; finished parts are kept
    SweepInterrupted   a KeyboardInterrupt; finished parts are kept, and the pool's threads give the others up
    Exception   whatever work raises; finished parts are kept
    """
    store = Store(out, inputs)
    results = [[store.load(i, k) for k in range(len(chain))] for i, chain in enumerate(chains)]
    total = sum(len(chain) for chain in chains)
    own, given_up = None, threading.Event()
    work = partial(_marked, work)
    if executor is None:
        jobs = (os.cpu_count() or 1) if jobs is None else checks.count("jobs", jobs)
        own = executor = ThreadPoolExecutor(max_workers=jobs)
        work = partial(until_given_up, given_up, work)
    checks.has("executor", executor, "submit", "a concurrent.futures.Executor")
    running: dict[Future[Any], tuple[int, int]] = {}

    def take(future: Future[Any]) -> int:
        i, k = running.pop(future)
        arrays, handed = future.result()
        results[i][k] = (arrays, handed)
        with _marking():
            store.save(i, k, arrays, handed)
        return i

    try:
        for i in range(len(chains)):
            _submit(executor, work, chains, results, i, running)
        while running:
            report(progress, results, total)
            done, _ = wait(running, return_when=FIRST_COMPLETED)
            for future in sorted(done, key=lambda f: running[f]):
                _submit(executor, work, chains, results, take(future), running)
        report(progress, results, total)
    except KeyboardInterrupt:
        given_up.set()
        _keep_finished(running, take)
        raise SweepInterrupted(f"interrupted; {_words(results, total, out)}") from None
    except Exception as error:
        _keep_finished(running, take)
        if hasattr(error, MARK):
            raise
        raise SweepStopped(
            f"the executor failed ({type(error).__name__}: {error}); {_words(results, total, out)}"
        ) from error
    finally:
        for future in running:
            future.cancel()
        if own is not None:
            own.shutdown(wait=not given_up.is_set(), cancel_futures=True)
        _keep_finished(running, take)
    return [[part[0] for part in chain if part is not None] for chain in results]


def _keep_finished(running: dict[Future[Any], tuple[int, int]], take: Callable[[Future[Any]], int]) -> None:
    """Take over what was finished beside a failure."""
    for future in list(running):
        if future.done() and not future.cancelled() and future.exception() is None:
            take(future)


def _words(results: list[list[Any]], total: int, out: Path | str | None) -> str:
    """What there is of a sweep that could not go on."""
    done = sum(part is not None for chain in results for part in chain)
    if not done:
        return "no part was finished"
    kept = f"kept in {out}, the same call goes on from there" if out else "lost: no folder was given"
    return f"{done} of {total} parts are {kept}"


def report(progress: Callable[[int, int], None] | None, results: list[list[Any]], total: int) -> None:
    """Tell how many parts are finished."""
    done = sum(part is not None for chain in results for part in chain)
    tell(done, total)
    if progress is not None:
        with _marking():
            progress(done, total)


def _submit(
    executor: Executor, work: Work, chains: Sequence[Sequence[Any]], results: list[list[Any]], i: int,
    running: dict[Future[Any], tuple[int, int]],
) -> None:  # fmt: skip
    """Hand in the first part of chain i that is not finished."""
    for k, part in enumerate(results[i]):
        if part is None:
            handed = None if k == 0 else results[i][k - 1][1]
            running[executor.submit(work, chains[i][k], handed)] = (i, k)
            return


@contextmanager
def _marking() -> Generator[None, None, None]:
    """Mark errors that are none of an executor's; the mark goes with them from process to process."""
    try:
        yield
    except Exception as error:
        setattr(error, MARK, True)
        raise


def _marked(work: Work, part: Any, handed: Arrays | None) -> tuple[Arrays, Arrays | None]:
    """The work, whose errors are told from those of whatever executor does it."""
    with _marking():
        return work(part, handed)


class Store:
    """Finished parts in a folder, and a manifest that says of what.

    A part carries a seal over what the manifest says and its own numbers. Only a part whose seal fits is taken; one
    that is damaged, or was left by another sweep or version, is made again.
    """

    def __init__(self, folder: Path | str | None, inputs: Mapping[str, Any]) -> None:
        self.folder = None if folder is None else Path(folder)
        self.digest = digest(inputs)
        if self.folder is None:
            return
        manifest = self.folder / MANIFEST
        if manifest.exists():
            found = stated(manifest)
            if found == self.digest:
                return
            if found is not None:
                raise SweepStopped(
                    f"out: {self.folder} holds the parts of another sweep; choose another folder"
                )
            LOG.warning("%s is damaged and is written again", manifest)
        elif self.folder.exists() and any(not x.name.startswith(".") for x in self.folder.iterdir()):
            raise FileExistsError(f"out: {self.folder} exists and is no folder of this sweep")
        with replacing(manifest) as draft:
            text = json.dumps({"sweep": inputs, "digest": self.digest}, indent=1, sort_keys=True, default=str)
            draft.write_text(text)

    def save(self, i: int, k: int, arrays: Arrays, handed: Arrays | None) -> None:
        """Keep a part."""
        if self.folder is not None:
            named = arrays | {CARRY + name: x for name, x in (handed or {}).items()}
            named[SEAL] = self.seal(named)
            with replacing(self.file(i, k)) as draft:
                np.savez(draft, **named)

    def load(self, i: int, k: int) -> tuple[Arrays, Arrays | None] | None:
        """A part that was kept, or None."""
        if self.folder is None or not self.file(i, k).exists():
            return None
        content = self.file(i, k).read_bytes()
        try:
            with np.load(io.BytesIO(content)) as part:
                named = {name: part[name] for name in part.files}
        except Exception:  # there is no end to what garbled bytes can look like to those who read them
            named = {}
        if str(named.pop(SEAL, None)) != self.seal(named):
            LOG.warning("%s is damaged or of another version, and is made again", self.file(i, k))
            return None
        arrays = {name: x for name, x in named.items() if not name.startswith(CARRY)}
        handed = {name[len(CARRY) :]: x for name, x in named.items() if name.startswith(CARRY)}
        return arrays, handed or None

    def seal(self, named: Arrays) -> str:
        """What fits this sweep and these numbers alone."""
        found = hashlib.sha256(self.digest.encode())
        for name, x in sorted(named.items()):
            a = np.ascontiguousarray(x)
            found.update(f"{name} {a.dtype} {a.shape}".encode() + a.tobytes())
        return found.hexdigest()

    def file(self, i: int, k: int) -> Path:
        """Where a part lies."""
        return Path(self.folder or "") / f"part-{i:05d}-{k:05d}.npz"


def digest(inputs: Any) -> str:
    """Of what a sweep depends on."""
    text = json.dumps(inputs, indent=1, sort_keys=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()


def stated(manifest: Path) -> str | None:
    """The digest that a manifest gives, "" for one without; None where it is damaged."""
    try:
        found = json.loads(manifest.read_bytes())
    except ValueError:
        return None
    if not (isinstance(found, dict) and {"sweep", "digest"} <= found.keys()):
        return ""
    return digest(found["sweep"]) if digest(found["sweep"]) == found["digest"] else None
