"""The library's own sources in the place of what is built from them."""

import importlib
import importlib.util
import shutil
import sys
import tempfile
from functools import cache
from pathlib import Path
from types import SimpleNamespace

import lcpstep
from tests.processes import python

ROOT = Path(lcpstep.__file__).parent
sys.path.insert(0, str(ROOT.parent))  # where what builds it lies
kernel_sources = importlib.import_module("kernel_sources")
MERGED = kernel_sources.MERGED  # into others
BUILT = {name: kernel_sources.path_of(ROOT.parent, name) for name in kernel_sources.kernels(ROOT.parent)}


class Sources:
    """Finds the `.py` file of a module, whatever is built."""

    @staticmethod
    def find_spec(name, path=None, target=None):
        return importlib.util.spec_from_file_location(name, BUILT[name]) if name in BUILT else None


def kernels(package="lcpstep"):
    """A package's kernel modules as plain Python, by their last names; those that are built stay where they are."""
    for name in BUILT:  # whatever else these load belongs to what is built
        importlib.import_module(name)
    before = {name: sys.modules.pop(name) for name in BUILT}
    sys.meta_path.insert(0, Sources)
    try:
        modules = {name: importlib.import_module(name) for name in BUILT if name.startswith(package)}
        return SimpleNamespace(**{name.split(".")[-1]: module for name, module in modules.items()})
    finally:
        sys.meta_path.remove(Sources)
        for name in BUILT:
            sys.modules.pop(name, None)
        for name, module in before.items():
            sys.modules[name] = module
            package, last = name.rsplit(".", 1)
            setattr(sys.modules[package], last, module)


@cache
def sources():
    """Where the packages' sources lie alone, once for the tests of a process: bytecode of them takes long."""
    skipped = shutil.ignore_patterns("*.so", "*.pyd", "__pycache__")
    folder = tempfile.TemporaryDirectory()
    for package in ("lcpstep", "lagrangian"):
        shutil.copytree(ROOT.parent / package, Path(folder.name, package), ignore=skipped)
    return folder


def without_what_is_built(program):
    """What a program prints where the library is not built."""
    home = sources().name
    plain = {"PYTHONPATH": home, "NUMBA_DISABLE_JIT": "1", "PYTHONDONTWRITEBYTECODE": ""}
    return python(program, cwd=home, **plain)


def both_ways(program):
    """Lines that a program prints where the library is built, and where it is not."""
    asked = "from lcpstep.kernels import clock\nprint(clock.__file__)\n" + program
    built = python(asked, NUMBA_DISABLE_JIT="1").splitlines()
    plain = without_what_is_built(asked).splitlines()
    assert plain[0].endswith(".py")
    assert not built[0].endswith(".py")
    return built[1:], plain[1:]
