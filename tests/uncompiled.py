"""The library's own sources in the place of what is built from them."""

import importlib
import importlib.util
import shutil
import sys
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


def copy_without_what_is_built(folder):
    """The packages' sources alone, in a folder to be put on the path."""
    skipped = shutil.ignore_patterns("*.so", "*.pyd", "__pycache__")
    for package in ("lcpstep", "lagrangian"):
        shutil.copytree(ROOT.parent / package, folder / package, ignore=skipped)


def both_ways(folder, program):
    """Lines that a program prints where the library is built, and where it is not, in this folder."""
    copy_without_what_is_built(folder)
    asked = "from lcpstep.kernels import clock\nprint(clock.__file__)\n" + program
    built, plain = (
        python(asked, cwd=home, PYTHONPATH=str(home), NUMBA_DISABLE_JIT="1").splitlines()
        for home in (ROOT.parent, folder)
    )
    assert plain[0].endswith(".py")
    assert not built[0].endswith(".py")
    return built[1:], plain[1:]
