"""A sparse linear system as whole vectors: matrices, forces and gaps; and what a step of one size multiplies with."""

from __future__ import annotations

import functools
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Harmonic, Joints, LinearContacts, LinearSystem, Scene
from lcpstep.kernels.function import Function
from lcpstep.kernels.roundings import RESOLUTION
from lcpstep.lcp.saddle import Saddle
from lcpstep.lcp.sparse_rows import SparseRows
from lcpstep.model import c_functions
from lcpstep.stepping.steps import implicit_mass

Array = NDArray[np.float64]
REST = 8 * RESOLUTION  # of the size of a velocity's terms: zero


class Callbacks:
    """Functions of a scene, by name: each fills an array of its own shape.

    Parameters
    ----------
    scene : Scene;  of : "system" or "joints";  given : functions by name;  shapes : likewise
    """

    def __init__(
        self, scene: Scene, of: str, given: dict[str, Any], shapes: dict[str, tuple[int, ...]]
    ) -> None:
        addresses, self.kept = c_functions(scene, **{of: given})
        p, n_q, self.shapes = np.array(scene.p), scene.n_q, shapes
        self.functions = {
            name: Function(address, p, n_q, n_q, shapes[name]) for name, address in addresses[of].items()
        }

    def __contains__(self, name: str) -> bool:
        return name in self.functions

    def value(self, name: str, t: float, q: Array, v: Array) -> Array:
        """Value of a function that is there."""
        out = np.full((1, *self.shapes[name]), np.nan)
        self.functions[name].sample(np.array([t]), np.ascontiguousarray(q), np.ascontiguousarray(v), out)
        return out[0]


class Equations:
    """The scene's sparse matrices, forces and gaps."""

    def __init__(self, scene: Scene) -> None:
        from scipy.sparse import csr_array

        system, contacts, n_q = scene.system, scene.contacts, scene.n_q
        if not isinstance(system, LinearSystem) or not (
            contacts is None or isinstance(contacts, LinearContacts)
        ):
            raise TypeError(f"scene: expected a linear system and flat contacts, got {scene.name!r}")
        matrices: Any = (system.M, system.C, system.K)
        self.M, self.C, self.K = (csr_array(x) for x in matrices)
        G: Any = np.zeros((0, n_q)) if contacts is None else contacts.G
        self.G = csr_array(G)
        self.G.sum_duplicates()
        self.G_rows, self.K_rows = SparseRows(self.G), SparseRows(self.K)
        self.offset = np.zeros(0) if contacts is None else np.array(contacts.offset)
        self.restitution = np.zeros(0) if contacts is None else np.array(contacts.restitution)
        self.harmonic = system.force if isinstance(system.force, Harmonic) else None
        self.terms = (self.harmonic or Harmonic()).terms(n_q)
        motion = None if contacts is None else contacts.motion
        named = {"force": system.force, "frame": system.frame, "motion": motion}
        given = {name: f for name, f in named.items() if callable(f)}
        shapes: dict[str, tuple[int, ...]] = {
            "force": (n_q,),
            "frame": (n_q, 3),
            "motion": (len(self.offset), 3),
        }
        self.callbacks = Callbacks(scene, "system", given, shapes)

    def force(self, t: float, q: Array, v: Array) -> Array:
        """F(t), the forces of a moving frame included."""
        if self.harmonic:
            constant, cosine, sine = self.terms
            angle = self.harmonic.omega * t
            F = constant + cosine * np.cos(angle) + sine * np.sin(angle)
        else:
            F = self.callbacks.value("force", t, q, v)
        if "frame" in self.callbacks:
            c = self.callbacks.value("frame", t, q, v)
            F = F - (self.M @ c[:, 2] + self.C @ c[:, 1] + self.K @ c[:, 0])
        return F

    def obstacle(self, t: float, q: Array, v: Array) -> tuple[Array, Array]:
        """Position and velocity of the obstacles."""
        if "motion" not in self.callbacks:
            return np.zeros(len(self.offset)), np.zeros(len(self.offset))
        s = self.callbacks.value("motion", t, q, v)
        return s[:, 0], s[:, 1]


class JointRows:
    """The joints of a scene: their sparse Jacobians, and what their obstacles move by.

    n, turning    how many there are; whether their rows change
    """

    def __init__(self, scene: Scene) -> None:
        from scipy.sparse import csr_array

        joints, n_q = scene.joints, scene.n_q
        self.n, self.turning, self.shape = scene.n_j, isinstance(joints, Joints), (scene.n_j, n_q)
        given: dict[str, Any] = {}
        if isinstance(joints, Joints):
            size = np.asarray(joints.pattern).shape[1]
            template = joints.matrix(np.arange(float(size)), n_q)
            self.entry = template.data.astype(np.intp)  # which of the callback's entries stands where
            given = {"entries": joints.jacobian, "gap_t": joints.gap_t}
        else:
            G: Any = csr_array((0, n_q)) if joints is None else joints.G
            template, size = csr_array(G), 0
            given = {"motion": None if joints is None else joints.motion}
        self.indices, self.indptr, self.data = template.indices, template.indptr, template.data
        shapes: dict[str, tuple[int, ...]] = {"entries": (size,), "gap_t": (self.n,), "motion": (self.n, 3)}
        given = {name: f for name, f in given.items() if f is not None}
        self.callbacks = Callbacks(scene, "joints", given, shapes)

    def at(self, t: float, q: Array, v: Array) -> tuple[Array, Array]:
        """Entries of J in the order of its rows, and the rates J_t at v = 0."""
        known, data, rates = self.callbacks, self.data, np.zeros(self.n)
        if self.turning:
            data = known.value("entries", t, q, v)[self.entry]
        if "motion" in known:
            rates = -known.value("motion", t, q, v)[:, 1]
        elif "gap_t" in known:
            rates = known.value("gap_t", t, q, v)
        return data, rates

    def matrix(self, data: Array) -> Any:
        """J with these entries."""
        from scipy.sparse import csr_array

        return csr_array((data, self.indices, self.indptr), shape=self.shape)


class Step:
    """Steps of one size h: their matrices, factorised once."""

    def __init__(self, equations: Equations, h: float, theta: float) -> None:
        e, self.h, self.theta = equations, h, theta
        A = implicit_mass(e.M, e.C, e.K, h * theta)
        self.saddle = Saddle(A, e.G)
        self.B = SparseRows(h * e.C + h * h * theta * e.K)
        self.diagonal = A.diagonal()

    def free(self, e: Equations, q: Array, v: Array, F: Array, F_next: Array) -> Array:
        """Right-hand side r without contact."""
        average = self.theta * F_next + (1.0 - self.theta) * F
        return self.h * (average - e.K_rows.times(q)) - self.B.times(v)

    @functools.cached_property
    def steepest(self) -> Array:
        """The largest entry of each row of G."""
        abs_G = abs(self.saddle.G)
        return abs_G.max(axis=1).toarray().ravel() if self.saddle.m else np.zeros(0)

    def at_rest(self, v: Array, r: Array, p: Array) -> Array:
        """The velocities, zero where contact forces hold them there up to rounding."""
        pressed = self.saddle.G_columns.sizes(p)
        size = (pressed + np.abs(r)) / np.abs(self.diagonal)
        return np.where((pressed > 0.0) & (np.abs(v) <= REST * size), 0.0, v)
