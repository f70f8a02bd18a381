"""Maps given by formulas: families x -> P(x) over named parameters, ready ones and those of a user's own file.

    logistic           x -> r x (1 - x)
    border-collision   x -> A- x + (1, 0) m where x1 < 0, A+ x + (1, 0) m where x1 > 0, A = [tau, 1; -delta, 0]
    grazing            x -> alpha x + y + rho, y -> -gamma x where x <= 0;
                       x -> -sqrt(x) + y + rho, y -> -gamma tau^2 x where x > 0

Sources: R. May, Nature 261 (1976); H. Nusse, J. Yorke, Border-collision bifurcations, Physica D 57 (1992);
W. Chin, E. Ott, H. Nusse, C. Grebogi, Grazing bifurcations in impact oscillators, Physical Review E 50 (1994).
"""

from __future__ import annotations

import difflib
import importlib.util
import inspect
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import checks
from lcpstep.errors import LcpStepError, UnknownName

Array = NDArray[np.float64]
Numbers = Mapping[str, float]
Image = Callable[[Array, Numbers], Any]  # image(x, parameters) -> x
FUNCTION = "image"  # what a file must have


@dataclass(frozen=True, eq=False)
class Family:
    """Maps x -> image(x, parameters).

    Parameters
    ----------
    name : for reports
    image : function image(x, parameters) of a point (d,) and a mapping from names to numbers, giving a point (d,)
    x0 : (d,)   where orbits start
    parameters : names and values
    derivative : function derivative(x, parameters) giving (d, d), or None: differences
    ranges : (lowest, highest) value that makes sense, by name; others are refused
    about : in one line
    side : function side(x, parameters) giving a number, zero on the border between two smooth pieces, or None
    border : function (parameters) giving A_minus, A_plus (d, d), B_minus, B_plus, C (d,), D of a piecewise-linear map
    source : what the functions are made of, as a text; a diagram that was interrupted goes on with the same only

    Raises
    ------
    ValueError   a function is none or takes other arguments, or gives another shape or what is no number; a parameter
        lies outside of its range
    """

    name: str
    image: Image
    x0: ArrayLike
    parameters: Numbers = field(default_factory=dict)
    derivative: Callable[[Array, Numbers], Any] | None = None
    ranges: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    about: str = ""
    border: Callable[[Numbers], dict[str, Any]] | None = None
    source: str = ""
    side: Callable[[Array, Numbers], Any] | None = None

    def __post_init__(self) -> None:
        for name, f in ((FUNCTION, self.image), ("derivative", self.derivative), ("side", self.side)):
            if f is not None:
                _takes_two(f"{self.name}: {name}", f)
        object.__setattr__(self, "x0", checks.vector("x0", self.x0))
        numbers = {k: checks.number(f"{self.name}: {k}", x) for k, x in dict(self.parameters).items()}
        object.__setattr__(self, "parameters", numbers)
        for name, ends in self.ranges.items():
            if name not in numbers:
                raise UnknownName(f"parameter of {self.name}", name, numbers)
            low, high = _ends(f"{self.name}: range of {name}", ends)
            checks.number(name, numbers[name], least=low, most=high)
        x = np.array(self.x0)
        self.point(x)
        if self.derivative is not None:
            self.jacobian(x)
        if self.side is not None:
            self.border_value(x)

    def at(self, **values: float) -> FormulaMap:
        """The map at these values of parameters, the others as they are."""
        return FormulaMap(self.with_values(values))

    def with_values(self, values: Numbers) -> Family:
        """The family with other values of parameters."""
        for name in values:
            if name not in self.parameters:
                raise UnknownName(f"parameter of {self.name}", name, self.parameters)
        return replace(self, parameters=dict(self.parameters) | dict(values))

    def point(self, x: Array) -> Array:
        """The image of x, checked."""
        return self._checked(FUNCTION, self.image, x, (len(np.asarray(self.x0)),))

    def jacobian(self, x: Array) -> Array:
        """The derivative at x, checked."""
        assert self.derivative is not None
        d = len(np.asarray(self.x0))
        return self._checked("derivative", self.derivative, x, (d, d))

    def border_value(self, x: Array) -> float:
        """The function of the border at x, checked."""
        assert self.side is not None
        return float(self._checked("side", self.side, x, (1,))[0])

    def _checked(
        self, name: str, f: Callable[[Array, Numbers], Any], x: Array, shape: tuple[int, ...]
    ) -> Array:
        try:
            value = f(x.copy(), self.parameters)
        except Exception as error:
            raise ValueError(
                f"{self.name}: {name}(x, parameters) at x = {x.tolist()} raised {type(error).__name__}: {error}"
            ) from error
        try:
            result = np.asarray(value, dtype=float)
        except (TypeError, ValueError):
            raise ValueError(f"{self.name}: {name} must give numbers, got {value!r}") from None
        if result.shape != shape and not (result.size == 1 and shape in ((1,), (1, 1))):
            raise ValueError(
                f"{self.name}: {name} must give shape {shape} for x of shape {x.shape}, got {result.shape}"
            )
        return result.reshape(shape)


