"""The commands attractor, bifurcation, basin and orbit: files, numbers, and what wrong arguments get."""

import json
import math

import pytest

from lcpstep.cli.common import DONE, FAILED, USAGE
from tests.commands import run

xarray = pytest.importorskip("xarray")


@pytest.mark.slow
def test_attractor_classifies_saves_and_compares(capsys, tmp_path):
    status, out, _ = run(
        capsys, "attractor", "cam-follower", "--rpm", 358.5, "--starts", 12, "--compare", 400, "--h", 1e-4,
        "--out", tmp_path, "--json",
    )  # fmt: skip
    assert status == DONE
    found = json.loads(out[out.index("{") :])
    assert {a["name"] for a in found["attractors"]} == {"O(3, 8)", "O(1, 2)"}
    assert 0.0 <= found["likeness"]["phase"]["p_value"] <= 1.0
    with xarray.open_dataset(tmp_path / "attractors.nc") as data:
        assert data["start"].shape == (12, 2)
        assert data.attrs["seed"] == 0
    assert (tmp_path / "attractors.png").stat().st_size > 1000


def test_bifurcation_draws_a_window_and_leaves_no_parts(capsys, tmp_path):
    arguments = (
        "bifurcation", "cam-follower", "--window", "660-760", "--points", 10, "--drop", 50, "--keep", 5,
        "--start", "backward", "--jobs", 2, "--out", tmp_path,
    )  # fmt: skip
    assert run(capsys, *arguments)[0] == DONE
    assert sorted(file.name for file in tmp_path.iterdir()) == ["bifurcation.nc", "bifurcation.png"]
    with xarray.open_dataset(tmp_path / "bifurcation.nc") as data:
        assert (float(data["rpm"][0]), float(data["rpm"][-1])) == (660.0, 760.0)
        assert data.sizes["period"] == 5
    status, _, err = run(capsys, *arguments)
    assert status == USAGE
    assert "exists already; --overwrite" in err
    assert run(capsys, *arguments, "--overwrite")[0] == DONE


@pytest.mark.slow
def test_bifurcation_compares_two_methods_in_a_picture_a_file_and_a_table(capsys, tmp_path):
    status, out, _ = run(
        capsys, "bifurcation", "cam-follower", "--window", "690-735", "--points", 4, "--drop", 100, "--keep", 10,
        "--compare", 1e-3, 1e-4, "--out", tmp_path,
    )  # fmt: skip
    assert status == DONE
    assert "same O(n, m)" in out
    names = sorted(file.name for file in tmp_path.iterdir())
    assert names == ["agreement.nc", "bifurcation.nc", "bifurcation.png"]
    with xarray.open_dataset(tmp_path / "agreement.nc") as data:
        assert data["h"].values.tolist() == [1e-3, 1e-4]
        assert data["phase_distance"].shape == (2, 4)
        coarse, fine = data["state_distance"].median("rpm").values
        assert fine < coarse
    assert (tmp_path / "bifurcation.png").stat().st_size > 1000


@pytest.mark.slow
def test_basin_prints_shares_with_their_uncertainty(capsys, tmp_path):
    status, out, _ = run(
        capsys, "basin", "cam-follower", "--rpm", 358.5, "--grid", 40, 30, "--sample", 100, "--out", tmp_path
    )
    assert status == DONE
    assert "O(3, 8)" in out
    assert "+-" in out
    with xarray.open_dataset(tmp_path / "basins.nc") as data:
        assert data["label"].shape == (30, 40)


@pytest.mark.slow
def test_orbit_follows_a_branch_and_names_its_flip(capsys, tmp_path):
    status, out, _ = run(
        capsys, "orbit", "cam-follower", "--rpm", 720, "--transient", 200, "--range", 715, 745,
        "--points", 60, "--out", tmp_path,
    )  # fmt: skip
    assert status == DONE
    assert "O(1, 1), stable" in out
    assert "flip" in out
    assert "739.31978" in out
    with xarray.open_dataset(tmp_path / "branch.nc") as data:
        assert "flip" in data["special_kind"].values


@pytest.mark.slow
def test_orbit_takes_the_period_that_the_motion_settles_to(capsys):
    status, out, _ = run(capsys, "orbit", "cam-follower")
    assert status == DONE
    assert "O(3, 8), stable" in out
    status, out, _ = run(capsys, "orbit", "woodpecker", "--event", "impact", "--cyclic", 0, "--transient", 5)
    assert status == DONE
    assert "stable; period 0.1459760651" in out


@pytest.mark.parametrize(
    ("more", "said"),
    [
        (("--periods", 1), "leave --periods out to take what the motion settles to"),
        (("--guess", 0.02, 9.5), "try another --guess, or other --periods"),
    ],
)
def test_orbit_says_what_to_do_where_it_finds_none(capsys, more, said):
    status, _, err = run(capsys, "orbit", "cam-follower", *more)
    assert status == USAGE
    assert said in err


