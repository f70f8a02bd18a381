"""Kernels are translated with headers that are read once: it is the C that Cython makes of each module by itself."""

import re
import sys

import pytest

from tests.processes import ROOT, python

# A class that others inherit, inline functions, modules that use both, and one without a header
NAMES = (
    "lcpstep.kernels.course",
    "lcpstep.kernels.record",
    "lcpstep.stepping.pieces.glide",
    "lcpstep.kernels.ready",
)
SETUP = f"""
import sys
sys.path.insert(0, {str(ROOT)!r})
import setup, translating
"""
pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="elsewhere Cython translates each by itself")


def written(folder):
    """Lines of the C files, without what Cython notes of the request; headers are included in another order."""
    texts = {file.relative_to(folder): file.read_text() for file in folder.rglob("*.c")}
    asked = re.compile(r"/\* BEGIN: Cython Metadata.*?END: Cython Metadata \*/\n", re.DOTALL)
    return {name: sorted(filter(None, asked.sub("", text).split("\n"))) for name, text in texts.items()}


@pytest.mark.slow
def test_modules_become_what_they_become_by_themselves(tmp_path):
    python(f"""{SETUP}
modules = {{m.name: m for m in setup.extensions() if m.name in {NAMES!r}}}
target = {str(tmp_path / "once")!r} + "/{{}}.c"
sources = {{n: (m.sources[0], target.format(m.sources[0].rpartition(".")[0])) for n, m in modules.items()}}
assert translating.translate(sources, setup.DIRECTIVES, 2) == []
asked = dict(force=True, quiet=True, compiler_directives=setup.DIRECTIVES)
setup.cythonize(list(modules.values()), build_dir={str(tmp_path / "each")!r}, **asked)
""")
    once, each = written(tmp_path / "once"), written(tmp_path / "each")
    assert len(each) == len(NAMES)
    for name, lines in each.items():
        assert once[name] == lines, name


def test_what_cannot_be_translated_so_is_told(tmp_path):
    (tmp_path / "fine.py").write_text("def f(x):\n    return x\n")
    (tmp_path / "broken.py").write_text("def f(x:\n")
    program = f"""{SETUP}
names = ("fine", "broken")
print(translating.translate({{n: (n + ".py", "c/" + n + ".c") for n in names}}, setup.DIRECTIVES, 2))
"""
    said = python(program, cwd=tmp_path).splitlines()
    assert said[:2] == ["[1/2] Cythonizing fine.py", "[2/2] Cythonizing broken.py"]
    assert said[-1] == "['broken']"
    assert (tmp_path / "c" / "fine.c").exists()
