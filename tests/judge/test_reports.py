"""Reports of the judge, joined and put into a page."""

import sys

import pytest

from benchmarks.judge import page
from benchmarks.judge.describe import Description
from benchmarks.judge.pool import Answer
from benchmarks.judge.report import Tally, joined, report, saved
from benchmarks.judge.runs import Finding

BALL = Description(
    M=((2.0,),), q0=(1.0,), v0=(0.3,), t_span=(0.0, 1.5), h=0.01, G=((1.0,),), offset=(0.0,), restitution=0.5,
    constant=(-19.62,), family="ball",
)  # fmt: skip
FOUND = [Finding("moreau", "penetration", "deep"), Finding("located", "said: hang", "long")]


def tally(first, answers):
    """The tally of a portion that begins with a number."""
    t = Tally()
    for k, (ending, findings, order) in enumerate(answers, first):
        orders = {"located": order} if order else {}
        t.add(Answer(k, BALL, {"moreau": "DONE", "located": ending}, findings, orders))
    t.asked.append((7, first, first + len(answers)))
    return t


ANSWERS = [("DONE", FOUND, 2.0), ("refused", [], None), ("LCP_FAILED", FOUND[:1], None), ("DONE", [], 1.9)]


def test_portions_say_together_what_all_say_at_once():
    parts = tally(0, ANSWERS[:3]), tally(3, ANSWERS[3:])
    whole, together = tally(0, ANSWERS), joined(map(saved, parts))
    assert report(together) == report(whole)
    assert page.text(together) == page.text(whole)
    assert page.text(whole).startswith("4 scenes: seed 7, numbers 0 to 3.")
    assert "| penetration | moreau | 2 | ball 2 |" in page.text(whole)


def test_gaps_between_portions_and_other_seeds_are_told():
    t = joined([saved(tally(0, ANSWERS[:1])), saved(tally(5, ANSWERS[:2])), saved(tally(1, ANSWERS[:1]))])
    t.asked.append((9, 4, 5))
    assert page.drawn(t) == "seed 7, numbers 0 to 1, 5 to 6; seed 9, numbers 4 to 4"


def test_a_page_is_renewed_between_its_marks(tmp_path, monkeypatch, capsys):
    file, text = tmp_path / "report.md", tmp_path / "page.md"
    file.write_text(saved(tally(0, ANSWERS)))
    text.write_text("before\n<!-- judge -->\nold\n<!-- end of judge -->\nafter\n")
    monkeypatch.setattr(sys, "argv", ["page", str(file), "--write", str(text)])
    for _ in range(2):
        assert page.main() == 0
        tables = page.text(tally(0, ANSWERS))
        assert text.read_text() == f"before\n<!-- judge -->\n\n{tables}\n\n<!-- end of judge -->\nafter\n"
    assert capsys.readouterr().out.startswith("4 scenes")
    text.write_text("no marks")
    with pytest.raises(ValueError, match="end of judge"):
        page.main()
    file.write_text("| a table |")
    with pytest.raises(ValueError, match="--report"):
        page.main()
