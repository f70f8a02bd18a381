"""The examples and the documentation run, and a number of each example is pinned to its independent value."""

import runpy
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent


def example(name):
    return runpy.run_path(str(ROOT / "examples" / f"{name}.py"))


def blocks(text):
    return [block.split("```")[0] for block in text.split("```python\n")[1:]]


def test_ball_comes_to_rest_at_the_known_time():
    assert example("ex01_bouncing_ball")["accumulation_error"]() < 1e-13


def test_follower_leaves_the_cam_at_the_known_speed():
    assert example("ex02_cam_detachment")["detachment_speed"]() == pytest.approx(114.979, abs=5e-4)


def test_own_mechanism_is_the_same_by_both_methods():
    coarse, fine = (example("ex03_own_mechanism")["distance_of_methods"](h) for h in (4e-4, 5e-5))
    assert fine < 1e-3
    assert coarse > 2.0 * fine  # it goes down with h


def test_a_derived_mechanism_keeps_its_energy():
    pytest.importorskip("sympy")
    assert example("ex04_from_a_lagrangian")["energy_drift"]() < 1e-9


@pytest.mark.parametrize(
    "page",
    [
        "README.md",
        "docs/tutorial.md",
        "docs/symbolic.md",
        "docs/hybrid-systems.md",
        "docs/seeing-and-keeping.md",
    ],
)
def test_documentation_runs(page, monkeypatch, tmp_path, capsys):
    pytest.importorskip("sympy")
    monkeypatch.chdir(tmp_path)
    source = tmp_path / "page.py"
    source.write_text("\n".join(blocks((ROOT / page).read_text())))
    runpy.run_path(str(source))
    assert capsys.readouterr().out
