"""Set the project up in a virtual environment of its own and run it; needs Python 3.11 and nothing else.

python3 start.py          the cam-follower by every method: a table, how to read it, and pictures in out/
python3 start.py test     the checks: lint, types, import rules, tests
"""

import contextlib
import functools
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
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent
ENVIRONMENT = ROOT / ".venv"
BIN = ENVIRONMENT / ("Scripts" if os.name == "nt" else "bin")
LAST = 60  # lines of pip's that are shown where it fails
OWN_INDEX = re.compile(r"\.(index-url|no-index|proxy)=")  # in what pip says of its configuration
MADE_BY = "setup.py", "declarations.py", "inference.py", "kernel_sources.py", "ready.py", "ready_words.py"
BUILD = "pyproject.toml", *MADE_BY
BESIDE = (["ruff", "check", "."], ["ruff", "format", "--check", "."], ["pyrefly", "check"], ["lint-imports"])


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
    if built and fetched:
        return
    with uv_for_now() as uv, ThreadPoolExecutor(1) as beside:
        fetching = None if fetched else beside.submit(install, uv, *required(checks))
        if not built:
            install(uv, "--no-deps", "--editable", ".")
            note_done("built", *BUILD, *kernels())
        if fetching is not None:
            fetching.result()
            note_done(what, "pyproject.toml")


def make_environment() -> None:
    """The virtual environment, and what is to be said before a build."""
    print("setting up .venv, and building; this takes two to ten minutes", flush=True)
    if os.name != "nt" and "CC" not in os.environ and not any(map(shutil.which, ("cc", "gcc", "clang"))):
        print("no C compiler here: the one in PyPI's ziglang is fetched, for this build alone", flush=True)
    if not (BIN / "python").exists() and not (BIN / "python.exe").exists():
        venv.create(ENVIRONMENT, symlinks=os.name != "nt")
    pip()  # which is found before two ask for it at a time


def required(checks: bool) -> list[str]:
    """What the project needs at run time, and what its checks do."""
    import tomllib

    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    more: list[str] = project["optional-dependencies"]["test"]
    return project["dependencies"] + (more if checks else [])


def kernels() -> list[str]:
    """Files from which machine code is built."""
    import kernel_sources  # which an older Python, that is told so, could not read

    found = [kernel_sources.kernel(ROOT, name) for name in kernel_sources.kernels(ROOT)]
    asked = {home for k in found for home in (k.name, *k.homes.values())}  # constants come from others
    sources = [kernel_sources.path_of(ROOT, name) for name in asked if name.startswith("lcpstep.")]
    files = [*filter(Path.exists, sources), *ROOT.glob("lcpstep/**/*.pxd"), *ROOT.glob("lcpstep/**/*.h")]
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


@contextlib.contextmanager
def uv_for_now() -> Iterator[str | None]:
    """A uv at hand, or one fetched for as long as this lasts; None where pip is led to packages in its own way."""
    with tempfile.TemporaryDirectory() as folder:
        yield find_uv(folder)


def find_uv(folder: str) -> str | None:
    """A uv at hand, or one fetched into the folder; None where there is none to be used."""
    if OWN_INDEX.search(subprocess.run([*pip(), "config", "list"], capture_output=True, text=True).stdout):
        return None
    if shutil.which("uv") is None and succeeds(*pip(), "install", "--quiet", "--target", folder, "uv"):
        return shutil.which("uv", path=str(Path(folder, "bin")))
    return shutil.which("uv")


def install(uv: str | None, *arguments: str) -> None:
    """Install for the environment: by uv, in a fifth of pip's time; where that fails by pip.

    Files are compiled as they are first imported. What is said is shown where it fails, else warnings are of no use
    to anybody.
    """
    later = [] if sys.dont_write_bytecode else ["--no-compile"]
    by_uv = [] if uv is None else [[uv, "pip", "install", "--verbose", "--python", ENVIRONMENT]]
    for way in [*by_uv, [*pip(), "install", "--verbose", *later]]:
        process = subprocess.Popen(
            [*way, *arguments], cwd=ROOT, text=True, errors="replace",
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
        )  # fmt: skip
        said = list(shown(process.stdout))
        if process.wait() == 0:
            return
    log = ENVIRONMENT / "setting-up.log"
    log.write_text("".join(said))
    words = " ".join(map(str, process.args))
    sys.exit(f"{''.join(said[-LAST:])}setting up failed: {words}; all of it: {log}")


@functools.cache
def pip() -> list[str | Path]:
    """A command that runs pip for the environment.

    Some systems ship Python without ensurepip: then an installed pip does it from outside, and failing that one
    is fetched from the package index.
    """
    python = BIN / "python"
    ways: list[list[str | Path]] = [[python, "-m", "pip"], [sys.executable, "-m", "pip", "--python", python]]
    if not succeeds(*ways[0], "--version"):
        succeeds(python, "-m", "ensurepip")
    way = next((way for way in ways if succeeds(*way, "--version")), None)
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


def succeeds(*words: str | Path) -> bool:
    """Whether a command does what it is asked to."""
    return subprocess.call(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) == 0


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
