"""Complementarity solvers inside time-stepping: what their tolerance adds to the error of the step."""

import math

import numpy as np
import pytest

from lagrangian import LinearContacts, LinearSystem, Scene, scenes
from lcpstep import EventDriven, Moreau, UnknownName, simulate, solve_lcp
from lcpstep.accuracy.solvers import SolverRun, Solvers, compare_solvers
from lcpstep.cli import main
from lcpstep.cli.common import DONE, USAGE


def column(n=3, t_end=0.8):
    """Unit masses above a floor and each other, falling from a stretched column."""
    G = np.eye(n) - np.eye(n, k=-1)
    return Scene(
        system=LinearSystem(M=np.eye(n), force=np.full(n, -9.81)), contacts=LinearContacts(G=G, restitution=0.2),
        q0=0.5 * (1 + np.arange(n)), v0=np.zeros(n), t_span=(0.0, t_end), name="column",
    )  # fmt: skip


@pytest.mark.slow
def test_what_a_solver_adds_falls_with_its_tolerance_and_the_error_of_the_step_does_not():
    scene = column()
    reference = simulate(scene, Moreau(1e-5))
    found = compare_solvers(
        scene,
        Moreau(),
        [1e-2, 1e-3],
        reference,
        solvers=["qp:clarabel", "qp:daqp"],
        tolerances=(1e-1, 1e-4, 1e-8),
    )
    for h in (1e-2, 1e-3):
        added = [r.added for r in found.runs if r.solver == "qp:clarabel" and r.h == h]
        assert added[2] < 1e-3 * added[1] < 1e-4 * added[0]
        (exact,) = (r for r in found.runs if r.solver == "lemke" and r.h == h)
        assert exact.error == exact.error_of_step > 0.0
        (active_set,) = (r for r in found.runs if r.solver == "qp:daqp" and r.h == h)
        assert active_set.added < 1e-10
    # a finer step leaves less room for the solver
    assert found.limit("qp:clarabel", 1e-3) < found.limit("qp:clarabel", 1e-2)
    assert found.limit("qp:daqp", 1e-3) is None
    assert "does not limit" in found.verdict("qp:daqp", 1e-3)


def made(added, h=1e-3, solver="qp:made"):
    return [SolverRun(solver, t, h, "DONE", a, a + 1e-3, 1e-3, 1.0, 5) for t, a in added.items()]


def test_the_limiting_tolerance_lies_where_the_added_error_crosses_that_of_the_step():
    found = Solvers(made({1e-2: 1e-1, 1e-4: 1e-3 / 3, 1e-6: 1e-7}))
    limit = found.limit("qp:made", 1e-3)
    assert math.log(limit / 1e-4) / math.log(100) == pytest.approx(math.log(3) / math.log(300))
    assert "for tolerances above 0.0002" in found.verdict("qp:made", 1e-3)
    assert Solvers(made({1e-2: 1e-5})).limit("qp:made", 1e-3) == math.inf
    assert Solvers(made({1e-2: 1e-1, 1e-6: math.inf})).limit("qp:made", 1e-3) == 0.0
    assert "<- limits" in str(found)


def test_a_solver_at_its_own_tolerance_gives_its_own_answer():
    W, b = np.array([[2.0, 1.0], [1.0, 2.0]]), np.array([-1.0, -3.0])
    exact = solve_lcp(W, b).z
    loose, tight = (solve_lcp(W, b, f"qp:clarabel:{t:g}").z for t in (1e-2, 1e-9))
    assert 1e-8 < np.max(np.abs(loose - exact)) < 0.1
    assert np.max(np.abs(tight - exact)) < 1e-7
    assert solve_lcp(W, b, "qp:osqp:1e-4").solved
    for name, match in {
        "qp:osqp:tight": "tolerance",
        "qp:osqp:-1": "tolerance",
        "qp:daqp:1e-6": "daqp",
    }.items():
        with pytest.raises(ValueError, match=match):
            Moreau(lcp=name)
    with pytest.raises(UnknownName):
        Moreau(lcp="qp:osq:1e-6")


def test_failures_of_a_solver_are_rows_and_the_rest_goes_on():
    scene = scenes.bouncing_ball(t_end=1.0)
    reference = simulate(scene, EventDriven())
    found = compare_solvers(
        scene, Moreau(), [1e-2], reference, solvers=["qp:nobody", "qp:osqp"], tolerances=[1e-6]
    )
    assert [r.status for r in found.runs] == ["DONE", "FAILED", "DONE"]
    assert "nobody" in found.runs[1].message
    with pytest.raises(TypeError, match="lcp"):
        compare_solvers(scene, EventDriven(), [1e-2], reference)


def test_the_command_compares_solvers(capsys, tmp_path):
    arguments = [
        "study",
        "impact-oscillator",
        "--t-end",
        "5",
        "--h",
        "1e-2",
        "--solvers",
        "qp:clarabel",
        "qp:osqp",
    ]
    assert main([*arguments, "--solver-tolerances", "1e-1", "1e-6", "--out", str(tmp_path)]) == DONE
    out = capsys.readouterr().out
    assert "qp:clarabel at h = 0.01" in out
    assert (tmp_path / "solvers.json").exists()
    assert main([*arguments, "--methods", "event-driven"]) == USAGE
