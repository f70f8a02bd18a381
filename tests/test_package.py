"""What is handed out: one version everywhere, a source archive and a wheel that carry what they need."""

import importlib
import os
import re
import shutil
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from pathlib import Path

import pytest
import yaml

import lcpstep
import start

ROOT = Path(lcpstep.__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
RECIPE = yaml.safe_load((ROOT / "conda/recipe/recipe.yaml").read_text())
CONDA_NAMES = {"matplotlib": "matplotlib-base"}
UNPRIVILEGED: list[str] | None = []  # words before a command that is to keep to permissions
if not hasattr(os, "getuid") or (os.getuid() == 0 and not shutil.which("setpriv")):
    UNPRIVILEGED = None
elif os.getuid() == 0:
    UNPRIVILEGED = ["setpriv", "--bounding-set", "-dac_override"]
OWN_SCENE = """
import lcpstep
from lagrangian import Contacts, Scene, System
from lcpstep import Located, simulate

def mass(t, q, v, p, out):
    out[0, 0] = 1.0

def force(t, q, v, p, out):
    out[0] = -9.81

def gap(t, q, v, p, out):
    out[0] = q[0]

def jacobian(t, q, v, p, out):
    out[0, 0] = 1.0

contacts = Contacts(n_c=1, gap=gap, jacobian=jacobian, restitution=0.5)
scene = Scene(System(n_q=1, mass=mass, force=force), contacts=contacts, q0=[1.0], v0=[0.0], t_span=(0.0, 1.0))
print(simulate(scene, Located(1e-2)).q[-1], lcpstep.__file__)
"""


def workflow(name):
    return yaml.safe_load((ROOT / f".github/workflows/{name}.yml").read_text())


def test_the_version_is_the_same_everywhere():
    cited = yaml.safe_load((ROOT / "CITATION.cff").read_text())["version"]
    released = re.findall(
        r"^## (\d\S+) - \d{4}-\d\d-\d\d$", (ROOT / "CHANGELOG.md").read_text(), re.MULTILINE
    )
    versions = {
        PROJECT["version"],
        lcpstep.__version__,
        str(cited),
        RECIPE["context"]["version"],
        released[0],
    }
    assert len(versions) == 1, versions


def test_the_recipe_asks_for_what_the_package_asks_for():
    wanted = {re.match(r"[\w-]+", bound)[0]: bound for bound in PROJECT["dependencies"]}
    wanted = {bound.replace(name, f"{CONDA_NAMES.get(name, name)} ", 1) for name, bound in wanted.items()}
    assert set(RECIPE["requirements"]["run"]) == {"python"} | wanted


def test_the_recipe_has_what_conda_forge_asks_for():
    """Sections and fields of recipes in its format 1, and placeholders that nobody takes for the real thing."""
    assert RECIPE["schema_version"] == 1
    wanted = {"context", "package", "source", "build", "requirements", "tests", "about", "extra"}
    assert set(RECIPE) - {"schema_version"} == wanted
    assert RECIPE["source"]["url"].endswith("/lcpstep-${{ version }}.tar.gz")
    assert re.fullmatch(r"[0-9a-f]{64}", RECIPE["source"]["sha256"])
    assert {"homepage", "summary", "license", "license_file"} <= set(RECIPE["about"])
    assert (ROOT / RECIPE["about"]["license_file"]).is_file()
    maintainers = RECIPE["extra"]["recipe-maintainers"]
    assert maintainers
    head = (ROOT / "conda/recipe/recipe.yaml").read_text().partition("schema_version")[0]
    assert ("sha256 of zeros" in head) == (set(RECIPE["source"]["sha256"]) == {"0"})
    assert ("YOUR-GITHUB-NAME" in head) == ("YOUR-GITHUB-NAME" in maintainers)
    names = [test["python"]["imports"] for test in RECIPE["tests"] if "python" in test]
    for name in names[0]:
        importlib.import_module(name)


def test_the_workflows_try_every_python_that_the_package_names():
    named = [c.rpartition(" ")[2] for c in PROJECT["classifiers"] if re.search(r":: 3\.\d+$", c)]
    tried = workflow("tests")["jobs"]["tests"]["strategy"]["matrix"]["python"]
    built = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["cibuildwheel"]["build"].split()
    assert tried == named
    assert built == [f"cp{version.replace('.', '')}-*" for version in named]


def test_only_the_job_that_publishes_may_speak_to_the_package_index():
    jobs = workflow("release")["jobs"]
    allowed = [name for name, job in jobs.items() if "id-token" in job.get("permissions", {})]
    assert allowed == ["publish"]
    assert set(jobs["publish"]["needs"]) == {"archive", "wheels"}


def test_building_shows_one_line_with_what_is_compiled_and_how_many_are_left(capsys, monkeypatch):
    lines = [
        "[ 12/119] Cythonizing lcpstep/lcp/lemke.py\n",
        "warning: no\n",
        "[7/119] Compiling lcpstep.rows\n",
    ]
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    assert list(start.shown(lines)) == lines
    shown = capsys.readouterr().out
    assert shown.replace("\r\x1b[K", "|") == (
        "|translated to C: lcpstep.lcp.lemke, 107 of 119 left|compiled: lcpstep.rows, 112 of 119 left|"
    )
    assert list(start.shown([])) == []


def test_a_log_of_the_building_that_nobody_watches_is_not_written_over(capsys):
    list(start.shown(["[7/119] Compiling lcpstep.rows\n"]))
    assert capsys.readouterr().out == ""


def test_uv_is_not_asked_where_pip_has_an_index_of_its_own(tmp_path, monkeypatch):
    monkeypatch.setattr(start, "pip", lambda: [sys.executable, "-m", "pip"])
    monkeypatch.setenv("PIP_INDEX_URL", "https://packages.example/simple")
    assert start.find_uv(str(tmp_path)) is None


def test_packages_come_by_pip_where_uv_fails(tmp_path, monkeypatch):
    asked = tmp_path / "asked.txt"
    pip = tmp_path / "pip.py"
    pip.write_text(f"import sys\nopen({str(asked)!r}, 'a').write(' '.join(sys.argv[1:]) + '\\n')\n")
    monkeypatch.setattr(start, "pip", lambda: [sys.executable, pip])
    start.install(None, "numpy")
    start.install(sys.executable, "scipy")  # which knows no `pip install`
    assert [line.split()[-1] for line in asked.read_text().splitlines()] == ["numpy", "scipy"]
    pip.write_text("print('no such package'); raise SystemExit(1)\n")
    monkeypatch.setattr(start, "ENVIRONMENT", tmp_path)
    with pytest.raises(SystemExit, match="no such package"):
        start.install(None, "numpy")
    assert (tmp_path / "setting-up.log").read_text() == "no such package\n"


@pytest.mark.slow
def test_nothing_is_translated_to_tell_what_the_package_needs(tmp_path):
    """pip and build ask for it several times, each time in a process of its own."""
    for name in (*start.MADE_BY, "pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, tmp_path)
    shutil.copytree(ROOT / "lagrangian", tmp_path / "lagrangian")
    (tmp_path / "lcpstep").mkdir()
    for name in ("__init__.py", "pointers.pxd", "rows.pxd", "rows.py"):
        shutil.copy(ROOT / "lcpstep" / name, tmp_path / "lcpstep")
    words = [sys.executable, "setup.py", "egg_info"]
    done = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "Cythonizing" not in done.stdout
    assert not (tmp_path / "build" / "cython").exists()


def built(folder):
    """The source archive and the wheel; modules that are built are taken over."""
    words = ["-m", "build", "--no-isolation", "--skip-dependency-check", "--sdist", "--wheel", "--outdir"]
    done = subprocess.run(
        [sys.executable, *words, str(folder), str(ROOT)], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return next(folder.glob("*.tar.gz")), next(folder.glob("*.whl"))


@pytest.mark.slow
def test_what_is_handed_out_is_whole_and_works(tmp_path):
    """One test, for building takes long: it would be done anew in every process that has one of several."""
    archive, wheel = built(tmp_path)
    the_package_index_would_take(archive, wheel)
    the_archive_has_every_source_and_the_wheel_every_module(archive, wheel)
    if UNPRIVILEGED is not None:  # permissions of POSIX, which root keeps to by setpriv alone
        the_wheel_works_from_a_read_only_folder_with_a_home_that_takes_nothing(wheel, tmp_path)


def the_package_index_would_take(*files):
    words = [sys.executable, "-m", "twine", "check", "--strict", *map(str, files)]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def the_archive_has_every_source_and_the_wheel_every_module(archive, wheel):
    with tarfile.open(archive) as members:
        sources = {name.partition("/")[2] for name in members.getnames()}
    modules = set(zipfile.ZipFile(wheel).namelist())
    packages = [f for p in ("lagrangian", "lcpstep") for f in (ROOT / p).rglob("*")]
    files = {str(f.relative_to(ROOT)) for f in packages if f.suffix in (".py", ".pxd", ".h", ".typed")}
    assert files <= sources
    assert {file for file in files if file.endswith((".py", ".typed"))} <= modules
    assert {*start.MADE_BY, "start.py", "LICENSE", "CHANGELOG.md"} <= sources
    compiled = {str(f.relative_to(ROOT)) for f in packages if f.suffix in (".so", ".pyd")}
    assert compiled
    assert compiled <= modules
    assert not [name for name in sources if name.endswith((".so", ".pyd", ".kernel"))]


def the_wheel_works_from_a_read_only_folder_with_a_home_that_takes_nothing(wheel, tmp_path):
    place, mine, home, temporary = (tmp_path / name for name in ("site", "mine", "home", "temporary"))
    zipfile.ZipFile(wheel).extractall(place)
    for folder in (mine, home, temporary):
        folder.mkdir()
    (mine / "own.py").write_text(OWN_SCENE)
    read_only = [mine, home, *(Path(root) for root, _, _ in os.walk(place))]
    for folder in read_only:
        folder.chmod(0o555)
    variables = {
        "PATH": os.environ["PATH"],
        "HOME": str(home),
        "TMPDIR": str(temporary),
        "PYTHONPATH": str(place),
    }
    words = [*UNPRIVILEGED, sys.executable, str(mine / "own.py")]
    done = subprocess.run(words, env=variables, cwd=mine, capture_output=True, text=True, check=False)
    for folder in read_only:
        folder.chmod(0o755)
    assert done.returncode == 0, done.stderr
    assert str(place) in done.stdout
    assert done.stderr.count("takes it") == 1
    assert len(list(temporary.rglob("*.kernel"))) == 4
