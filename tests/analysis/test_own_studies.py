"""Diagrams and basins of scenes of a user's own: another scene's parts are no parts, names that clash are refused."""

import math
from functools import partial

import numpy as np
import pytest

from lagrangian import Contacts, Harmonic, LinearContacts, LinearSystem, Scene, System
from lcpstep import EventDriven
from lcpstep.analysis.bifurcation import bifurcation
from lcpstep.described import checksum
from lcpstep.errors import SimulationError, SweepStopped
from lcpstep.maps import StroboscopicMap
from lcpstep.parameters import ParameterStudy

FEW = {"drop": 3, "keep": 2}


def struck(omega, restitution=0.8, offset=0.2):
    block = LinearSystem(M=1.0, C=0.2, K=1.0, force=Harmonic(cosine=1.0, omega=omega))
    stop = LinearContacts(G=1.0, offset=offset, restitution=restitution)
    return Scene(block, 1.0, 0.0, (0.0, 1.0), contacts=stop, period=2.0 * math.pi / omega)


def family(restitution):
    return lambda omega: struck(omega, restitution)


def test_parts_of_a_scene_with_other_numbers_are_not_taken_for_ones_own(tmp_path):
    # Neither scene names its numbers as parameters, and both are made by a function of one name
    study = partial(bifurcation, parameter="omega", values=[2.0, 2.2], out=tmp_path / "s", **FEW)
    first = study(family(0.8))
    with pytest.raises(SweepStopped, match="another sweep"):
        study(family(0.3))
    part = next((tmp_path / "s").glob("part-*.npz"))
    written = part.stat().st_mtime_ns
    assert study(family(0.8)).identical(first)
    assert part.stat().st_mtime_ns == written


def force(t, q, v, p, out):
    out[0] = -q[0]


def stiffer(t, q, v, p, out):
    out[0] = -2.0 * q[0]


def made(f, **more):
    return Scene(System(1, [[1.0]], f), **({"q0": 1.0, "v0": 0.0, "t_span": (0.0, 1.0)} | more))


def test_the_checksum_of_a_scene_is_of_how_it_moves():
    known = checksum(made(force))
    assert known == checksum(
        made(force, q0=2.0, t_span=(1.0, 5.0), name="other", coordinates=["angle [rad]"])
    )
    assert known not in {
        checksum(made(stiffer)),
        checksum(made(force, p=[1.0])),
        checksum(made(force, period=1.0)),
    }
    assert checksum(struck(2.0)) not in {checksum(struck(2.1)), checksum(struck(2.0, offset=0.3))}


@pytest.mark.parametrize(
    "name", ["q", "v", "run", "period", "status", "impacts", "coordinate", "landing_phase"]
)
def test_a_parameter_named_as_something_else_in_the_result_is_refused_before_any_work(name):
    def make(**values):
        return struck(values[name])

    with pytest.raises(ValueError, match=f"parameter: .* {name!r}; give it another"):
        bifurcation(make, name, [2.0, 2.1], drop=10**9)


def test_what_makes_no_study_is_refused_by_name():
    with pytest.raises(TypeError, match="make: expected a scene at omega = 2"):
        bifurcation(lambda omega: None, "omega", [2.0, 2.1])
    with pytest.raises(TypeError, match="parameter: expected the name"):
        bifurcation(struck, 3, [2.0, 2.1])
    with pytest.raises(ValueError, match="x0: the motion starts inside"):
        bifurcation(partial(struck, offset=-0.5), "omega", [2.0, 2.1])


@pytest.mark.parametrize("start", ["fixed", "forward"])
def test_a_start_inside_of_the_obstacle_is_told_at_every_value_that_has_it(start):
    found = bifurcation(
        lambda far: struck(2.0, offset=far), "far", [-0.3, -0.2, -0.1, 0.1], start=start, **FEW
    )
    assert found.status.values.tolist() == [[-1, -1, -1, 0]]
    assert np.isfinite(found.q.values[0, :, 0, 0]).tolist() == [False, False, False, True]


def two_gaps(t, q, v, p, out):
    out[0], out[1] = 1.0 - q[0] - 0.1 * q[0] ** 2, 1.0 + q[0]


def wrong_above(t, q, v, p, out):
    out[0, 0] = -1.0 - (0.2 if q[0] < 0.3 else 0.1) * q[0]
    out[1, 0] = 1.0


def pushed(t, q, v, p, out):
    out[0] = -q[0] - 0.1 * v[0] + 2.0 * math.cos(p[0] * t)


def test_a_scene_whose_derivative_is_wrong_where_it_does_not_begin_is_refused_by_maps_and_studies():
    def make(values):
        stops = Contacts(2, two_gaps, wrong_above, restitution=0.5)
        w = values["w"]
        return made(pushed, q0=0.0, contacts=stops, parameters={"w": w}, period=2.0 * math.pi / w)

    with pytest.raises(SimulationError, match=r"jacobian\[0, 0\] is .* but differences"):
        StroboscopicMap(make({"w": 1.3}), EventDriven())([0.0, 0.5])
    study = ParameterStudy.read(
        'scene = "x"\nt_end = 5.0\n[sweep]\nw = [1.3]\n[outputs]\nmeasures = ["q_end"]'
    )
    with pytest.raises(SimulationError, match=r"jacobian\[0, 0\] is .* but differences"):
        study.run(make)
