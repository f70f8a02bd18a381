"""What is compiled when the package is built: the kernels, with what `declarations` says of them.

python setup.py build_ext --inplace     after a change: compiles what it concerns, in seconds
"""

from __future__ import annotations

import hashlib
import importlib.util
import itertools
import os
import platform
import shlex
import shutil
import subprocess
import sys
import sysconfig
from collections import defaultdict
from collections.abc import Iterable
from pathlib import Path

import Cython
import numpy as np
from Cython.Build import cythonize
from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

HERE = Path(__file__).resolve().parent
DIGESTS = HERE / "build" / "digests"  # of what lies built beside its source, a file for each module
SOURCES = "build/sources"  # as Cython reads them
sys.path.insert(
    0, str(HERE)
)  # pip runs this file from elsewhere: what stands beside it is imported after this
import declarations  # noqa: E402
import kernel_sources  # noqa: E402
import ready  # noqa: E402

DIRECTIVES = {
    "language_level": 3,
    "infer_types": True,  # of local variables, from what they are assigned
    "annotation_typing": False,  # `declarations` reads them
    "cdivision": True,
    # Half of what the compiler would have to do: nobody pickles what kernels work in, or asks their Python functions
    # for more than to be called
    "auto_pickle": False,
    "binding": False,
}
# Nothing is fused, so that every processor rounds alike; what no header knows is an error before it is linked
OPTIONS = (
    ["/O2", "/fp:precise"]
    if os.name == "nt"
    else [
        "-O2", "-g0", "-ffp-contract=off", "-Wno-unused-function", "-Werror=implicit-function-declaration",
    ]
)  # fmt: skip
# Packages with loops over rows, which these options make faster; they cost the compiler a fourth more
WITH_LOOPS = ("lcpstep.lcp.", "lcpstep.kernels.")
LOOPS = [] if os.name == "nt" else ["-O3"]
MACROS = [
    ("NPY_NO_DEPRECATED_API", "NPY_2_0_API_VERSION"),
    ("CYTHON_CLINE_IN_TRACEBACK", "0"),  # lines of C, which nobody reads: a tenth of the compiler's time
]
# What runs once, when a module is imported, is not worth the compiler's time; words that gcc alone knows
ONCE = ("CYTHON_SMALL_CODE", '__attribute__((cold, optimize("O0")))')
# What Cython begins with
HEADERS = "#define PY_SSIZE_T_CLEAN\n#include <Python.h>\n#include <numpy/ndarrayobject.h>\n"
MANY = 8  # modules for which to read these once is worth it
ROWS = ["-fno-trapping-math"]  # numbers that a choice does not take may be formed: nobody asks for traps
NO_COMPILER = (
    "lcpstep needs a C compiler to be built: install gcc or clang, or PyPI's ziglang (pip install ziglang)"
)


def linking() -> list[str]:
    """How this Python has modules linked, but for words to the linker that zig's does not know, as of Debian's."""
    words = shlex.split(sysconfig.get_config_var("LDSHARED") or "cc -shared")[1:]
    return [word for word in words if not word.startswith(("-Wl,-B", "-Wl,-O", "-Wl,-z"))]


