"""Impacts of every scene of the catalogue: the same for another end, later, whatever is stored; or the bar ends."""

from dataclasses import replace

import numpy as np
import pytest

from lagrangian.scenes import CATALOGUE
from lcpstep import EventDriven, Located, simulate
from lcpstep.errors import LcpStepError
from lcpstep.simulation import fitted
from lcpstep.trajectory import Kind
from tests.marks import shared

FRICTION = {name for name, entry in CATALOGUE.items() if getattr(entry.make().contacts, "friction", None)}
MOVED = {"jumping-table"}  # its table moves without a period: later is another scene
CHAOTIC = {"chaotic-oscillator"}  # a tolerance over all of its span takes a minute
SHIFT = 8.0  # where nothing depends on time [s]
ROUNDING = 64 * np.finfo(float).eps


def questions(scene):
    """The same motion asked for otherwise: scene, what is stored, and how much later it is."""
    start, end = scene.t_span
    yield replace(scene, t_span=(start, start + 0.61 * (end - start))), "impacts", 0.0
    yield scene, "impacts", 0.0
    yield scene, np.linspace(start, end, 7), 0.0
    if scene.name not in MOVED:
        later = 4.0 * scene.period if np.isfinite(scene.period) else SHIFT
        yield replace(scene, t_span=(start + later, end + later)), "impacts", later


def nearest(log, contact, time):
    """How far from a time the nearest impact of a contact is."""
    own = log["time"][(log["contact"] == contact) & (log["kind"] == Kind.IMPACT)]
    return np.min(np.abs(own - time), initial=np.inf)


CASES = [(name, EventDriven()) for name in CATALOGUE]
CASES += [(name, Located(1e-3)) for name in CATALOGUE if name not in FRICTION]
OTHERS = EventDriven(1e-6, 1e-6), Located(2e-3, 4)
SLOW = [(name, method) for name in CATALOGUE for method in OTHERS]
SLOW += [(name, Located(1e-2, tolerance=1e-4)) for name in CATALOGUE if name not in CHAOTIC]
SLOW += [(name, Located(1e-3)) for name in sorted(FRICTION)]


@pytest.mark.parametrize("case", [*CASES, *shared(SLOW, 3)], ids=lambda case: "-".join(map(str, case)))
def test_impacts_do_not_depend_on_how_the_question_is_put_as_long_as_the_bar_holds(case):
    name, method = case
    scene = CATALOGUE[name].make()
    method = fitted(method, scene.t_span)
    try:
        run = simulate(scene, method, error=True)
    except LcpStepError as refused:
        pytest.skip(str(refused))
    latest = 0.0 if np.isnan(run.error.latest) else run.error.latest
    for other, keep, later in questions(scene):
        log = np.array(simulate(other, method, keep=keep).impacts)
        log["time"] -= later
        apart = 2.0 * latest + ROUNDING * (np.max(np.abs(scene.t_span)) + later)
        end = min(run.error.until, other.t_span[1] - later) - apart
        told = run.impacts[np.isfinite(run.error.impact_time) & (run.impacts.time < end)]
        assert all(nearest(log, x.contact, x.time) <= apart for x in told)
        found = log[(log["time"] < end) & (log["kind"] == Kind.IMPACT)]
        strongest = np.max(run.impacts.impulse, initial=0.0)
        assert np.max(found["impulse"], initial=0.0) <= strongest * (1.0 + 1e-6) + 2.0 * np.nan_to_num(
            run.error.strongest
        )