class FormulaMap:
    """One map of a family: x -> P(x), with a derivative where the family has one."""

    def __init__(self, family: Family) -> None:
        self.family = family
        if family.derivative is not None:
            self.jacobian = family.jacobian

    def __call__(self, x: ArrayLike) -> Array:
        """The image of x, (d,); LcpStepError where it is not finite."""
        point = np.atleast_1d(np.asarray(x, dtype=float))
        image = self.family.point(point)
        if not np.all(np.isfinite(image)):
            raise LcpStepError(f"{self.family.name}: the image of x = {point.tolist()} is {image.tolist()}")
        return image


def _ends(name: str, ends: Any) -> tuple[float, float]:
    """Lowest and highest value of a parameter, which may be infinite."""
    try:
        low, high = (float(x) for x in ends)
    except (TypeError, ValueError):
        raise ValueError(f"{name}: expected (lowest, highest), got {ends!r}") from None
    if not low <= high:
        raise ValueError(f"{name}: expected lowest <= highest, got {ends!r}")
    return low, high


def _takes_two(name: str, f: Any) -> None:
    """Refuse what is no function of (x, parameters)."""
    if not callable(f):
        raise ValueError(f"{name}: expected a function (x, parameters), got {f!r}")
    try:
        inspect.signature(f).bind(None, None)
    except TypeError:
        raise ValueError(
            f"{name}: expected a function of two arguments (x, parameters), got {name.split(': ')[-1]}"
            f"{inspect.signature(f)}"
        ) from None


def _logistic(x: Array, p: Numbers) -> Array:
    return p["r"] * x * (1.0 - x)


def _logistic_slope(x: Array, p: Numbers) -> Array:
    return np.array([[p["r"] * (1.0 - 2.0 * x[0])]])


def companion(tau: float, delta: float) -> Array:
    """[tau, 1; -delta, 0]: trace tau, determinant delta."""
    return np.array([[tau, 1.0], [-delta, 0.0]])


def _normal_form_border(p: Numbers) -> dict[str, Any]:
    return {
        "A_minus": companion(p["tau_minus"], p["delta_minus"]), "A_plus": companion(p["tau_plus"], p["delta_plus"]),
        "B_minus": [1.0, 0.0], "B_plus": [1.0, 0.0], "C": [1.0, 0.0], "D": 0.0,
    }  # fmt: skip


def _normal_form_slope(x: Array, p: Numbers) -> Array:
    side = "minus" if x[0] < 0.0 else "plus"
    return companion(p[f"tau_{side}"], p[f"delta_{side}"])


def _normal_form(x: Array, p: Numbers) -> Array:
    return _normal_form_slope(x, p) @ x + np.array([p["m"], 0.0])


def _grazing(x: Array, p: Numbers) -> Array:
    if x[0] <= 0.0:
        return np.array([p["alpha"] * x[0] + x[1] + p["rho"], -p["gamma"] * x[0]])
    return np.array([-math.sqrt(x[0]) + x[1] + p["rho"], -p["gamma"] * p["tau"] ** 2 * x[0]])


def _grazing_slope(x: Array, p: Numbers) -> Array:
    if x[0] <= 0.0:
        return np.array([[p["alpha"], 1.0], [-p["gamma"], 0.0]])
    return np.array([[-0.5 / math.sqrt(x[0]), 1.0], [-p["gamma"] * p["tau"] ** 2, 0.0]])


