"""From plain Python to machine code: kernels, and the user's functions that they call.

A kernel is an ordinary Python function on arrays, floats and named tuples of these. `compiled(f)` is its
numba twin, the functions that f calls included; both are made from the one source, so the plain one stands
in for debugging (`NUMBA_DISABLE_JIT=1`) and for user functions that numba cannot compile.

User functions ("callbacks") all have the signature

    f(t, q, v, p, out)      t: time; q, v: (n_q,); p: (n_p,) parameters; out: filled in by f

and enter a kernel as the address of a C function (see `lcpstep.callbacks`), so that a kernel is compiled once, kept
on disk, and serves every scene. Nothing here imports numba before something is compiled.
"""

from __future__ import annotations

import abc
import dis
import functools
import hashlib
import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from types import BuiltinFunctionType, CellType, CodeType, FunctionType, ModuleType
from typing import Any, TypeVar, cast

import numpy as np

F = TypeVar("F", bound=Callable[..., Any])
C = TypeVar("C", bound=type[Any])
# Kernels allocate nothing, so nothing in them is reference-counted; that is several times faster.
OPTIONS = {"error_model": "numpy", "_nrt": False}
ALL_ONES = 0xFF  # the bytes of a not-a-number
TASKS: dict[Any, int] = {}  # addresses by kernel and kinds of its work space
FINGERPRINT = 12  # digits of it in a name
UNKNOWN = "<unknown>"  # a value of which nobody can tell whether it has changed


def call(f: Any, t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Evaluate a callback from within a kernel; f is a function here, an address once compiled.

    `out` is not-a-number before: a callback that fails or leaves an entry out does not hand on what stood there.
    """
    out.fill(np.nan)
    f(t, q, v, p, out)


def call_solver(f: Any, W: Any, b: Any, z: Any, work: Any) -> int:
    """Call a complementarity solver from within a kernel; f is a function here, an address once compiled.

    W, b and z must be contiguous: what is built ahead of time gets but where they begin, and their length.
    """
    return int(f(W, b, z, work))


def call_task(f: Any, M: Any, q: Any, v: Any, own: Any) -> int:
    """Call a kernel that was compiled by itself; f is a function here, an address once compiled."""
    return int(f(M, q, v, own))


def call_first_order(f: Any, t: float, x: Any, p: Any, out: Any) -> None:
    """Evaluate a function of a first-order system from within a kernel; otherwise as `call`."""
    out.fill(np.nan)
    f(t, x, p, out)


class ByAddress(abc.ABC):  # noqa: B024  (numba asks by this class which tuples are marked)
    """All classes marked with `by_address`."""


def by_address(cls: C) -> C:
    """Mark a class of named tuples to be handed from kernel to kernel as one pointer, not field by field."""
    ByAddress.register(cls)
    return cls


def inline(f: F) -> F:
    """Mark a kernel to be merged into its callers, so that the tuples it takes are not copied at every call."""
    f.inline = True  # type: ignore[attr-defined]
    return f


def jit_disabled() -> bool:
    """Whether the environment asks for plain Python (`NUMBA_DISABLE_JIT=1`)."""
    return os.environ.get("NUMBA_DISABLE_JIT", "0") not in ("", "0")


def compiled(f: Callable[..., Any], without: Iterable[Callable[..., Any]] = ()) -> Callable[..., Any]:
    """Numba twin of kernel f, compiled for the argument types of its first call and cached on disk.

    `without`: kernels that this use of f never reaches; leaving them out spares compiling them.
    """
    if jit_disabled():
        return f
    return _entry(cast(FunctionType, f), frozenset(cast(Iterable[FunctionType], without)))


def task_address(f: Callable[..., int], work: Any) -> int:
    """Address of a kernel f(M, q, v, work) compiled by itself, for `call_task`.

    Looked up by the kinds of the arrays in `work`: they are the library's own, and do not change in a process.
    """
    kinds = (f, *((a.dtype, a.ndim) if isinstance(a, np.ndarray) else type(a) for a in work))
    if kinds not in TASKS:
        TASKS[kinds] = _address(f, 0, np.zeros((1, 1)), np.zeros(1), np.zeros(1), work)
    return TASKS[kinds]


def _address(f: Callable[..., Any], returned: Any, *arguments: Any) -> int:
    """Address of f compiled for the types of the given arguments and of the value returned."""
    function, (kind, *types) = cast(FunctionType, f), _types((returned, *arguments))
    return cast(int, _cfunc(function, tuple(types), kind, _dependencies(function)).address)


def _types(values: tuple[Any, ...]) -> tuple[Any, ...]:
    """Numba's types of values, among them tuples that are passed by address."""
    from numba import typeof

    from lcpstep import addresses  # noqa: F401  (it tells numba of these)

    return tuple(map(typeof, values))


def absent(*arguments: Any) -> int:
    """In the place of a kernel that is never reached."""
    return 0


@functools.cache
def _entry(f: FunctionType, without: frozenset[FunctionType]) -> Any:
    import numba

    from lcpstep import addresses  # noqa: F401  (it tells numba of tuples by address)

    copy = _with_compiled_callees(f, without)
    dispatcher = numba.njit(nogil=True, **OPTIONS)(copy)
    _keep_on_disk(dispatcher, f, copy, "kernel")
    return dispatcher


@functools.cache
def _callee(f: FunctionType, without: frozenset[FunctionType]) -> Any:
    """F as other kernels call it: never from Python, so without the wrappers that take most of the compiling."""
    if f in (call, call_solver, call_task, call_first_order):
        return _intrinsics()[f]
    import numba

    from lcpstep.linking import Callee

    inlined = hasattr(f, "inline")
    wrappers = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}
    copy = _with_compiled_callees(f, without)
    return numba.njit(nogil=True, forceinline=inlined, pipeline_class=Callee, **wrappers, **OPTIONS)(copy)


