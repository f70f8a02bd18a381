"""A module as users write them: all that numba makes of functions and classes, each reading an index as it is."""

import functools

import numba
import numpy as np
from numba.experimental import jitclass

TABLE = np.full(3, 8.0)
FAR = 10**7


@numba.njit
def item(x, k):
    return x[k]


@numba.vectorize
def from_table(k):
    return TABLE[k]


@numba.vectorize([numba.float64(numba.int64)])
def typed_from_table(k):
    return TABLE[k]


@numba.cfunc(numba.float64(numba.int64))
def c_from_table(k):
    return TABLE[k]


@numba.guvectorize([(numba.float64[:], numba.int64, numba.float64[:])], "(m),()->()")
def generalized(p, k, out):
    out[0] = p[k]


@numba.guvectorize([(numba.float64[:], numba.float64[:])], "(n)->(n)", writable_args=(0,))
def writing(x, out):
    x[0] = 3.0
    out[0] = -8.0


@numba.stencil(neighborhood=((-1, 1),))
def beside(x):
    return x[FAR]


@jitclass([("g", numba.float64[:])])
class Field:
    def __init__(self, n):
        self.g = np.full(n, 8.0)

    def item(self, k):
        return self.g[k]

    @property
    def far(self):
        return self.g[FAR]


class Tools:
    item = staticmethod(item)


FIELD = Field(3)
ITEMS = (item,)
BY_NAME = {"item": item}


def by_vectorize(t, q, v, p, out):
    out[0] = -from_table(0 if t < 0.3 else FAR)


def by_vectorize_of_types(t, q, v, p, out):
    typed_from_table(np.array([0 if t < 0.3 else FAR]), out)
    out[0] = -out[0]


def by_cfunc(t, q, v, p, out):
    out[0] = -c_from_table(0 if t < 0.3 else FAR)


def by_class(t, q, v, p, out):
    out[0] = -Tools.item(p, 0 if t < 0.3 else FAR)


def by_tuple(t, q, v, p, out):
    out[0] = -ITEMS[0](p, 0 if t < 0.3 else FAR)


def by_dictionary(t, q, v, p, out):
    out[0] = -BY_NAME["item"](p, 0 if t < 0.3 else FAR)


def by_default(t, q, v, p, out, read=item):
    out[0] = -read(p, 0 if t < 0.3 else FAR)


def by_import(t, q, v, p, out):
    from tests.numba_made import item as read

    out[0] = -read(p, 0 if t < 0.3 else FAR)


def by_inner_function(t, q, v, p, out):
    read = lambda k: item(p, k)  # noqa: E731
    out[0] = -read(0 if t < 0.3 else FAR)


def given_first(read, t, q, v, p, out):
    out[0] = -read(p, 0 if t < 0.3 else FAR)


class Callable:
    def __init__(self):
        self.read = item

    def __call__(self, t, q, v, p, out):
        out[0] = -self.read(p, 0 if t < 0.3 else FAR)


CHECKED = {
    "vectorize": by_vectorize, "vectorize of types": by_vectorize_of_types, "cfunc": by_cfunc, "class": by_class,
    "tuple": by_tuple, "dictionary": by_dictionary, "default": by_default, "import": by_import,
    "inner function": by_inner_function, "partial": functools.partial(given_first, item), "object": Callable(),
}  # fmt: skip


def by_method(t, q, v, p, out):
    out[0] = -FIELD.item(0 if t < 0.3 else FAR)


def by_property(t, q, v, p, out):
    out[0] = -8.0 if t < 0.3 else -FIELD.far


def by_new_object(t, q, v, p, out):
    out[0] = -Field(3).item(0 if t < 0.3 else FAR)


def by_guvectorize(t, q, v, p, out):
    generalized(p, 0 if t < 0.3 else FAR, out)
    out[0] = -out[0]


def by_guvectorize_that_writes(t, q, v, p, out):
    writing(q, out)


def by_stencil(t, q, v, p, out):
    out[0] = -8.0 + beside(p)[0]


REFUSED = {
    "method": (by_method, "'Field' is made by numba.experimental.jitclass"),
    "property": (by_property, "'Field' is made by numba.experimental.jitclass"),
    "new object": (by_new_object, "'Field' is made by numba.experimental.jitclass"),
    "guvectorize": (by_guvectorize, "'generalized' is made by numba.guvectorize"),
    "writing": (by_guvectorize_that_writes, "'writing' is made by numba.guvectorize"),
    "stencil": (by_stencil, "'beside' is made by numba.stencil"),
}
