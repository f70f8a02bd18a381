"""Maps of one's own, in a file: taken, refused by name, and classified at their borders."""

import json

import numpy as np
import pytest

from lcpstep.analysis.map_diagram import Escaped, settled
from lcpstep.cli.common import DONE, USAGE
from lcpstep.errors import UnknownName
from lcpstep.maps.formulas import MAPS, Family, from_file, named
from tests.commands import run_map
from tests.marks import slow

# --- maps of one's own


HENON = '''"""The map of Henon."""
PARAMETERS = {"a": 1.4, "b": 0.3}
RANGES = {"a": (0.0, 1.5)}
X0 = [0.1, 0.1]


def image(x, p):
    return [1 - p["a"] * x[0] ** 2 + x[1], p["b"] * x[0]]
'''


@pytest.mark.slow
def test_a_map_of_ones_own(capsys, tmp_path):
    file = tmp_path / "henon.py"
    file.write_text(HENON)
    status, out, _ = run_map(capsys, file, "--json", "--keep", 1500)
    assert status == DONE
    found = json.loads(out)
    assert found["orbit"] == "chaotic"
    assert found["lyapunov"] == pytest.approx(0.4192, abs=4.0 * found["lyapunov_error"])  # widely published
    a, b = 1.4, 0.3
    roots = np.sort(np.roots([a, 1.0 - b, -1.0]))
    ones = [p for p in found["periodic"] if p["period"] == 1]
    assert np.sort([p["points"][0][0] for p in ones]) == pytest.approx(roots, abs=1e-10)
    for p in ones:
        product = complex(*p["multipliers"][0]) * complex(*p["multipliers"][1])
        assert product.real == pytest.approx(-b, abs=1e-8)
    arguments = (file, "--parameter", "a", "--range", 0.2, 1.4, "--points", 20, "--keep", 30, "--drop", 100)
    assert run_map(capsys, *arguments, "--out", tmp_path / "out")[0] == DONE
    assert sorted(x.name for x in (tmp_path / "out").iterdir()) == ["map.nc", "map.png"]
    status, _, err = run_map(capsys, *arguments, "--out", tmp_path / "out")
    assert status == USAGE
    assert "exists already; --overwrite" in err


def test_a_diagram_prints_json(capsys, tmp_path):
    """The logistic map has period four at r = 3.5 and is chaotic at 4."""
    words = ("logistic", "--range", 3.5, 4.0, "--points", 2, "--drop", 500, "--keep", 200, "--json")
    status, out, err = run_map(capsys, *words, "--out", tmp_path)
    assert status == DONE
    found = json.loads(out)
    assert (found["parameter"], found["values"], found["positive_exponent"]) == ("r", [3.5, 4.0], 1)
    assert "wrote" in err


def test_an_orbit_that_leaves_all_bounds_says_so(capsys):
    family = Family("away", lambda x, p: 3.0 * x, [1.0])
    with pytest.raises(Escaped, match="left all bounds after 14 iterations"):
        settled(family.at(), [1.0], 100, 10)
    status, out, _ = run_map(capsys, "border-collision", "--set", "tau_plus=3", "--json")
    assert status == DONE
    assert "left all bounds" in json.loads(out)["orbit"]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("def imag(x, p):\n    return x\n", r"has no function image\(x, parameters\); it has imag"),
        ("PARAMETERS = {}\n", r"has no function image\(x, parameters\)$"),
        (
            "def image(x):\n    return x\n",
            r"expected a function of two arguments \(x, parameters\), got image\(x\)",
        ),
        ("image = 3\n", "expected a function"),
        (
            "X0 = [0.1, 0.2]\ndef image(x, p):\n    return x[0]\n",
            r"image must give shape \(2,\) for x of shape \(2,\)",
        ),
        ("def image(x, p):\n    return 'x'\n", "image must give numbers, got 'x'"),
        ("def image(x, p):\n    return p['a'] * x\n", "raised KeyError: 'a'"),
        ("def image(x, p) return x\n", "does not run: SyntaxError"),
        (
            "def image(x, p):\n    return x\ndef derivative(x, p):\n    return [1.0, 2.0]\n",
            r"derivative must give shape \(1, 1\)",
        ),
        ("PARAMETERS = {'a': 'b'}\ndef image(x, p):\n    return x\n", "a: expected"),
        (
            "PARAMETERS = {'a': 2}\nRANGES = {'a': (0, 1)}\ndef image(x, p):\n    return x\n",
            r"a: expected .*\[0, 1\]",
        ),
        (
            "PARAMETERS = {'a': 2}\nRANGES = {'a': 1}\ndef image(x, p):\n    return x\n",
            "expected \\(lowest, highest\\)",
        ),
        ("RANGES = {'a': (0, 1)}\ndef image(x, p):\n    return x\n", "unknown parameter of own 'a'"),
    ],
)
def test_a_file_that_is_no_map_is_named(tmp_path, text, said):
    file = tmp_path / "own.py"
    file.write_text(text)
    with pytest.raises(ValueError, match=said):
        from_file(file)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["logistik"], "unknown map 'logistik'; did you mean 'logistic'?"),
        (["piecewise"], "did you mean 'piecewise-linear'?"),
        (["no-such.py"], "there is no file no-such.py"),
        (["logistic", "--set", "r=5"], "r: expected a value in [0, 4]"),
        (["logistic", "--set", "q=1"], "unknown parameter of logistic 'q'"),
        (["logistic", "--set", "r"], "--set: expected NAME=VALUE"),
        (["logistic", "--range", "3", "2"], "--range: expected LOW < HIGH"),
        (["logistic", "--range", "3", "5", "--out", "no"], "r: expected a value in [0, 4]"),
        (
            ["logistic", "--range", "2", "3", "--parameter", "rr", "--out", "no"],
            "unknown parameter of logistic 'rr'",
        ),
        (["logistic", "--box", "1"], "--box: expected 2 numbers"),
        (["logistic", "--x0", "1", "2"], "x"),
        (["logistic", "--C", "1"], "--C: only piecewise-linear takes matrices"),
        (["piecewise-linear"], "--A-minus: piecewise-linear needs"),
    ],
)
def test_wrong_arguments_are_named(capsys, arguments, said):
    status, _, err = run_map(capsys, *arguments)
    assert status == USAGE
    assert said in err


