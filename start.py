"""Set the project up in a virtual environment of its own and run it; needs Python 3.11 and nothing else.

python3 start.py          the cam-follower by every method: a table, how to read it, and pictures in out/
python3 start.py test     the checks: lint, types, import rules, tests
"""

import hashlib
import os
import re
import shutil
import subprocess
import sys
import tempfile
import urllib.parse
import urllib.request
import venv
from collections.abc import Iterable, Iterator
from contextlib import nullcontext
from pathlib import Path

ROOT = Path(__file__).resolve().parent
ENVIRONMENT = ROOT / ".venv"
BIN = ENVIRONMENT / ("Scripts" if os.name == "nt" else "bin")
LAST = 60  # lines of pip's that are shown where it fails
BUILD = "pyproject.toml", "setup.py", "ready.py", "ready_words.py"
BESIDE = (["ruff", "check", "."], ["ruff", "format", "--check", "."], ["mypy"], ["lint-imports"])


def main(arguments: list[str]) -> int:
    """Run the main job, or the checks."""
    if sys.version_info < (3, 11):
        sys.exit(f"lcpstep needs Python 3.11 or newer; this is {sys.version.split()[0]}")
    if arguments not in ([], ["test"]):
        sys.exit(__doc__)
    set_up(checks=bool(arguments))
    return check() if arguments else subprocess.call([BIN / "lcpstep", "compare", "cam-follower"], cwd=ROOT)


