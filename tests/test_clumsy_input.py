"""What is no number, no system, no method and no solver is refused by name before any step."""

import json
import math
import re
from dataclasses import replace
from importlib.metadata import metadata

import numpy as np
import pytest
import qpsolvers

from lagrangian import LinearContacts, LinearSystem, Scene, scenes
from lcpstep import EventDriven, LcpStepError, Located, MissingSolver, Moreau, UnknownName, load, simulate
from lcpstep.lcp.qp import known_solvers
from tests.falling import FALLING, FLOOR, run

# --- clumsy input


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("q0", {"q0": [True]}),
        ("q0", {"q0": [[True]]}),
        ("q0", {"q0": (np.True_,)}),
        ("v0", {"v0": [False]}),
        ("q0", {"q0": [1.0 + 2.0j]}),
        ("q0", {"q0": np.ma.masked_array([1.0], mask=[True])}),
        ("q0", {"q0": np.array(["1"], dtype=object)}),
        ("q0", {"q0": [10**400]}),
        ("t_span", {"t_span": (False, 1.0)}),
        ("t_span", {"t_span": (0.0, True)}),
        ("p", {"p": [1.0, True]}),
        ("corners", {"corners": [True]}),
    ],
)
def test_what_is_no_number_is_refused_by_name(name, values):
    given = {"q0": 1.0, "v0": 0.0, "t_span": (0.0, 1.0)} | values
    with pytest.raises(ValueError, match=rf"^{name}: expected real numbers, got "):
        Scene(FALLING, **given)


def test_what_stands_for_something_else_is_refused_by_name():
    scene = Scene(FALLING, 1.0, 0.0, (0.0, 1.0))
    for progress in (5, "a bar"):
        with pytest.raises(TypeError, match=r"^progress: expected a function of the time reached"):
            simulate(scene, Moreau(0.1), progress=progress)
    for keep in ([0.0, True], ["0.1", "0.2"], [0.1j], None, [[0.1, 0.2]]):
        with pytest.raises(ValueError, match=r"^keep: expected increasing times"):
            simulate(scene, Moreau(0.1), keep=keep)
    for keep, got in (([], "[]"), (0.5, "0.5"), ([0.2, 0.1], "[0.2, 0.1]")):
        with pytest.raises(ValueError, match=r"^keep: .* one at least, .* got " + re.escape(got)):
            simulate(scene, Moreau(0.1), keep=keep)
    for parameters in (3, [1.0], "mass"):
        with pytest.raises(TypeError, match=r"^parameters: expected names and values"):
            replace(scene, parameters=parameters)
    for part in ("system", "contacts", "joints"):
        with pytest.raises(TypeError, match=rf"^{part}: expected a Linear"):
            replace(scene, **{part: {}})
    with pytest.raises(TypeError, match=r"^friction: expected a Coulomb"):
        LinearContacts(G=1.0, friction=0.3)
    with pytest.raises(TypeError, match=r"^projected: expected a bool"):
        Moreau(0.1, projected="no")


@pytest.mark.parametrize(
    "value", [np.int64(3), np.float32(0.5), np.bool_(True), np.array(2.0), np.array([2])]
)
def test_parameters_are_numbers_of_python_s_however_they_are_given(value, tmp_path):
    """Those of numpy's went through the run, and could not be saved after it."""
    scene = Scene(FALLING, 1.0, 0.0, (0.0, 1.0), parameters={"c": value})
    assert type(scene.parameters["c"]) in (int, float, bool)
    run = simulate(scene, Moreau(0.1))
    assert load(run.save(tmp_path / "run.nc")).scene.parameters == {"c": value.item()}
    assert f'"c": {json.dumps(value.item())}' in run.to_xarray().attrs["parameters"]


@pytest.mark.parametrize("q0", [np.array(1), np.array([1]), [1], np.float32(1.0), np.ma.masked_array([1.0])])
def test_numbers_of_any_kind_are_taken(q0):
    assert Scene(FALLING, q0, 0.0, (0.0, 1.0)).q0.tolist() == [1.0]