@pytest.mark.slow
def test_every_ready_map_runs_from_its_defaults(capsys):
    for name in MAPS:
        assert run_map(capsys, name, "--keep", 60)[0] == DONE
    with pytest.raises(UnknownName):
        named("tent")


# --- border collisions of a map of one's own


BENT = """import math

PARAMETERS = {"a": 0.4, "k": %(k)r}
X0 = [0.1, 0.0]


def side(x, p):  # a curved border, which the fixed point meets in the origin where a = 1
    return x[0] + 0.5 * x[0] * x[1]


def image(x, p):
    m, slope = p["a"] - 1.0, %(minus)r if side(x, p) < 0 else %(plus)r
    bend = slope * side(x, p)
    return [m + bend + x[1] + p["k"] * x[0] * x[1], -0.3 * x[0] + p["k"] * math.sin(x[1]) ** 2]
"""


@pytest.mark.parametrize(("minus", "plus"), [(0.4, -1.6), (0.3, -0.6), (1.6, 0.2), (-1.5, 0.5), (0.1, -2.9)])
@pytest.mark.parametrize("k", slow([0.0, 0.2], longest=[0.0]))
def test_the_border_of_ones_own_map_is_found_and_classified(capsys, tmp_path, minus, plus, k):
    file = tmp_path / "bent.py"
    file.write_text(BENT % {"minus": minus, "plus": plus, "k": k})
    status, out, _ = run_map(capsys, file, "--parameter", "a", "--near", 0.8, "--json")
    assert status == DONE
    found = json.loads(out)
    assert found["value"] == pytest.approx(1.0, abs=1e-10)
    assert found["x"] == pytest.approx([0.0, 0.0], abs=1e-10)
    # side = x1 + .. at the origin, where bend = slope x1: companion matrices of trace `slope`, determinant 0.3
    for name, slope in (("A_minus", minus), ("A_plus", plus)):
        np.testing.assert_allclose(found["local"][name], [[slope, 1.0], [-0.3, 0.0]], atol=1e-8)
    for name in ("B_minus", "B_plus", "C"):
        assert found["local"][name] == pytest.approx([1.0, 0.0], abs=1e-8)
    values = {"tau_minus": minus, "delta_minus": 0.3, "tau_plus": plus, "delta_plus": 0.3}
    settings = [f"{name}={x}" for name, x in values.items()]
    expected = json.loads(run_map(capsys, "border-collision", "--set", *settings, "--json")[1])
    assert found["border_collision"] == expected["border_collision"]


def test_a_map_without_a_border_is_named(capsys, tmp_path):
    status, _, err = run_map(capsys, "logistic", "--near", 3)
    assert status == USAGE
    assert "logistic: has no border; give a function side(x, parameters)" in err
    file = tmp_path / "own.py"
    file.write_text("def side(x):\n    return x[0]\n\n\ndef image(x, p):\n    return x\n")
    with pytest.raises(ValueError, match=r"side: expected a function of two arguments"):
        from_file(file)


def test_a_map_that_is_still_on_its_way_is_not_said_to_have_twice_its_period(capsys):
    # At r = 2.995 the point of period one is stable, with the multiplier 2 - r
    found = json.loads(run_map(capsys, "logistic", "--set", "r=2.995", "--drop", 1500, "--json")[1])
    assert found["orbit"].startswith("unsettled, nearing a periodic orbit")
    assert found["lyapunov"] == pytest.approx(np.log(0.995), abs=1e-4)
    found = json.loads(run_map(capsys, "logistic", "--set", "r=2.995", "--drop", 9000, "--json")[1])
    assert found["orbit"] == "period 1"
