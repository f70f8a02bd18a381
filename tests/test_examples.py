"""Examples and documentation run: each example draws, and a number of it is pinned to its independent value."""

import contextlib
import io
import runpy
from pathlib import Path

import numpy as np
import pytest

from tests.marks import slow

ROOT = Path(__file__).resolve().parent.parent
EXAMPLES = {file.stem: file for file in (ROOT / "examples").rglob("ex*.py")}
NEEDS = {
    "ex04_from_a_lagrangian": "sympy",
    "ex35_proof": "flint",
    "ex37_in_another_program": "fmpy",
}
SLOW = {  # films, a study, diagrams, basins, and what other tests show as well
    "ex02_cam_detachment",
    "ex03_own_mechanism",
    "ex04_from_a_lagrangian",
    "ex05_kept_and_sent",
    "ex06_cam_film",
    "ex12_pile_at_rest",
    "ex13_rocking_block",
    "ex15_slider_crank",
    "ex18_chain_at_a_wall",
    "ex19_grazing",
    "ex20_ball_on_a_table",
    "ex22_woodpecker",
    "ex23_painleve_rod",
    "ex25_two_stiffnesses",
    "ex27_slope_landing",
    "ex31_four_methods",
    "ex33_error_bars",
    "ex34_audit",
    "ex41_chapter_2_flips",
    "ex42_chapter_3_chaotic_cam",
    "ex43_chapter_4_bifurcation_diagram",
    "ex44_chapter_4_basins",
    "ex45_chapter_5_corner_impact",
    "ex46_chapter_6_border_collisions",
    "ex47_chapter_7_anti_lock_brake",
}
LONGEST = {  # films, and figures whose numbers `tests/analysis` looks at too
    "ex06_cam_film", "ex26_double_pendulum_film", "ex32_work_precision", "ex41_chapter_2_flips",
    "ex43_chapter_4_bifurcation_diagram",
}  # fmt: skip
LARGEST = 2_000_000  # of a picture or film [bytes]


def near(value, within):
    return pytest.approx(value, abs=within)


def own_mechanism(x):
    coarse, fine = (x["distance_of_methods"](h) for h in (4e-4, 5e-5))
    assert fine < 1e-3
    assert coarse > 2.0 * fine  # it goes down with h


def kept(x):
    assert np.array_equal(x["run"].q, x["same"].q)
    assert np.array_equal(x["run"].impulse, x["same"].impulse)


def cradle(x):
    assert x["last_velocities"](0.05) == near([0.0, 0.0, 1.0], 1e-12)
    assert x["last_velocities"](0.0) == near([-1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0], 1e-12)


def pile(x):
    assert x["forces"](x["pile"]()) == pytest.approx(9.81 * np.arange(20, 0, -1), rel=1e-9)


def corners_close(x):
    run = x["short_run"]()
    assert np.min(x["gaps"](run, run.t)) > -1e-9


def painleve(x):
    for angle in (0.7, 1.0, 1.3):
        below, above = (x["status"](float(x["critical"](angle)) * factor, angle) for factor in (0.99, 1.01))
        assert below == "DONE"
        assert above == "PAINLEVE_INCONSISTENT"


def landing(x):
    for mu, v0 in ((0.37, 2.1), (0.9, 0.7), (1.4, 1.1)):
        assert x["after"](mu, v0) == near(x["expected"](mu, v0), 1e-7)


def two_orbits(x):
    assert {orbit.name for orbit in x["found"]} == {"O(1, 2)", "O(3, 6)"}
    assert all(orbit.stable for orbit in x["found"])


def in_their_order(x):
    moreau, second, fourth, exact = (e.max() for e in x["errors"](np.linspace(0.0, 30.0, 400)).values())
    assert moreau > 10.0 * second > 1000.0 * fourth
    assert exact < 1e-12


def orders(x):
    assert x["orders"](x["found"]) == near([1.0, 2.0, 4.0], 0.3)


def bar(x):
    run, t, bar, error = x["bar_and_error"]()
    known = (t < run.error.until) & (error > 1e-9)
    assert np.all(bar[known] < 2.0 * error[known])
    assert np.all(bar[known] > 0.5 * error[known])


def audited(x):
    assert len(x["throw"](audit=True).audit.taken) == 1
    assert x["throw"](audit=True).q[-1, 0] < 0.83 < x["throw"](audit=False).q[-1, 0]


def proved(x):
    proof = x["proof"]()
    assert proof.stability == "stable"
    assert proof.multipliers[0].lower <= 0.8 <= proof.multipliers[0].upper + 1e-15  # both are the restitution


def basins(x):
    assert dict(zip(x["found"]["name"].values, x["found"]["share"].values, strict=True)) == {
        "O(3, 8)": near(0.76, 0.02),
        "O(1, 2)": near(0.24, 0.02),
    }


def scenarios(x):
    points = [x["settled"](name, 0.3) for name in x["CASES"]]
    assert points[:3] == [1, 2, 3]
    assert points[3] > 30