@functools.cache
def _cfunc(f: FunctionType, arguments: tuple[Any, ...], returned: Any, dependencies: str) -> Any:
    """C function of f; compiled anew where what f depends on has changed since."""
    from numba.core.ccallback import CFunc

    copy = _with_compiled_callees(f, frozenset())
    c_function = CFunc(copy, (arguments, returned), {}, OPTIONS)
    _keep_on_disk(c_function, f, copy, "callback")
    c_function.compile()
    return c_function


def _keep_on_disk(compilable: Any, f: FunctionType, copy: FunctionType, kind: str) -> None:
    """Keep the machine code of f, compiled from this copy of it, unless it reads what may change unseen.

    A function that reads objects of which nobody can tell whether they have changed is compiled in each process.
    """
    if UNKNOWN in _dependencies(f):
        return
    from lcpstep.kept import Kept

    compilable._cache = Kept(copy, kind)


def _with_compiled_callees(f: FunctionType, without: frozenset[FunctionType]) -> FunctionType:
    """A copy of kernel f in which every plain function that it names is replaced by its compiled twin."""
    twins = {
        g: _callee(absent, frozenset()) if g in without else _callee(g, without and without & _reached(g))
        for _, g in _callees(f)
    }
    left_out = (
        [_code_text(cast(FunctionType, absent)), *sorted(g.__qualname__ for g in without)] if without else []
    )
    return with_twins(f, twins, str(left_out))


