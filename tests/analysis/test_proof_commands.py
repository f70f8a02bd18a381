"""`--prove` of the commands orbit and corner."""

import json
import re

import pytest

from lcpstep.cli import corner, main
from lcpstep.cli.common import DONE, FAILED, USAGE


def run(capsys, *arguments):
    status = main([str(x) for x in arguments])
    return status, *capsys.readouterr()


def test_orbit_proves_what_it_found(capsys):
    status, out, _ = run(capsys, "orbit", "cam-follower", "--rpm", 700, "--prove")
    assert status == DONE
    assert "proved: O(1, 1) exists, and touches nothing between its impacts; stable" in out
    assert "impact of contact 0 at t = [0.01554849657208303387" in out


def test_orbit_says_why_it_cannot(capsys):
    status, out, _ = run(capsys, "orbit", "cam-follower", "--rpm", 150, "--prove")
    assert status == FAILED
    assert "not proved: O(1, chattering): the motion sticks to the obstacle or chatters" in out
    status, _, err = run(
        capsys, "orbit", "stick-slip-oscillator", "--mode", "stick", "--transient", 3, "--prove"
    )
    assert status == USAGE
    assert "--prove" in err


def test_chattering_sequences_are_not_proved(capsys):
    status, _, err = run(capsys, "corner", "cam-follower", "--chattering", 115, 116, "--prove")
    assert status == USAGE
    assert "--prove" in err


@pytest.mark.slow
def test_a_flip_over_another_parameter_is_proved_at_its_speed(capsys, tmp_path):
    status, out, _ = run(
        capsys, "orbit", "impact-oscillator", "--set", "omega=2.65", "--transient", 300, "--parameter", "stop",
        "--range", -0.05, 0.1, "--out", tmp_path, "--prove",
    )  # fmt: skip
    assert status == DONE
    assert "flip          at stop = 0.0042177355" in out
    assert float(re.search(r"omega: \[([0-9.]+)", out)[1]) == pytest.approx(2.65, abs=1e-14)


@pytest.mark.thorough
def test_orbit_proves_the_special_points_of_its_branch(capsys, tmp_path):
    status, out, _ = run(
        capsys, "orbit", "cam-follower", "--rpm", 700, "--transient", 200, "--range", 660, 760, "--out", tmp_path,
        "--prove",
    )  # fmt: skip
    assert status == DONE
    assert "proved: corner of O(1, 1) at [673.2344450038" in out
    assert "proved: flip of O(1, 1) at [739.3197802160016547615995" in out


@pytest.mark.slow
def test_corner_proves_what_it_found(capsys):
    status, out, _ = run(capsys, "corner", "cam-follower", "--prove", "--json")
    assert status == DONE
    proof = json.loads(out)["proof"]
    assert proof["proved"]
    assert 673.2344450037 < proof["rpm"][0] < proof["rpm"][1] < 673.2344450039
    assert "proved: corner of O(1, 1) at [673.2344450038" in corner._text(json.loads(out), ["q [m]"])
