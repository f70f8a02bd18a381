"""The library's own sources in the place of what is built from them."""

import importlib
import importlib.util
import shutil
import sys
from pathlib import Path
from types import SimpleNamespace

import lcpstep

ROOT = Path(lcpstep.__file__).parent
BUILT = {
    ".".join(("lcpstep", *header.relative_to(ROOT).with_suffix("").parts)): header.with_suffix(".py")
    for header in ROOT.rglob("*.pxd")
}


class Sources:
    """Finds the `.py` file of a module, whatever is built."""

    @staticmethod
    def find_spec(name, path=None, target=None):
        return importlib.util.spec_from_file_location(name, BUILT[name]) if name in BUILT else None


def kernels(package="lcpstep"):
    """A package's kernel modules as plain Python, by their last names; those that are built stay where they are."""
    before = {name: sys.modules.pop(name) for name in BUILT if name in sys.modules}
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
