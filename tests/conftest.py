"""Tests of what is built are tests of its sources: refused where these have changed since.

Drawn cases are the same at every run, so that a change is judged by itself; `--hypothesis-profile=random` draws
others. None has a deadline: what it took would be that of whatever else the machine does.
"""

import gc
import importlib.machinery
from importlib.util import find_spec

import pytest
from hypothesis import settings

import start
from tests.uncompiled import BUILT, MERGED

settings.register_profile("random", deadline=None)
settings.register_profile("repeated", deadline=None, derandomize=True, max_examples=40)
settings.load_profile("repeated")


OF_NUMBA = (
    "test_callback_errors",
    "test_callbacks",
    "test_compiled_by_users",
    "test_numba_made",
    "lagrangian/test_symbolic",
)
collect_ignore = [] if find_spec("numba") else [f"{name}.py" for name in OF_NUMBA]


def pytest_configure(config):
    """Compare times of sources with those of what was built from them."""
    read_by_all = [start.ROOT / file for file in start.MADE_BY]
    read_by_all += [file for name in MERGED for file in (BUILT[name], BUILT[name].with_suffix(".pxd"))]
    for name, source in BUILT.items():
        for suffix in importlib.machinery.EXTENSION_SUFFIXES:
            built = source.with_suffix(suffix)
            files = source, source.with_suffix(".pxd"), *read_by_all
            newest = max(file.stat().st_mtime for file in files if file.exists())
            if built.exists() and built.stat().st_mtime < newest:
                raise pytest.UsageError(
                    f"{name} has changed since it was built: python setup.py build_ext --inplace"
                )


def pytest_collection_finish(session):
    """What has been loaded by now stays to the end: looks at it for garbage are in vain, and take a thirtieth."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(50_000, 20, 50)


@pytest.fixture
def sparse_steps(monkeypatch):
    """Sparse scenes take sparse steps however small they are."""
    from lcpstep.stepping.sparse import coupled, steps

    monkeypatch.setattr(steps, "FEW", 0)
    monkeypatch.setattr(coupled, "FEW", 0)


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """An empty folder to work in."""
    monkeypatch.chdir(tmp_path)
    return tmp_path
