"""What is of the wrong kind altogether is refused by its name, like any other wrong argument."""

import numpy as np
import pytest

from lagrangian import (
    Contacts,
    Coulomb,
    Guard,
    HybridSystem,
    Joints,
    LinearContacts,
    LinearSystem,
    Mode,
    Scene,
    System,
    scenes,
)
from lcpstep import EventDriven, Located, Moreau, continued, energy, load, simulate, solve_lcp, study
from lcpstep.accuracy.compare import compare
from lcpstep.analysis.attractors import attractors
from lcpstep.analysis.basins import basins
from lcpstep.analysis.orbits import periodic_orbit
from lcpstep.cli import main

BALL = scenes.bouncing_ball(t_end=0.1)
FREE = LinearSystem(1.0)
RUN = simulate(BALL, Moreau(1e-2))


def scene(**more):
    return Scene(FREE, 1.0, 0.0, (0.0, 1.0), **more)


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        (lambda: Scene({}, 1.0, 0.0, (0.0, 1.0)), "system: expected a LinearSystem or System"),
        (lambda: LinearContacts(1.0, friction=0.3), "friction: expected a Coulomb"),
        (lambda: Contacts(1, None, None, friction=0.3), "friction: expected a Coulomb"),
        (lambda: Contacts(1, None, print), "gap: expected a function"),
        (lambda: Contacts(1, print, 3.0), "jacobian: expected a function"),
        (lambda: Contacts(1, print, print, 0.6), "gap_t: expected a function"),
        (lambda: Joints(1, print, None), "jacobian: expected a function"),
        (lambda: LinearContacts(1.0, motion=3.0), "motion: expected a function"),
        (lambda: LinearSystem(1.0, frame=3.0), "frame: expected a function"),
        (lambda: System(1, 1.0, print, force_q=[[1.0]]), "force_q: expected a function"),
        (lambda: scene(contacts=[1]), "contacts: expected a LinearContacts or Contacts"),
        (lambda: scene(joints=[1]), "joints: expected"),
        (lambda: scene(parameters=[1]), "parameters: expected names and values"),
        (lambda: scene(coordinates=3), "coordinates: expected 1 names with units"),
        (lambda: scene(name=3), "name: expected a str"),
        (lambda: HybridSystem(1, 3), "modes: expected modes by name"),
        (lambda: HybridSystem(1, {"a": 3}), "modes: a: expected a Mode"),
        (lambda: simulate(BALL, Moreau(), progress=5), "progress: expected a function"),
        (lambda: study(BALL, [Moreau()], progress=5), "progress: expected a function"),
        (lambda: study(BALL, [Moreau()], measures=3), "measures: expected names in a list"),
        (lambda: study(BALL, [Moreau()], measures="energy"), "measures: expected names in a list"),
        (lambda: study(BALL, [Moreau()], h=1e-3), "h: expected numbers in a list"),
        (lambda: study(BALL, [Moreau()], spread=1), "spread: expected numbers in a list"),
        (lambda: study(BALL, [Moreau()], repeats="a"), "repeats: expected at least 1"),
        (lambda: study(BALL, {"a": Moreau()}), "methods: a: expected methods in a list"),
        (lambda: study(BALL, [Moreau()], horizon="a"), "horizon: expected"),
        (lambda: study(BALL, [Moreau()], horizon=float("nan")), "horizon: expected"),
        (lambda: compare(3, Moreau(), EventDriven()), "scene: expected a Scene"),
        (lambda: study(BALL, [Moreau()], repeats=1.5), "repeats: expected at least 1"),
        (lambda: energy(3), "trajectory: expected a Trajectory"),
        (lambda: continued(3, t_end=1.0), "run: expected a Trajectory"),
        (lambda: attractors(3, EventDriven(), [[0, 0]]), "scene: expected a lagrangian.Scene"),
        (lambda: basins(3, [0, 0], [1, 1]), "scene: expected a lagrangian.Scene"),
        (lambda: basins(BALL, [0, 0], [1, 1]), "scene: 'bouncing-ball' has no period, and so no basins"),
        (lambda: periodic_orbit(3, [0, 0]), "scene: expected a lagrangian.Scene"),
        (lambda: load(3), "path: expected the name of a file"),
        (lambda: RUN.save(3), "path: expected the name of a file"),
        (lambda: RUN.animate(3), "path: expected the name of a file"),
        (lambda: RUN.at("now"), "t: expected real numbers"),
        (lambda: RUN.at("0.01"), "t: expected real numbers"),
        (lambda: RUN.at([[0.0, 0.01], [0.02, 0.03]]), "t: expected one dimension"),
        (lambda: scene(exact=lambda t: t), "exact: expected a function of times that gives q and v"),
        (lambda: Located(order=np.array([2, 4])), "order: expected 2, 4"),
        (lambda: EventDriven(jamming=np.array([1, 2])), "jamming: expected"),
        (
            lambda: Coulomb(0.3, [[1.0]], law=np.array(["newton", "moreau"])).fitted(1),
            "friction.law: expected one of",
        ),
        (lambda: Guard(lambda t, x, p, out: None, "a", np.array([1, 0])), "guard.direction: expected"),
        (lambda: Mode(lambda t, x, p, out: None, 3), "mode.guards: expected guards in a list"),
        (lambda: Mode(lambda t, x, p, out: None, [3]), "mode.guards: expected guards in a list"),
        (lambda: continued(RUN, t_end=None), "t_end: expected a finite number"),
        (lambda: continued(RUN, t_end=np.inf), "t_end: expected a finite number"),
        (lambda: continued(RUN, t_end=True), "t_end: expected a number"),
        (lambda: Moreau(lcp=["qp"]), "unknown LCP solver"),
        (lambda: solve_lcp([[1.0]], [1.0], ["qp"]), "unknown LCP solver"),
        (lambda: EventDriven(max_events=1e30), "max_events: expected an integer of at most"),
        (lambda: Located(max_per_step=10**30), "max_per_step: expected an integer of at most"),
        (lambda: simulate(BALL, Moreau(1e-2), keep=2**63), "keep: expected an integer of at most"),
    ],
)
def test_wrong_kinds_are_named(wrong, said):
    with pytest.raises((TypeError, ValueError), match=f"^{said}"):
        wrong()


def test_numbers_of_numpy_are_numbers():
    assert scene(name=np.str_("free")).name == "free"
    assert simulate(BALL, EventDriven(), keep=np.int64(1)).at(np.float32(0.05))[0].shape == (1,)


def test_scenes_without_corners_have_no_corner_impact(capsys):
    assert main(["corner", "bouncing-ball"]) == 2
    assert (
        "expected one whose obstacle has corners, as cam-follower; 'bouncing-ball'" in capsys.readouterr().err
    )
