"""Workers that can be killed: machine code cannot be interrupted, and a scene may make it run for ever or crash.

A worker sets timers on its own CPU time before every run: the first interrupts it, and where machine code does not
hear that, the second has the system end the process. Who is waiting sees the end of the pipe, knows what the worker
was at, and starts another.
"""

from __future__ import annotations

import multiprocessing
import signal
import traceback
from collections.abc import Generator, Iterable, Iterator
from multiprocessing.connection import wait
from typing import Any, NamedTuple

from benchmarks.judge import case
from benchmarks.judge.case import SHARE
from benchmarks.judge.coupled.case import judged as judged_coupled
from benchmarks.judge.coupled.scenes import Coupled
from benchmarks.judge.describe import Description
from benchmarks.judge.runs import Clock, Finding
from benchmarks.judge.warm import warm

CPU_LIMIT = 10.0  # seconds of one run
WALL_LIMIT = 600.0  # without a word from a worker


class Answer(NamedTuple):
    """What was found out about a scene."""

    index: int
    scene: Description | Coupled
    endings: dict[str, str]
    findings: list[Finding]
    orders: dict[str, float]


def _work(pipe: Any, limit: float, share: float) -> None:
    """A worker: scenes in; names of methods at work and verdicts out."""
    Clock.limit = limit
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C at a terminal is meant for who started the workers
    while True:
        task = pipe.recv()
        if task is None:
            return
        scene, methods, without = task
        judged = judged_coupled if isinstance(scene, Coupled) else case.judged
        try:
            pipe.send(judged(scene, methods, pipe.send, share, without))
        except BrokenPipeError:  # nobody is listening any more
            return
        except Exception as error:  # of the judge itself: raised where everybody sees it
            pipe.send(RuntimeError(f"{error!r} in {scene!r}\n{traceback.format_exc()}"))


class _Worker:
    """A process, and what it is at."""

    def __init__(self, limit: float, share: float) -> None:
        context = multiprocessing.get_context("spawn")
        self.pipe, other = context.Pipe()
        self.process = context.Process(target=_work, args=(other, limit, share), daemon=True)
        self.process.start()
        other.close()
        self.task: Any = None
        self.at = ""

    def give(
        self, index: int, scene: Description | Coupled, methods: list[str], without: tuple[str, ...] = ()
    ) -> None:
        """A scene to judge, without the methods at which workers have been lost."""
        self.task, self.at = (index, scene, methods, without), ""
        self.pipe.send((scene, methods, without))

    def stop(self) -> int:
        """End the process; its exit code."""
        self.process.kill()
        self.process.join()
        self.pipe.close()
        return int(self.process.exitcode or 0)


def answers(
    scenes: Iterable[tuple[int, Description | Coupled]],
    methods: list[str],
    workers: int,
    limit: float = CPU_LIMIT,
    share: float = SHARE,
) -> Generator[Answer, None, None]:
    """Verdicts on scenes, in the order in which they are ready."""
    scenes = iter(scenes)
    warm(methods)
    pool = [_Worker(limit, share) for _ in range(workers)]
    lost: dict[int, tuple[dict[str, str], list[Finding]]] = {}
    try:
        for w in pool:
            _next(w, scenes, methods)
        while any(w.task for w in pool):
            busy = {w.pipe: w for w in pool if w.task}
            ready = wait(list(busy), WALL_LIMIT)
            for pipe in ready or list(busy):
                w = busy[pipe]
                answer = _hear(w) if ready else "silent"
                if isinstance(answer, Answer):
                    endings, findings = lost.pop(answer.index, ({}, []))
                    yield answer._replace(
                        endings=answer.endings | endings, findings=answer.findings + findings
                    )
                    _next(w, scenes, methods)
                elif answer:
                    pool[pool.index(w)] = _replaced(w, limit, share, lost)
    finally:
        for w in pool:
            w.stop()


class Court:
    """One worker that is asked about one scene after another."""

    def __init__(self, limit: float) -> None:
        self.limit = limit
        self.worker = _Worker(limit, 1.0)

    def ask(self, scene: Description, method: str) -> list[Finding]:
        """What is found about a method on a scene."""
        self.worker.give(0, scene, [method])
        lost: dict[int, tuple[dict[str, str], list[Finding]]] = {}
        while True:
            answer = _hear(self.worker)
            if isinstance(answer, Answer):
                return answer.findings + lost.pop(0, ({}, []))[1]
            if answer:
                self.worker = _replaced(self.worker, self.limit, 1.0, lost)

    def close(self) -> None:
        """End the worker."""
        self.worker.stop()


def _next(w: _Worker, scenes: Iterator[tuple[int, Description | Coupled]], methods: list[str]) -> None:
    task = next(scenes, None)
    w.task = None
    if task is not None:
        w.give(*task, methods)


def _hear(w: _Worker) -> Any:
    """A word of a worker: an answer, "dead", or nothing of note."""
    try:
        word = w.pipe.recv()
    except (EOFError, OSError):
        return "dead"
    if isinstance(word, RuntimeError):
        raise word
    if isinstance(word, str):
        w.at = word
        return None
    return Answer(w.task[0], w.task[1], *word)


def _replaced(w: _Worker, limit: float, share: float, lost: Any) -> _Worker:
    """Another worker for the rest of the scene at which one was lost."""
    index, scene, methods, without = w.task
    w.process.join(1.0)
    code = w.stop()
    kind = "hang" if code in (-signal.SIGVTALRM, -signal.SIGKILL) else "crash"
    text = (
        f"no end within {limit:g} s of CPU time" if kind == "hang" else f"the process ended with code {code}"
    )
    endings, findings = lost.setdefault(index, ({}, []))
    endings[w.at] = kind
    findings.append(Finding(w.at, kind, text))
    new = _Worker(limit, share)
    new.give(index, scene, methods, (*without, w.at))
    return new