PINNED = {
    "ex01_bouncing_ball": lambda x: x["accumulation_error"]() < 1e-13,
    "ex02_cam_detachment": lambda x: x["detachment_speed"]() == near(114.979, 5e-4),
    "ex03_own_mechanism": own_mechanism,
    "ex04_from_a_lagrangian": lambda x: x["energy_drift"]() < 1e-9,
    "ex05_kept_and_sent": kept,
    "ex06_cam_film": lambda x: x["half_a_second"]().impacts.time[0] == near(0.0396, 5e-5),
    "ex11_newtons_cradle": cradle,
    "ex12_pile_at_rest": pile,
    "ex13_rocking_block": lambda x: x["loss_error"]() < 1e-12,
    "ex14_pendulum_on_a_rod": lambda x: x["distance"]() < 1e-8,
    "ex15_slider_crank": corners_close,
    "ex16_pi_from_collisions": lambda x: [x["collisions"](k) for k in range(4)] == [3, 31, 314, 3141],
    "ex17_gas_between_walls": lambda x: x["distance_from_sorting"]() < 1e-13,
    "ex18_chain_at_a_wall": lambda x: x["largest_error"]() < 1e-6,
    "ex19_grazing": lambda x: x["largest_error"]() < 1e-3,
    "ex20_ball_on_a_table": lambda x: x["release_error"]() < 1e-10,
    "ex21_dry_friction": lambda x: x["rest_error"]() < 1e-11,
    "ex22_woodpecker": lambda x: x["period"]() == near(0.146, 5e-4),
    "ex23_painleve_rod": painleve,
    "ex24_stick_slip": lambda x: x["period_error"]() < 1e-10,
    "ex25_two_stiffnesses": two_orbits,
    "ex26_double_pendulum_film": lambda x: x["distance"]() < 1e-7,
    "ex27_slope_landing": landing,
    "ex31_four_methods": in_their_order,
    "ex32_work_precision": orders,
    "ex33_error_bars": bar,
    "ex34_audit": audited,
    "ex35_proof": proved,
    "ex36_string_over_an_obstacle": lambda x: x["edge_error"]() < 1e-3,
    "ex37_in_another_program": lambda x: x["distance"](*x["found"]) < 1e-12,
    "ex41_chapter_2_flips": lambda x: x["multiplier_at_the_flip"]() == near(-1.0, 1e-9),
    "ex42_chapter_3_chaotic_cam": lambda x: x["exponent"]().largest == near(0.41, 0.05),
    "ex43_chapter_4_bifurcation_diagram": lambda x: x["flip"]() == near(739.3197802, 1e-7),
    "ex44_chapter_4_basins": basins,
    "ex45_chapter_5_corner_impact": lambda x: x["at"].p == near(673.234445004, 1e-8),
    "ex46_chapter_6_border_collisions": scenarios,
    "ex47_chapter_7_anti_lock_brake": lambda x: x["cycle"]().period == near(0.656147515455, 1e-11),
}


def test_every_example_has_a_number():
    assert set(PINNED) == set(EXAMPLES)
    assert len(EXAMPLES) >= 25


@pytest.mark.parametrize("name", slow(sorted(EXAMPLES), *SLOW, longest=LONGEST))
def test_an_example_draws_and_its_number_is_right(name, monkeypatch, tmp_path):
    if name in NEEDS:
        pytest.importorskip(NEEDS[name])
    monkeypatch.chdir(tmp_path)
    with contextlib.redirect_stdout(io.StringIO()) as said:
        made = runpy.run_path(str(EXAMPLES[name]), run_name="__main__")
    assert said.getvalue()
    assert PINNED[name](made) in (None, True)
    (picture,) = (x for x in tmp_path.iterdir() if x.suffix in (".png", ".gif"))
    assert is_a_picture(picture)


def is_a_picture(file):
    from PIL import Image

    with Image.open(file) as image:
        pixels = np.asarray(image.convert("L"))
        moves = picture_moves(image) if file.suffix == ".gif" else True
    return file.stat().st_size < LARGEST and min(pixels.shape) > 200 and np.ptp(pixels) > 100 and moves


def picture_moves(image):
    first = np.asarray(image.convert("L"))
    image.seek(image.n_frames // 2)
    return bool(np.any(first != np.asarray(image.convert("L"))))


@pytest.mark.parametrize("name", sorted(EXAMPLES))
def test_an_example_says_what_it_shows(name):
    """A title, what it shows and where it is from, at its head; short, and it imports without drawing."""
    text = EXAMPLES[name].read_text()
    title, line, blank, *_ = text.removeprefix('"""').splitlines()
    assert line == "=" * len(title)
    assert blank == ""
    assert "Source" in text.split('"""')[1] or name == "ex05_kept_and_sent"
    assert 'if __name__ == "__main__":' in text
    assert len(text.splitlines()) <= 80


@pytest.mark.parametrize(
    "page",
    [
        pytest.param("README.md", marks=pytest.mark.slow),
        pytest.param("docs/index.md", marks=pytest.mark.thorough),
        pytest.param("docs/first-five-minutes.md", marks=pytest.mark.slow),
        "docs/large-systems.md",
        "docs/tutorial.md",
        pytest.param("docs/symbolic.md", marks=pytest.mark.slow),
        pytest.param("docs/hybrid-systems.md", marks=pytest.mark.slow),
        pytest.param("docs/seeing-and-keeping.md", marks=pytest.mark.slow),
        pytest.param("docs/accuracy.md", marks=pytest.mark.slow),
        pytest.param("docs/attractors.md", marks=pytest.mark.slow),
    ],
)
def test_documentation_runs(page, monkeypatch, tmp_path, capsys):
    pytest.importorskip("sympy")
    pytest.importorskip("flint")
    monkeypatch.chdir(tmp_path)
    source = tmp_path / "page.py"
    text = "\n".join(blocks((ROOT / page).read_text()))
    source.write_text(text)
    runpy.run_path(str(source))
    assert capsys.readouterr().out or "print(" not in text


def blocks(text):
    return [block.split("```")[0] for block in text.split("```python\n")[1:]]