def test_a_truth_value_among_numbers_of_a_matrix_is_refused():
    with pytest.raises(ValueError, match=r"^M: expected real numbers"):
        LinearSystem(M=[[1.0, 0.0], [0.0, True]])
    with pytest.raises(ValueError, match=r"^G: expected real numbers"):
        LinearContacts(G=[[True, 0.0]])


# --- methods and solvers


@pytest.mark.parametrize("h", [0.0, -1e-3, math.nan, math.inf, "small", None])
def test_the_step_is_positive(h):
    with pytest.raises(ValueError, match=r"^h: "):
        Moreau(h)


@pytest.mark.parametrize("method", [Moreau(1e-18), Located(1e-18)])
def test_a_step_below_the_resolution_of_time_is_refused(method):
    with pytest.raises(LcpStepError, match=r"h: steps of 1e-18 s are lost"):
        run(FALLING, FLOOR, method)


@pytest.mark.parametrize("method", [Moreau(1e-2), Located(1e-2), Located(1e-2, order=4)])
def test_a_step_longer_than_the_span_is_refused(method):
    scene = Scene(FALLING, 1.0, -1.0, (0.0, 9.9e-3), FLOOR)
    with pytest.raises(LcpStepError, match=r"^h: steps of 0\.01 s are longer than the span of 0\.0099 s"):
        simulate(scene, method)
    m = simulate(scene, replace(method, h=9.9e-3))
    assert m.counts.steps == 1
    assert m.t[-1] == 9.9e-3


def test_the_longest_step_of_a_tolerance_may_be_longer_than_the_span():
    m = simulate(Scene(FALLING, 1.0, -1.0, (0.0, 1e-13), FLOOR), Moreau(1e-2, tolerance=1e-6))
    assert m.t[-1] == 1e-13
    np.testing.assert_allclose(m.q[-1] - 1.0, -1e-13, rtol=1e-2)


@pytest.mark.parametrize("theta", [-0.1, 1.1, math.nan, "half", None])
def test_theta_lies_between_zero_and_one(theta):
    with pytest.raises(ValueError, match=r"^theta: "):
        Moreau(1e-3, theta)


@pytest.mark.parametrize(
    ("name", "near"),
    [("lemk", "lemke"), ("Lemke", "lemke"), ("qp:osqb", "qp:osqp"), ("qp:dqp", "qp:daqp"), ("osqp", "osqp")],
)
def test_an_unknown_solver_suggests_near_ones(name, near):
    with pytest.raises(UnknownName, match=f"unknown LCP solver '{name}'; did you mean .*{near}") as caught:
        Moreau(1e-3, lcp=name)
    assert isinstance(caught.value, ValueError)
    assert isinstance(caught.value, LcpStepError)


def test_a_solver_like_no_other_is_answered_with_all_of_them():
    with pytest.raises(UnknownName, match=r"known: .*lemke.*qp"):
        Moreau(1e-3, lcp="zzzzzz")


def test_a_solver_that_is_not_installed_is_answered_with_the_command_that_installs_it():
    missing = [n for n in known_solvers() if n not in qpsolvers.available_solvers]
    extras = set(metadata("qpsolvers").get_all("Provides-Extra"))
    assert missing
    for name in missing:
        with pytest.raises(MissingSolver, match=f"'{name}' is not installed: .*pip install") as caught:
            Moreau(1e-3, lcp=f"qp:{name}")
        assert isinstance(caught.value, ImportError)
        # a command that installs it: an extra of qpsolvers where there is one
        assert f"qpsolvers[{name}]" not in str(caught.value) or name in extras


def test_neither_scene_nor_method_may_be_something_else():
    with pytest.raises(TypeError, match=r"^scene: "):
        simulate("cam-follower", Moreau(1e-3))
    for method in (Moreau, EventDriven, "moreau", None):
        with pytest.raises(TypeError, match=r"^method: "):
            simulate(scenes.bouncing_ball(), method)