MAPS = {
    f.name: f
    for f in (
        Family(
            "logistic", _logistic, [0.3], {"r": 3.7}, _logistic_slope, {"r": (0.0, 4.0)},
            about="x -> r x (1 - x)",
        ),
        Family(
            "border-collision", _normal_form, [0.0, 0.0],
            {"m": 0.5, "tau_minus": 0.4, "delta_minus": 0.3, "tau_plus": -1.6, "delta_plus": 0.3},
            _normal_form_slope, about="piecewise-linear, by traces and determinants", border=_normal_form_border,
        ),
        Family(
            "grazing", _grazing, [0.0, 0.0], {"rho": 0.01, "alpha": 0.2, "gamma": 0.0, "tau": 1.0},
            _grazing_slope, {"gamma": (0.0, 1.0), "tau": (0.0, math.inf)},
            about="square-root map of an impact that begins by grazing",
        ),
    )
}  # fmt: skip


def piecewise_linear(
    A_minus: ArrayLike, A_plus: ArrayLike, B_minus: ArrayLike, B_plus: ArrayLike, C: ArrayLike, D: float = 0.0,
    m: float = 0.5,
) -> Family:  # fmt: skip
    """x -> A- x + B- m where C x + D m < 0, A+ x + B+ m elsewhere: a family over m, with matrices of one's own."""
    d = len(checks.vector("C", C))
    A = [checks.array(name, M, (d, d)) for name, M in (("A_minus", A_minus), ("A_plus", A_plus))]
    B = [checks.array(name, b, (d,)) for name, b in (("B_minus", B_minus), ("B_plus", B_plus))]
    c, offset = np.asarray(C, dtype=float), checks.number("D", D)

    def side(x: Array, p: Numbers) -> int:
        return 0 if float(c @ x + offset * p["m"]) < 0.0 else 1

    return Family(
        "piecewise-linear", lambda x, p: A[side(x, p)] @ x + B[side(x, p)] * p["m"], np.zeros(d), {"m": m},
        lambda x, p: A[side(x, p)], about="x -> A x + B m, with matrices of one's own on both sides of C x + D m = 0",
        border=lambda p: {
            "A_minus": A[0], "A_plus": A[1], "B_minus": B[0], "B_plus": B[1], "C": c, "D": offset,
        },
        source=repr([y.tolist() for y in (*A, *B, c)] + [offset]),
    )  # fmt: skip


def named(name: str) -> Family:
    """A ready family by its name, or that of a file (.py); UnknownName with the nearest where there is none."""
    if name in MAPS:
        return MAPS[name]
    if name.endswith(".py") or Path(name).is_file():
        return from_file(Path(name))
    raise UnknownName("map", name, [*MAPS, "piecewise-linear"])


def from_file(file: Path) -> Family:
    """The family of a Python file: its function `image`, and where it has them `derivative`, `side`, PARAMETERS, ..

    Raises
    ------
    FileNotFoundError   there is no such file
    ValueError   it does not run, has no function `image`, or one of another shape; the message names the file
    """
    if not file.is_file():
        raise FileNotFoundError(f"map: there is no file {file}")
    spec = importlib.util.spec_from_file_location(file.stem, file)
    if spec is None or spec.loader is None:
        raise ValueError(f"map: {file} is no Python file (.py)")
    module = importlib.util.module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
    except Exception as error:
        raise ValueError(f"map: {file} does not run: {type(error).__name__}: {error}") from error
    if not hasattr(module, FUNCTION):
        functions = [name for name, f in vars(module).items() if inspect.isfunction(f)]
        near: Sequence[str] = difflib.get_close_matches(FUNCTION, functions, n=1, cutoff=0.5) or functions
        hint = f"; it has {', '.join(near)}" if near else ""
        raise ValueError(f"map: {file} has no function {FUNCTION}(x, parameters){hint}")
    get = vars(module).get
    return Family(
        file.stem, module.image, get("X0", [0.0]), get("PARAMETERS", {}), get("derivative"), get("RANGES", {}),
        about=(module.__doc__ or "").strip().split("\n")[0], source=file.read_text(),
        side=get("side"),
    )  # fmt: skip
