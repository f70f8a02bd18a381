"""What slips and stops cost beside impacts, a thousand periods on belts, the woodpecker's period.

    python -m benchmarks.work_precision.slips [events] [periods] [woodpecker]

Costs are differences of CPU times of two spans, in one process, over the events between them: the least of several
turns, in which the contestants alternate. Errors on the belts are the largest of the positions at 40 times of the
last one percent: against the closed form, Den Hartog's motion, or steps of integration at a tolerance of 1e-13 (a
belt that sways).
"""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from lagrangian import Scene, scenes
from lagrangian.scenes.belts import stick_slip_period
from lcpstep import EventDriven, Located, Moreau, simulate
from lcpstep.events.contacts.run import ContactRun
from lcpstep.recording import Kept
from lcpstep.trajectory import Kind

TURNS = 9
SPANS = 500.0, 2000.0  # [s]; of closed forms LONGER times as long
LONGER = 20.0
Run = Callable[[Scene, Any], Any]


def integrated(kind: Any) -> Run:
    """A run by Runge-Kutta steps, of a scene that has a closed form as well."""

    def run(scene: Scene, method: Any) -> Any:
        end = np.array([scene.t_span[1]])
        return kind(method, scene, Kept.parse(end, scene.t_span)).finish(lambda t: None)

    return run


def automatic(scene: Scene, method: Any) -> Any:
    """The run that `simulate` makes."""
    return simulate(scene, method, keep=np.array([scene.t_span[1]]))


EVENTS: dict[str, tuple[Callable[[float], Scene], Run]] = {
    "impact, closed form": (lambda T: scenes.impact_oscillator(t_end=T), automatic),
    "slip or stop, even belt, closed form": (lambda T: scenes.stick_slip_belt(t_end=T), automatic),
    "slip or stop, swaying belt, closed form": (
        lambda T: scenes.stick_slip_belt(amplitude=0.3, t_end=T),
        automatic,
    ),
    "reversal, closed form": (lambda T: scenes.coulomb_oscillator(x0=9000.0, t_end=T), automatic),
    "impact, Runge-Kutta": (lambda T: scenes.impact_oscillator(t_end=T), integrated(ContactRun)),
    "slip or stop, even belt, Runge-Kutta": (
        lambda T: scenes.stick_slip_belt(t_end=T),
        integrated(ContactRun),
    ),
    "reversal, Runge-Kutta": (
        lambda T: scenes.coulomb_oscillator(x0=9000.0, t_end=T),
        integrated(ContactRun),
    ),
}


def timed(run: Callable[..., Any], *given: Any, **named: Any) -> tuple[float, Any]:
    """CPU time [s], and what was made."""
    begin = time.process_time()
    made = run(*given, **named)
    return time.process_time() - begin, made


def events() -> None:
    """Print the cost of an event."""
    print("| event | tolerance | microseconds | steps |\n|---|---|---|---|")
    for tolerance in (1e-6, 1e-9, 1e-12):
        method, least = EventDriven(tolerance, tolerance), dict[tuple[str, float], tuple[float, int, int]]()
        for _ in range(TURNS):
            for name, (make, run) in EVENTS.items():
                longer = LONGER if "closed" in name else 1.0
                for span in SPANS:
                    scene = make(longer * span)
                    cost, done = timed(run, scene, method)
                    found = cost, len(done.impacts), done.counts.steps
                    least[name, span] = min(found, least.get((name, span), found))
        for name in EVENTS:
            short, long = (least[name, span] for span in SPANS)
            n = long[1] - short[1]
            cost, steps = 1e6 * (long[0] - short[0]) / n, (long[2] - short[2]) / n
            print(f"| {name} | {tolerance:g} | {cost:.2f} | {steps:.1f} |", flush=True)