class Build(build_ext):
    """Compile, several files at a time, and say how far that is; what lies built beside its source is taken over."""

    def initialize_options(self) -> None:
        """Use the processors there are."""
        super().initialize_options()
        self.parallel = os.cpu_count()
        self.begun = itertools.count(1)

    def run(self) -> None:
        """Compile everything, by the compiler of PyPI's ziglang where there is no other."""
        if not has_compiler():
            if importlib.util.find_spec("ziglang") is None:
                sys.exit(NO_COMPILER)
            os.environ["CC"] = f"{sys.executable} -m ziglang cc"
            os.environ["LDSHARED"] = f"{os.environ['CC']} {' '.join(linking())}"
        write_sources()
        self.forget_others()
        for ext in self.extensions:
            ext.digest = digest(ext)
        translate([ext for ext in self.extensions if self.force or not is_built(ext)])
        super().run()
        if self.inplace:
            for ext in self.extensions:
                note = DIGESTS / self.get_ext_filename(ext.name)
                note.parent.mkdir(parents=True, exist_ok=True)
                note.write_text(ext.digest)
                built = HERE / self.get_ext_filename(ext.name)
                if built.exists():
                    built.touch()  # no older than its source, as tests ask

    def forget_others(self) -> None:
        """Take away what was built of modules that are none any more."""
        names = {self.get_ext_filename(ext.name) for ext in self.extensions}
        for note in list(DIGESTS.rglob(f"*{sysconfig.get_config_var('EXT_SUFFIX')}")):
            name = note.relative_to(DIGESTS)
            if str(name) not in names:
                for file in (note, HERE / name, Path(self.build_lib) / name):
                    file.unlink(missing_ok=True)

    def build_extensions(self) -> None:
        """Compile; by gcc with Python's and NumPy's headers read once."""
        if os.name == "posix" and is_gcc(self.compiler.compiler_so[0]):
            self.compiler.define_macro(*ONCE)
            self.share_headers()
        super().build_extensions()

    def share_headers(self) -> None:
        """Have modules take over headers that were read with the same options: with others the code would change."""
        alike = defaultdict(list)
        for ext in self.extensions:
            if ext.define_macros == MACROS and not is_built(ext):
                alike[tuple(ext.extra_compile_args)].append(ext)
        for number, (options, extensions) in enumerate(alike.items()):
            if len(extensions) >= MANY:
                header = self.read_headers(Path(self.build_temp) / f"headers{number}.h", options)
                for ext in extensions:
                    ext.extra_compile_args = ["-include", str(header), *options]

    def read_headers(self, file: Path, options: Iterable[str]) -> Path:
        """Have the compiler keep what it reads in these headers, for the modules that include this file first."""
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(HEADERS)
        folders = [f"-I{folder}" for folder in (np.get_include(), *self.compiler.include_dirs)]
        macros = [f"-D{name}={value}" for name, value in MACROS]
        how = [*self.compiler.compiler_so, *macros, *folders, *options]
        self.spawn([*how, "-x", "c-header", str(file), "-o", f"{file}.gch"])
        return file

    def build_extension(self, ext: Extension) -> None:
        """Compile one module, or copy it where it lies built."""
        if not self.force and is_built(ext):
            target = Path(self.get_ext_fullpath(ext.name))
            target.parent.mkdir(parents=True, exist_ok=True)
            self.copy_file(str(HERE / self.get_ext_filename(ext.name)), str(target))
            return
        print(f"[{next(self.begun)}/{len(self.extensions)}] Compiling {ext.name}", flush=True)
        super().build_extension(ext)


class Module(Extension):
    """A module, and a checksum of all that it is made from."""

    digest: str


def is_built(ext: Module) -> bool:
    """Whether it lies beside its source, made from what stands there now, for this interpreter.

    Asked of contents and not of times: the headers of Cython in the environment that pip makes for each build are
    newer than everything.
    """
    file = f"{ext.name.replace('.', '/')}{sysconfig.get_config_var('EXT_SUFFIX')}"
    note = DIGESTS / file
    return (HERE / file).exists() and note.exists() and note.read_text() == ext.digest


def digest(ext: Module) -> str:
    """A checksum: of Cython's version, of the options, of a module's source and of what that includes."""
    source = in_c(ext.sources[0])
    needed = [] if source.endswith(".pyx") else declarations.needed(HERE, ext.name)
    headers = [f"{SOURCES}/{name.replace('.', '/')}.pxd" for name in sorted(needed)]
    texts = [file.encode() + (HERE / file).read_bytes() for file in (source, *headers, *ext.depends)]
    whole = [repr((Cython.__version__, DIRECTIVES, ext.extra_compile_args, MACROS)).encode(), *texts]
    return hashlib.sha256(b"\0".join(whole)).hexdigest()


