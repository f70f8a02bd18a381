"""Files that were damaged since they were written are noticed, said, and made again; results stay what they were."""

import json
import logging

import numpy as np
import pytest

from lagrangian import scenes
from lcpstep import Moreau
from lcpstep.accuracy.study import study
from lcpstep.accuracy.work_precision import Study, checksum
from lcpstep.errors import SweepStopped
from lcpstep.sweep import MANIFEST, sweep
from tests.analysis.test_sweeps import squares

CHAINS = [[[1], [2], [3]], [[10, 20]]]


def empty(content):
    return b""


def half(content):
    return content[: len(content) // 2]


def noise(content):
    return np.random.default_rng(len(content)).bytes(len(content))


def one_bit(content):
    """A bit of the middle, which lies in the numbers."""
    k = len(content) // 2
    return content[:k] + bytes([content[k] ^ 1]) + content[k + 1 :]


damages = pytest.mark.parametrize("damage", [empty, half, noise, one_bit])


def numbers(results):
    return [[part["squares"].tolist() for part in chain] for chain in results]


def words(caplog):
    """What sweeps and studies said; kernels may tell that they are being compiled."""
    return [
        x.getMessage() for x in caplog.records if x.name in ("lcpstep.sweep", "lcpstep.accuracy.question")
    ]


def spoil(file, damage):
    file.write_bytes(damage(file.read_bytes()))


@damages
@pytest.mark.parametrize("name", ["part-00000-00001.npz", MANIFEST])
def test_a_damaged_part_is_made_again(tmp_path, caplog, name, damage):
    whole = numbers(sweep(squares, CHAINS, {"a": 1}, out=tmp_path / "s"))
    spoil(tmp_path / "s" / name, damage)
    for said in (1, 0):  # the second time all is whole again
        caplog.clear()
        assert numbers(sweep(squares, CHAINS, {"a": 1}, out=tmp_path / "s")) == whole
        assert [name in x for x in words(caplog)] == said * [True]


def test_no_flipped_bit_of_a_part_changes_the_result(tmp_path):
    chain = [[[3, 4]]]
    whole = numbers(sweep(squares, chain, {}, out=tmp_path / "s"))
    file = tmp_path / "s" / "part-00000-00000.npz"
    content = file.read_bytes()
    for k in range(0, 8 * len(content), 97):
        flipped = bytearray(content)
        flipped[k // 8] ^= 1 << (k % 8)
        file.write_bytes(flipped)
        assert numbers(sweep(squares, chain, {}, out=tmp_path / "s")) == whole


def test_parts_of_another_sweep_under_a_damaged_manifest_are_not_taken(tmp_path, caplog):
    sweep(squares, CHAINS, {"a": 1}, out=tmp_path / "s")
    spoil(tmp_path / "s" / MANIFEST, half)
    doubled = [[[2 * x for x in part] for part in chain] for chain in CHAINS]
    found = numbers(sweep(squares, doubled, {"a": 2}, out=tmp_path / "s"))
    assert found == numbers(sweep(squares, doubled, {"a": 2}))
    assert len(words(caplog)) == 5


def test_a_manifest_without_a_digest_is_another_sweep(tmp_path):
    sweep(squares, CHAINS, {"a": 1}, out=tmp_path / "s")
    (tmp_path / "s" / MANIFEST).write_text(json.dumps({"sweep": {"a": 1}}))
    with pytest.raises(SweepStopped, match="another sweep"):
        sweep(squares, CHAINS, {"a": 1}, out=tmp_path / "s")


def small_study(file):
    return study(scenes.bouncing_ball(t_end=0.5), Moreau(), h=[1e-2], spread=(1.0,), repeats=1, save=file)


def another_version(content):
    stored = json.loads(content)
    del stored["checksum"]
    stored["levels"][0]["colour"] = "red"
    return json.dumps(stored | {"checksum": checksum(stored)}).encode()


def changed_digit(content):
    return content.replace(b'"steps": 50', b'"steps": 51')


@pytest.mark.parametrize("damage", [empty, half, noise, one_bit, another_version, changed_digit])
def test_a_damaged_study_is_put_aside_and_starts_anew(tmp_path, caplog, damage):
    file = tmp_path / "study.json"
    whole = small_study(file)
    spoil(file, damage)
    again = small_study(file)
    assert [x.errors for x in again.levels] == [x.errors for x in whole.levels]
    assert ["study.json.damaged" in x for x in words(caplog)] == [True]
    assert (tmp_path / "study.json.damaged").exists()
    assert Study.load(file).finished


def test_a_file_that_was_never_a_study_is_refused_and_left_alone(tmp_path):
    file = tmp_path / "package.json"
    file.write_text('{"name": "something else"}')
    with pytest.raises(ValueError, match="holds no study"):
        small_study(file)
    assert json.loads(file.read_text()) == {"name": "something else"}


@pytest.fixture(autouse=True)
def heard(caplog):
    caplog.set_level(logging.WARNING, logger="lcpstep.sweep")
    caplog.set_level(logging.WARNING, logger="lcpstep.accuracy.question")
