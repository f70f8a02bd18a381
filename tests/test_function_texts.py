"""What a saved run says of its functions: their text and checksum are those of the functions that ran."""

from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader

from lcpstep import functions

STIFFNESS = 5.0


def force(t, q, v, p, out):
    out[0] = -STIFFNESS * q[0]


def test_a_function_is_told_by_what_it_reads_now(monkeypatch):
    before = functions.checksum(force)
    monkeypatch.setitem(globals(), "STIFFNESS", 7.0)
    assert functions.checksum(force) != before


def test_text_of_a_file_that_was_edited_meanwhile_is_not_taken_for_the_function_that_runs(tmp_path):
    file = tmp_path / "edited.py"
    for edited in ("def f(x):\n    return 3.0 * x\n", "f = (\n"):
        file.write_text("def f(x):\n    return 2.0 * x\n")
        module = module_from_spec(spec_from_loader("edited", SourceFileLoader("edited", str(file))))
        module.__loader__.exec_module(module)
        file.write_text(edited)
        functions.source_of.cache_clear()
        assert functions.described(module.f)["source"] == ""
