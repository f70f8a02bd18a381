"""The table of hard cases: a quick part of it as pass or fail, its honesty, and the command."""

import json
import math
from pathlib import Path

import pytest

from lagrangian.scenes import CATALOGUE
from lcpstep.cli import main
from lcpstep.errors import LcpStepError
from lcpstep.hard import CHECKS, METHODS, Check, run_check, table
from lcpstep.hard.check import FIRST_ORDER, Stopped
from lcpstep.hard.report import markdown

QUICK = ("bouncing-ball", "dyadic-ball", "chattering-table", "jumping-table", "impact-oscillator", "grazing")


def test_every_scene_of_the_catalogue_is_checked_by_some_method():
    assert {c.scene for c in CHECKS} == set(CATALOGUE)
    assert all(set(c.bounds) <= set(METHODS) for c in CHECKS)
    assert len({(c.scene, c.what) for c in CHECKS}) == len(CHECKS)


def test_one_degree_of_freedom_passes_event_by_event():
    rows = table(QUICK, ["event-driven"])
    assert {row.scene for row in rows} == set(QUICK)
    assert [row for row in rows if not row.passed] == []


def a_check(measure, bound):
    return Check("bouncing-ball", "a check", measure, 1.0, {"moreau": bound})


def test_a_method_that_is_off_fails_and_one_that_cannot_is_refused():
    assert run_check(a_check(lambda solve: 2.0, 1.0), "moreau").outcome == "failed"
    assert run_check(a_check(lambda solve: math.nan, 1.0), "moreau").outcome == "failed"
    assert run_check(a_check(lambda solve: math.inf, 1.0), "moreau").as_json()["error"] is None
    assert run_check(a_check(lambda solve: 1.0, 1.0), "moreau").passed

    def refuse(solve):
        raise LcpStepError("not this one")

    def stop(solve):
        raise Stopped("TOO_MANY_EVENTS")

    def break_down(solve):
        raise ZeroDivisionError("by zero")

    outcomes = [run_check(a_check(f, 1.0), "moreau") for f in (refuse, stop, break_down)]
    assert [row.outcome for row in outcomes] == ["refused", "failed", "failed"]
    assert [row.error for row in outcomes] == [None] * 3
    assert outcomes[0].note == "not this one"


def test_the_first_order_bound_is_that_of_the_run():
    rows = [
        run_check(c, "moreau")
        for c in CHECKS
        if c.what == "states through the accumulation" and "moreau" in c.bounds
    ]
    # h (sum of jumps + largest speed), 5 % of the height at most
    speed = math.sqrt(2 * 9.81)
    assert rows[0].bound == pytest.approx(min(0.9e-3 * (1.8 * speed / 0.2 + speed), 0.05), rel=0.02)
    assert FIRST_ORDER < 0.0


def test_the_command_prints_json_with_one_line_a_check_and_a_page(capsys):
    status = main(["hard", "--scene", "dyadic-ball", "--json"])
    rows = json.loads(capsys.readouterr().out)
    assert status == (0 if all(r["outcome"] != "failed" for r in rows) else 1)
    assert {"scene", "method", "passed", "error", "bound", "seconds"} <= set(rows[0])
    assert {r["method"] for r in rows} == set(METHODS)
    assert main(["hard", "--scene", "dyadic-bal"]) == 2
    assert "did you mean 'dyadic-ball'" in capsys.readouterr().err
    page = markdown(table(["dyadic-ball"], ["event-driven"]))
    assert "## dyadic-ball" in page
    assert "| times of the impacts | event-driven | passed | 0 |" in page


@pytest.mark.slow
def test_what_the_page_shows_as_passed_goes_on_passing():
    page = (Path(__file__).parent.parent / "docs" / "hard-cases.md").read_text()
    shown, scene = [], ""
    for line in page.splitlines():
        if line.startswith("## "):
            scene = line[3:]
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if len(cells) == 7 and cells[2] == "passed":
            shown.append((scene, cells[0], cells[1]))
    assert len(shown) > 100
    checks = {(c.scene, c.what): c for c in CHECKS}
    rows = [run_check(checks[x[:2]], x[2]) for x in shown if not checks[x[:2]].heavy]
    assert [row for row in rows if not row.passed] == []


def test_error_bars_of_steps_tell_the_errors_without_the_answer():
    scenes = (
        "bouncing-ball",
        "impact-oscillator",
        "bowl",
        "coulomb-oscillator",
        "sliding-block",
        "slope-landing",
    )
    rows = [row for row in table(scenes, ["moreau"], bars=True) if row.what.startswith("states")]
    assert len(rows) >= 7
    for row in rows:
        assert row.known == 1.0
        assert 0.5 < row.bar / row.error < 2.0
    assert table(["sliding-block"], ["moreau"])[0].bar is None


def test_error_bars_of_event_driven_runs_are_not_below_the_errors():
    rows = [
        row for row in table((*QUICK, "falling-rod"), ["event-driven"], bars=True) if "states" in row.what
    ]
    assert len(rows) >= 4
    for row in rows:
        assert row.error <= 2.0 * row.bar
        assert row.bar < 1e-10


def test_the_command_prints_error_bars_beside_errors(capsys):
    assert main(["hard", "--scene", "chattering-table", "--error", "--method", "moreau"]) == 0
    line = capsys.readouterr().out.splitlines()[0]
    assert "  bar 8" in line
    assert " % " in line
    main(["hard", "--scene", "chattering-table", "--error", "--method", "moreau", "--json"])
    row = json.loads(capsys.readouterr().out)[0]
    assert row["error"] < 2.0 * row["bar"]
    assert 0.0 < row["bar_holds_for"] < 1.0