def in_c(source: str) -> str:
    """The file that Cython reads in the place of a source: see `declarations.source`."""
    return source if source.endswith(".pyx") else f"{SOURCES}/{source}"


def write_sources() -> None:
    """What Cython reads: kernels, and their declarations, as packages of their own."""
    for name in kernel_sources.kernels(HERE):
        file = Path(name.replace(".", "/"))
        put(file.with_suffix(".py"), declarations.source(HERE, name))
        put(file.with_suffix(".pxd"), declarations.declarations(HERE, name))
        for package in list(file.parents)[:-1]:
            put(package / "__init__.py", "")
    known = {name.replace(".", "/") for name in kernel_sources.kernels(HERE)}
    for old in list((HERE / SOURCES).rglob("*.p*")):
        if old.stem != "__init__" and old.relative_to(HERE / SOURCES).with_suffix("").as_posix() not in known:
            old.unlink(missing_ok=True)


def put(file: Path, text: str) -> None:
    """Write a file that Cython reads, if it is another than before."""
    place = HERE / SOURCES / file
    if kernel_sources.read(place) != text or not place.exists():
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(text, encoding="utf-8")


def has_compiler() -> bool:
    """Whether there is a C compiler; on Windows setuptools itself looks for one."""
    if os.name == "nt" or "CC" in os.environ:
        return True
    usual = (sysconfig.get_config_var("CC") or "cc").split()[0]
    if shutil.which(usual) is None:
        other = next(filter(shutil.which, ("cc", "gcc", "clang")), None)
        if other is None:
            return False
        os.environ["CC"] = other
    return True


def is_gcc(compiler: str) -> bool:
    """Whether a command is that compiler."""
    said = subprocess.run([compiler, "--version"], capture_output=True, text=True, check=False)
    return "Free Software Foundation" in said.stdout


def extension(name: str) -> Module:
    """The module of one kernel."""
    source = Path(name.replace(".", "/"))
    header = source.with_suffix(".h")
    cloned = (HERE / header).exists() and platform.libc_ver()[0] == "glibc"
    clones = [*ROWS, "-include", str(header)] if cloned else []
    loops = LOOPS if cloned or name.startswith(WITH_LOOPS) else []
    return Module(
        name,
        [source.with_suffix(".py").as_posix()],
        include_dirs=[np.get_include()],
        define_macros=MACROS,
        extra_compile_args=[*OPTIONS, *loops, *clones],
        depends=[str(header)] if cloned else [],
    )


def extensions() -> list[Module]:
    """All compiled modules."""
    built = [name for name in kernel_sources.kernels(HERE) if name not in kernel_sources.MERGED]
    return [*map(extension, built), functions_of_ready_scenes()]


def functions_of_ready_scenes() -> Module:
    """The module of C functions that `ready` writes."""
    file, text = HERE / "build" / "ready" / "ready.pyx", ready.source(HERE)
    if not file.exists() or file.read_text() != text:
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
    return Module("lcpstep.kernels.ready", [str(file.relative_to(HERE))], extra_compile_args=OPTIONS)


def translate(modules: list[Module]) -> None:
    """Write these modules as C, which takes the place of their sources.

    Done by the command that compiles, and not when this file is run: pip and build run it several times, to ask for
    requirements and metadata, each time in a process of its own.
    """
    for module in modules:
        module.sources = [in_c(source) for source in module.sources]
    made = cythonize(
        modules,
        nthreads=os.cpu_count() or 1,
        force=True,
        compiler_directives=DIRECTIVES,
        build_dir="build/cython",
    )
    sources = {module.name: module.sources for module in made}
    for module in modules:
        module.sources = sources[module.name]


if __name__ == "__main__":
    setup(
        ext_modules=extensions(),
        cmdclass={"build_ext": Build},
        setup_requires=[] if has_compiler() else ["ziglang"],  # into the build environment that pip makes
    )