def check() -> int:
    """Run the tests, and beside them the short checks, in what the tests leave idle; one that fails ends all."""
    print("== pytest, and beside it:", *(words[0] for words in BESIDE), flush=True)
    tests = subprocess.Popen([BIN / "pytest"], cwd=ROOT)
    for words in BESIDE:
        done = subprocess.run(
            [BIN / words[0], *words[1:]],
            cwd=ROOT,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        print(f"\n== {' '.join(words)}\n{done.stdout}", end="", flush=True)
        if done.returncode != 0:
            tests.terminate()
            tests.wait()
            return done.returncode
    return tests.wait()


def set_up(checks: bool) -> None:
    """Make the virtual environment, and install the project and what it needs, unless that has been done with these.

    What others have built is fetched while the project is built.

    Parameters
    ----------
    checks : whether what the checks need is needed too
    """
    what = "checks" if checks else "dependencies"
    fetched = any(is_done(note, "pyproject.toml") for note in {what, "checks"})  # which need those as well
    built = is_done("built", *BUILD, *kernels())
    if not built:
        make_environment()
    with nullcontext() if fetched else pip_install("--quiet", *required(checks)) as fetching:
        if not built:
            finish(pip_install("--verbose", "--no-deps", "--editable", "."))
            note_done("built", *BUILD, *kernels())
        if fetching is not None:
            finish(fetching)
            note_done(what, "pyproject.toml")


def make_environment() -> None:
    """The virtual environment, and what is to be said before a build."""
    print("setting up .venv, and building; this takes two to ten minutes", flush=True)
    if os.name != "nt" and "CC" not in os.environ and not any(map(shutil.which, ("cc", "gcc", "clang"))):
        print("no C compiler here: the one in PyPI's ziglang is fetched, for this build alone", flush=True)
    if not (BIN / "python").exists() and not (BIN / "python.exe").exists():
        venv.create(ENVIRONMENT, symlinks=os.name != "nt")


def required(checks: bool) -> list[str]:
    """What the project needs at run time, and what its checks do."""
    import tomllib

    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    more: list[str] = project["optional-dependencies"]["test"]
    return project["dependencies"] + (more if checks else [])


def kernels() -> list[str]:
    """Files from which machine code is built."""
    headers = sorted(ROOT.glob("lcpstep/**/*.pxd")) + sorted(ROOT.glob("lcpstep/**/*.h"))
    files = {file for header in headers for file in (header, header.with_suffix(".py")) if file.exists()}
    return sorted(str(file.relative_to(ROOT)) for file in files)


def is_done(what: str, *files: str) -> bool:
    """Whether that has been done with files of these contents."""
    note = ENVIRONMENT / what
    return note.exists() and note.read_text() == digest(*files)


def note_done(what: str, *files: str) -> None:
    """Remember it."""
    (ENVIRONMENT / what).write_text(digest(*files))


def digest(*files: str) -> str:
    """A checksum of files."""
    return hashlib.sha256(b"".join((ROOT / file).read_bytes() for file in files)).hexdigest()


def install(*arguments: str) -> None:
    """Run `pip install` for the environment, and wait for it."""
    finish(pip_install("--verbose", *arguments))


def pip_install(*arguments: str) -> subprocess.Popen:
    """Start `pip install` for the environment; each file is compiled as it is first imported."""
    later = [] if sys.dont_write_bytecode else ["--no-compile"]
    return subprocess.Popen(
        [*pip(), "install", *later, *arguments], cwd=ROOT, text=True, errors="replace",
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
    )  # fmt: skip


def finish(process: subprocess.Popen) -> None:
    """Wait for a `pip install`; what it says is shown where it fails, else its warnings are of no use to anybody."""
    said = list(shown(process.stdout))
    if process.wait() != 0:
        log = ENVIRONMENT / "setting-up.log"
        log.write_text("".join(said))
        words = " ".join(map(str, process.args))
        sys.exit(f"{''.join(said[-LAST:])}setting up failed: {words}; all of it: {log}")


def pip() -> list:
    """A command that runs pip for the environment.

    Some systems ship Python without ensurepip: then an installed pip does it from outside, and failing that one
    is fetched from the package index.
    """
    python = BIN / "python"
    ways = [[python, "-m", "pip"], [sys.executable, "-m", "pip", "--python", python]]
    if not works(ways[0]):
        subprocess.call([python, "-m", "ensurepip"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    way = next((way for way in ways if works(way)), None)
    if way is None:
        with tempfile.TemporaryDirectory() as folder:
            wheel = fetch_pip(Path(folder))
            subprocess.check_call([python, f"{wheel}/pip", "install", "--quiet", str(wheel)])
        way = ways[0]
    return way


def shown(lines: Iterable[str]) -> Iterator[str]:
    """The lines; meanwhile, on a terminal, one line with what is compiled and how many are left.

    Cython and setup.py write `[ 12/119] Compiling lcpstep.rows` before each module.
    """
    terminal = sys.stdout.isatty()
    for line in lines:
        step = re.search(r"\[ *(\d+)/(\d+)\] (Cythonizing|Compiling) (\S+)", line)
        if step is not None and terminal:
            done, total, name = int(step[1]), int(step[2]), step[4].removesuffix(".py").replace("/", ".")
            task = "translated to C" if step[3] == "Cythonizing" else "compiled"
            words = f"{task}: {name}, {total - done} of {total} left"[
                : shutil.get_terminal_size().columns - 1
            ]
            print(f"\r\x1b[K{words}", end="", flush=True)
        yield line
    if terminal:
        print("\r\x1b[K", end="", flush=True)


def works(pip: list) -> bool:
    """Whether a pip command runs."""
    return subprocess.call([*pip, "--version"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) == 0


def fetch_pip(folder: Path) -> Path:
    """Newest wheel of pip from the package index, its checksum verified."""
    index = os.environ.get("PIP_INDEX_URL", "https://pypi.org/simple").rstrip("/") + "/pip/"
    page = download(urllib.request.Request(index, headers={"Accept": "text/html"})).decode()
    wheels = re.findall(r'href="([^"]*/(pip-([\d.]+)-py3-none-any\.whl))#sha256=([0-9a-f]+)"', page)
    link, name, _, checksum = max(wheels, key=lambda found: [int(x) for x in found[2].split(".")])
    content = download(urllib.parse.urljoin(index, link))
    if hashlib.sha256(content).hexdigest() != checksum:
        sys.exit(f"{name}: the checksum does not fit")
    wheel = folder / name
    wheel.write_bytes(content)
    return wheel


def download(what: str | urllib.request.Request) -> bytes:
    """Content of a web address."""
    with urllib.request.urlopen(what) as answer:
        return answer.read()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