def with_twins(f: FunctionType, twins: Mapping[FunctionType, Any], variant: str) -> FunctionType:
    """A copy of f that names compiled twins in the place of plain functions.

    Its name carries a fingerprint of all that its machine code depends on, and of which variant this is, for machine
    code is linked and kept on disk by name: two variants must never share one.
    """
    named = {name: twins[g] for name, g in _callees(f)}
    around = zip(f.__code__.co_freevars, f.__closure__ or (), strict=True)
    closure = tuple(CellType(named[name]) if name in named else cell for name, cell in around)
    copy = FunctionType(f.__code__, {**f.__globals__, **named}, f.__name__, f.__defaults__, closure)
    copy.__kwdefaults__ = f.__kwdefaults__
    fingerprint = hashlib.sha256(f"{_dependencies(f)} {variant}".encode()).hexdigest()[:FINGERPRINT]
    copy.__module__, copy.__qualname__ = f.__module__, f"{f.__qualname__}_{fingerprint}"
    return copy


def _callees(f: FunctionType) -> Iterator[tuple[str, FunctionType]]:
    """Functions that f names, whether as globals or in the function around it; those with twins already as well."""
    named = [(name, f.__globals__.get(name)) for name in _global_names(f)]
    for name, g in [*named, *_cells(f)]:
        g = getattr(g, "py_func", g)
        if isinstance(g, FunctionType):
            yield name, g


def _cells(f: FunctionType) -> Iterator[tuple[str, Any]]:
    """Variables of the function around f that f reads."""
    for name, cell in zip(f.__code__.co_freevars, f.__closure__ or (), strict=True):
        yield name, cell.cell_contents


@functools.cache
def _global_names(f: FunctionType) -> list[str]:
    """Globals that f reads; its attribute names, which `co_names` mixes with these, left out."""
    return sorted({name for name in _names_read(f) if "." not in name})


@functools.cache
def _names_read(f: FunctionType) -> list[str]:
    """Globals that f and functions inside it read, and attributes of these that are read at once: "np", "np.pi"."""
    names: set[str] = set()
    for code in _codes(f.__code__):
        chain = ""
        for i in dis.get_instructions(code):
            if i.opname == "LOAD_GLOBAL":
                chain = i.argval
            elif i.opname in ("LOAD_ATTR", "LOAD_METHOD") and chain:
                chain += f".{i.argval}"
            else:
                chain = ""
            names.update([chain] if chain else [])
    return sorted(names)


def _codes(code: CodeType) -> Iterator[CodeType]:
    """The code of a function and of those defined inside it."""
    yield code
    for inner in code.co_consts:
        if isinstance(inner, CodeType):
            yield from _codes(inner)


def _dependencies(f: FunctionType) -> str:
    """All that the machine code of f depends on, as a text: the code of f and its callees, and what they read."""
    return "\n".join(sorted(map(_code_text, _reached(f))))


def _reached(f: FunctionType) -> frozenset[FunctionType]:
    """F, its callees, theirs, and so on."""
    seen: set[FunctionType] = set()
    todo = [f]
    while todo:
        g = todo.pop()
        if g not in seen:
            seen.add(g)
            todo += [callee for _, callee in _callees(g)]
    return frozenset(seen)


def _code_text(f: FunctionType) -> str:
    read = [f"{name}={_value_text(value)}" for name, value in [*_values_read(f), *_cells(f)]]
    defaults = [_value_text(x) for x in (f.__defaults__ or (), *(f.__kwdefaults__ or {}).items())]
    marks = ["inline"] if hasattr(f, "inline") else []
    codes = []
    for code in _codes(f.__code__):
        literals = [c for c in code.co_consts if not isinstance(c, CodeType)]
        codes.append(f"{code.co_code.hex()} {code.co_names} {literals}")
    return f"{f.__module__}.{f.__qualname__} {marks} {codes} {defaults} {read}"


def _values_read(f: FunctionType) -> Iterator[tuple[str, Any]]:
    """What f reads by name: globals, and attributes of modules and classes, which numba freezes as well."""
    for name in _names_read(f):
        first, *attributes = name.split(".")
        if first not in f.__globals__:
            continue
        value = f.__globals__[first]
        for attribute in attributes:
            frozen = isinstance(value, (ModuleType, type)) and hasattr(value, attribute)
            value = getattr(value, attribute) if frozen else None
        if not attributes or not _value_text(value).startswith(UNKNOWN):
            yield name, value