def test_orbit_says_of_motions_that_do_not_repeat_what_they_may_be(capsys):
    """From where chaos happens to be after the transient, shooting finds an unstable orbit, or none."""
    found = []
    for rpm in (655, 660, 661, 662, 665, 668):
        status, out, err = run(capsys, "orbit", "cam-follower", "--rpm", rpm)
        if status == DONE:
            assert "unstable" in out
        else:
            assert status == USAGE
            assert "it is chaotic (lcpstep attractor tells) or wants a longer --transient" in err
        found.append(status)
    assert USAGE in found


def test_parts_of_another_run_are_not_mixed_with_this_one(capsys, tmp_path):
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "manifest.json").write_text("{}")
    arguments = ("bifurcation", "cam-follower", "--window", "660-760", "--points", 3, "--out", tmp_path)
    status, _, err = run(capsys, *arguments)
    assert status == FAILED
    assert "another sweep" in err


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["bifurcation", "cam-follower", "--window", "660-761"], "did you mean '660-760'"),
        (
            ["bifurcation", "cam-follower", "--window", "660-760", "--parameter", "q0"],
            "give --range, that of q0",
        ),
        (["bifurcation", "cam-follower", "--range", "700", "600"], "--range: expected LOW < HIGH"),
        (["bifurcation", "cam-follower", "--points", "0"], "--points: expected a positive number"),
        (
            ["bifurcation", "cam-follower", "--keep", "0", "--points", "2"],
            "keep: expected a positive integer",
        ),
        (["bifurcation", "impact-oscillator"], "--range: expected LOW HIGH"),
        (
            ["bifurcation", "impact-oscillator", "--range", "1", "2"],
            "--parameter: expected the one of impact-oscillator that varies",
        ),
        (["basin", "cam-follower", "--position", "1", "0"], "--position: expected LOW < HIGH"),
        (["basin", "cam-follower", "--grid", "0", "5"], "--grid: expected a positive integer"),
        (["basin", "impact-oscillator"], "--position, --velocity"),
        (["bifurcation", "impact-oscillator"], "those of impact-oscillator are zeta, omega"),
        (["attractor", "impact-oscillator"], "--box"),
        (
            ["attractor", "impact-oscillator", "--box", "1", "2", "-1", "1"],
            "--box: it lies inside of the obstacle",
        ),
        (
            ["attractor", "cam-follower", "--theta", "1"],
            "--theta: event-driven has none, it belongs to moreau",
        ),
        (["orbit", "cam-follower", "--lcp", "qp"], "--lcp: event-driven has none, it belongs to moreau"),
        (
            ["basin", "cam-follower", "--method", "moreau", "--tolerance", "1e-9"],
            "it belongs to event-driven",
        ),
        (["orbit", "cam-follower", "--contact", "1"], "--contact, --cyclic: they belong to --event"),
        (["attractor", "bouncing-ball"], "has no period, and so no attractors; lcpstep.maps.EventMap"),
        (["attractor", "cam-follower", "--rpm", "-1"], "rpm"),
        (["attractor", "cam-follower", "--starts", "0"], "--starts: expected a positive integer"),
        (["attractor", "cam-follower", "--points", "0"], "points: expected a positive integer"),
        (["attractor", "cam-follower", "--window", "0"], "window: expected a positive integer"),
        (["orbit", "cam-follower", "--periods", "0"], "--periods: expected a positive integer"),
        (["orbit", "cam-follower", "--guess", "1"], "x: expected shape (2,)"),
        (["orbit", "impact-oscillator", "--rpm", "3"], "--rpm"),
    ],
)
def test_wrong_arguments_are_named(capsys, tmp_path, arguments, said):
    status, _, err = run(capsys, *arguments, "--out", tmp_path / "new")
    assert status == USAGE
    assert said in err
    assert not (tmp_path / "new").exists()


def test_a_diagram_without_h_takes_steps_that_suit_every_period_in_it(monkeypatch, capsys, tmp_path):
    from lcpstep.cli import studies

    found = []
    made = studies.moreau
    monkeypatch.setattr(studies, "moreau", lambda *given: found.append(made(*given)) or found[-1])
    words = [
        "bifurcation",
        "impact-oscillator",
        "--parameter",
        "omega",
        "--range",
        "2",
        "100",
        "--points",
        "2",
        "--drop",
        "1",
        "--keep",
        "1",
    ]
    run(capsys, *words, "--method", "moreau", "--out", tmp_path)
    assert found[-1].h == pytest.approx(2.0 * math.pi / 100.0 / 500)
