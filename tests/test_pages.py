"""The documentation as pages: links lead somewhere, every public name is in the reference, the site builds."""

import importlib
import inspect
import re
import subprocess
import sys
from dataclasses import fields, is_dataclass
from pathlib import Path

import pytest

import lagrangian
import lcpstep
from lagrangian import scenes
from lcpstep.trajectory import Counts

ROOT = Path(__file__).resolve().parent.parent
PAGES = [
    ROOT / "README.md",
    ROOT / "CHANGELOG.md",
    *sorted((ROOT / "docs").glob("*.md")),
    *sorted((ROOT / "docs" / "api").glob("*.md")),
    ROOT / "benchmarks" / "README.md",
]
LINK = re.compile(r"\]\(([^)\s]+)\)")
FENCED = re.compile(r"^```.*?^```", re.MULTILINE | re.DOTALL)
MADE = {"gallery/index.rst"}  # by the build


def anchors(file):
    """Anchors of the headings of a page, as forges and the site make them."""
    heads = re.findall(r"^#+ (.+)$", FENCED.sub("", file.read_text()), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", head.lower()).replace(" ", "-") for head in heads}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_lead_somewhere(page):
    for link in LINK.findall(FENCED.sub("", page.read_text())):
        if link.startswith(("http://", "https://", "mailto:")) or link in MADE:
            continue
        path, _, anchor = link.partition("#")
        target = (page.parent / path).resolve() if path else page
        assert target.exists(), f"{page.name}: {link}"
        assert target.is_relative_to(ROOT), f"{page.name}: {link}"
        if anchor and target.suffix == ".md":
            assert anchor in anchors(target), f"{page.name}: {link}"


def test_every_page_is_in_the_site():
    """A page that no table of contents names would not be found."""
    docs = ROOT / "docs"
    named = set()
    for page in (docs / "index.md", docs / "guide.md", docs / "api" / "index.md"):
        for block in re.findall(r"```\{toctree\}\n(.*?)```", page.read_text(), re.DOTALL):
            names = [line for line in block.splitlines() if line and not line.startswith(":")]
            named |= {(page.parent / name).relative_to(docs).as_posix() for name in names}
    pages = {file.relative_to(docs).with_suffix("").as_posix() for file in docs.rglob("*.md")}
    assert pages - named == {"index"}
    assert named - pages == {"gallery/index"}


def in_the_reference():
    text = "".join(file.read_text() for file in (ROOT / "docs" / "api").glob("*.md"))
    whole = [importlib.import_module(name) for name in re.findall(r"\.\. automodule:: ([\w.]+)", text)]
    named = set(re.findall(r"\.\. auto(?:class|function):: ([\w.]+)", text))
    return named | {f"{module.__name__}.{name}" for module in whole for name in module.__all__}


def test_every_public_name_is_in_the_reference():
    named = {name.rpartition(".")[2] for name in in_the_reference()}
    packages = [lcpstep, lagrangian, scenes]
    packages += [importlib.import_module(f"lcpstep.{name}") for name in ("lcp", "maps", "analysis.proofs")]
    for package in packages:
        for name in package.__all__:
            if isinstance(getattr(package, name), type) or callable(getattr(package, name)):
                assert name in named, f"{package.__name__}.{name}"


@pytest.mark.parametrize("name", sorted(in_the_reference()))
def test_what_the_reference_names_exists_and_is_described(name):
    module, _, own = name.rpartition(".")
    found = getattr(importlib.import_module(module), own)
    assert found.__doc__ or isinstance(found, dict)


def classes_in_the_reference():
    """Names of the classes, and the options that their members are listed by."""
    text = "".join(file.read_text() for file in (ROOT / "docs" / "api").glob("*.md"))
    return re.findall(r"\.\. autoclass:: ([\w.]+)\n((?:   :.*\n)*)", text)


@pytest.mark.parametrize(("name", "options"), classes_in_the_reference())
def test_the_reference_lists_what_classes_inherit(name, options):
    module, _, own = name.rpartition(".")
    of = getattr(importlib.import_module(module), own)
    bases = [x for x in of.__mro__[1:] if x.__module__.startswith(("lcpstep", "lagrangian"))]
    inherited = {
        key for x in bases for key, own in vars(x).items()
        if not key.startswith("_") and key not in vars(of) and (callable(own) or isinstance(own, property))
    }  # fmt: skip
    assert not inherited or ":inherited-members:" in options, sorted(inherited)


@pytest.mark.parametrize("of", [lcpstep.Status, lcpstep.Kind, Counts])
def test_each_outcome_is_described_where_help_shows_it(of):
    names = [x.name for x in (fields(of) if is_dataclass(of) else of)]
    assert re.findall(r"^(\w+) : \S", inspect.getdoc(of), re.MULTILINE) == names


WRITTEN = ("index", "first-five-minutes", "guide", "gallery/index", "api/simulating", "accuracy")
SITE = """
import gc, sys
from sphinx.application import Sphinx

gc.disable()  # which takes a fifth
docs, site, trees, *written = sys.argv[1:]
app = Sphinx(docs, docs, site, trees, "html", {"plot_gallery": "0"}, status=None, warningiserror=True)
app.builder.search = False  # whose index would lack the pages that are not written
app.build(filenames=written)
for page in app.env.all_docs:
    app.env.get_and_resolve_doctree(page, app.builder)
sys.exit(app.statuscode)
"""


@pytest.mark.slow
def test_the_site_builds_without_warnings(tmp_path):
    """Of all pages, of which some are written, and without the gallery's examples, which other tests run."""
    suffixes = {"gallery/index": "rst"}
    pages = [str(ROOT / "docs" / f"{page}.{suffixes.get(page, 'md')}") for page in WRITTEN]
    words = [sys.executable, "-c", SITE, ROOT / "docs", tmp_path / "site", tmp_path / "trees", *pages]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert all((tmp_path / "site" / f"{page}.html").is_file() for page in WRITTEN)
    front = (tmp_path / "site" / "index.html").read_text()
    assert "cam.gif" in front
    assert "gallery/index.html" in front


PROSE = [
    page for page in PAGES if page.name not in {"CHANGELOG.md", "hard-cases.md", "reproducing-the-thesis.md"}
]
WIDEST = 118


@pytest.mark.parametrize("page", PROSE, ids=lambda page: str(page.relative_to(ROOT)))
def test_lines_of_prose_are_wrapped(page):
    """Not those of code, tables, headings and pictures; pages that are made by a command are as it makes them."""
    for line in FENCED.sub("", page.read_text()).splitlines():
        if len(line) > WIDEST and not re.match(r"\s*(\||#|!\[)|    |<", line):
            pytest.fail(f"{page.name}: {line[:80]}...")