def _value_text(value: Any) -> str:
    """What numba freezes into machine code, as a text that is the same exactly if the value is."""
    if isinstance(value, np.ndarray) and value.dtype != object:
        return f"{value.dtype} {value.shape} {hashlib.sha256(value.tobytes()).hexdigest()}"
    if isinstance(value, tuple):
        return str([_value_text(item) for item in value])
    if isinstance(value, (bool, int, float, complex, str, np.generic, type(None))):
        return repr(value)
    if isinstance(value, (ModuleType, type, FunctionType, BuiltinFunctionType, np.ufunc)):
        return value.__name__
    if isinstance(getattr(value, "py_func", None), FunctionType):
        return _dependencies(value.py_func)
    return f"{UNKNOWN} {id(value)}"


@functools.cache
def _intrinsics() -> dict[FunctionType, Any]:
    """`call` and its kin as machine code: a jump to an address, with the arguments that a CFunc takes."""
    from llvmlite import ir
    from numba import types
    from numba.core.cgutils import memset
    from numba.extending import intrinsic
    from numba.np.arrayobj import make_array

    def jump(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        kinds = [context.get_value_type(kind) for kind in signature.args[1:]]
        c_function = ir.FunctionType(context.get_value_type(signature.return_type), kinds)
        return builder.call(builder.inttoptr(args[0], c_function.as_pointer()), args[1:])

    def blank(context: Any, builder: Any, signature: Any, args: Any) -> None:
        """Not-a-number into `out`: machine code does not pass an exception on."""
        target = make_array(signature.args[-1])(context, builder, args[-1])
        memset(builder, target.data, builder.mul(target.nitems, target.itemsize), ALL_ONES)

    @intrinsic
    def call_address(typingctx: Any, f: Any, t: Any, q: Any, v: Any, p: Any, out: Any) -> Any:
        def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
            target = make_array(signature.args[-1])(context, builder, args[-1])
            size = builder.mul(target.nitems, target.itemsize)
            memset(
                builder, target.data, size, ALL_ONES
            )  # not-a-number; machine code cannot pass an exception on
            jump(context, builder, signature, args)
            return context.get_dummy_value()

        return types.void(types.int64, types.float64, q, v, p, out), codegen

    @intrinsic
    def call_first_order_address(typingctx: Any, f: Any, t: Any, x: Any, p: Any, out: Any) -> Any:
        def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
            blank(context, builder, signature, args)
            jump(context, builder, signature, args)
            return context.get_dummy_value()

        return types.void(types.int64, types.float64, x, p, out), codegen

    @intrinsic
    def call_task_address(typingctx: Any, f: Any, M: Any, q: Any, v: Any, own: Any) -> Any:
        return types.int64(types.int64, M, q, v, own), jump

    @intrinsic
    def call_solver_address(typingctx: Any, f: Any, W: Any, b: Any, z: Any, work: Any) -> Any:
        if any(x.layout != "C" for x in (W, b, z)):
            return None

        def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
            arrays = [
                make_array(kind)(context, builder, x)
                for kind, x in zip(signature.args[1:4], args[1:4], strict=True)
            ]
            own = make_array(work)(context, builder, args[4])
            values = [*(a.data for a in arrays), arrays[1].nitems, builder.load(own.data)]
            c_function = ir.FunctionType(ir.IntType(64), [value.type for value in values])
            return builder.call(builder.inttoptr(args[0], c_function.as_pointer()), values)

        return types.int64(types.int64, W, b, z, work), codegen

    return {
        cast(FunctionType, call): call_address,
        cast(FunctionType, call_solver): call_solver_address,
        cast(FunctionType, call_task): call_task_address,
        cast(FunctionType, call_first_order): call_first_order_address,
    }