def belts() -> dict[str, Scene]:
    """Belts for a thousand periods."""
    return {
        "even": scenes.stick_slip_belt(t_end=1e3 * stick_slip_period(0.2, 0.6, 1.0)),
        "swaying": scenes.stick_slip_belt(amplitude=0.3, t_end=1e3 * 2.0 * math.pi / 0.7),
        "to and fro": scenes.mass_on_shaken_belt(t_end=1e3 * 2.0 * math.pi / 1.5),
    }


def periods() -> None:
    """Print error and CPU time after a thousand periods."""
    print("| belt | method | CPU time [s] | error [m] |\n|---|---|---|---|")
    for name, scene in belts().items():
        end = scene.t_span[1]
        times: Any = end * (1.0 - 0.01 * (np.arange(40)[::-1] + 0.5) / 40.0)
        truth = scene.exact(times)[0] if scene.exact else reference(scene, times)
        methods: list[Any] = [EventDriven(), *(Moreau(h) for h in (1e-1, 1e-2, 1e-3, 1e-4))]
        for method in methods:
            costs = [timed(simulate, scene, method, keep=times) for _ in range(3)]
            error = float(np.max(np.abs(costs[0][1].q - truth)))
            least = min(cost for cost, _ in costs)
            print(
                f"| {name} | {type(method).__name__}({shown(method)}) | {least:.4f} | {error:.1e} |",
                flush=True,
            )
            if error < 1e-3 and isinstance(method, Moreau):
                break


def reference(scene: Scene, times: Any) -> Any:
    """Positions by steps of integration at the tightest tolerance."""
    run = ContactRun(EventDriven(1e-13, 1e-13), scene, Kept.parse(times, scene.t_span))
    return run.finish(lambda t: None).q


def shown(method: Any) -> str:
    """The parameters that matter here."""
    if isinstance(method, EventDriven):
        return f"{method.rtol:g}"
    order = f", order={method.order}" if isinstance(method, Located) else ""
    tolerance = f", tolerance={method.tolerance:g}" if method.tolerance else ""
    return f"{method.h:g}{order}{tolerance}"


def orbit(scene: Scene, method: Any) -> tuple[float, Any]:
    """Time from the last but one impact of contact 0 to the last, and the state after the former."""
    run = simulate(scene, method, keep="impacts")
    log = run.impacts
    hit = log.time[(log.kind == Kind.IMPACT) & (log.contact == 0)]
    return float(hit[-1] - hit[-2]), np.concatenate(run.at(hit[-2:-1]), axis=1)[0]


def woodpecker() -> None:
    """Print period and fixed point by both methods: by `Located` six periods after the start on the orbit."""
    scene = scenes.woodpecker(t_end=30.0)
    period, x = orbit(scene, EventDriven(1e-13, 1e-13))
    print(f"period {period:.14f} s, state after the impact {x[1:]}")
    print("| method | period's error [s] | state's error, relative to the largest |\n|---|---|---|")
    on_it = replace(scene, q0=x[:3], v0=x[3:], t_span=(0.0, 6.2 * period))
    methods = [EventDriven(tolerance, tolerance) for tolerance in (1e-8, 1e-10, 1e-12)]
    fixed = [Located(h, order=4) for h in (1e-4, 5e-5, 2e-5, 1e-5, 5e-6)]
    low = [Located(h) for h in (1e-5, 3e-6, 1e-6, 3e-7)]
    controlled = [Located(2e-3, order=4, tolerance=x) for x in (1e-8, 1e-10, 1e-12)]
    for method in [*methods, *fixed, *low, *controlled]:
        found, y = orbit(on_it, method)
        off = float(np.max(np.abs(y - x)[1:]) / np.max(np.abs(x[1:])))
        print(
            f"| {type(method).__name__}({shown(method)}) | {abs(found - period):.1e} | {off:.1e} |",
            flush=True,
        )


if __name__ == "__main__":
    parts = {"events": events, "periods": periods, "woodpecker": woodpecker}
    for name in sys.argv[1:] or parts:
        parts[name]()
