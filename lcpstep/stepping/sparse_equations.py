"""A sparse linear system as whole vectors: matrices, forces and gaps; and what a step of one size multiplies with."""

from __future__ import annotations

import functools
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Harmonic, Joints, LinearContacts, LinearSystem, Scene
from lcpstep.kernels.function import Function
from lcpstep.lcp.saddle import Saddle
from lcpstep.lcp.sparse_rows import SparseRows
from lcpstep.model import c_functions

Array = NDArray[np.float64]
REST = 8 * np.finfo(float).eps  # of the size of a velocity's terms: zero


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
        self.p = np.array(scene.p)
        self.harmonic = system.force if isinstance(system.force, Harmonic) else None
        self.terms = (self.harmonic or Harmonic()).terms(n_q)
        motion = None if contacts is None else contacts.motion
        named = {"force": system.force, "frame": system.frame, "motion": motion}
        given = {name: f for name, f in named.items() if callable(f)}
        addresses, self.kept = c_functions(scene, system=given)
        shapes = {"force": (n_q,), "frame": (n_q, 3), "motion": (len(self.offset), 3)}
        self.callbacks = {
            name: Function(address, self.p, n_q, n_q, shapes[name])
            for name, address in addresses["system"].items()
        }

    def value(self, name: str, t: float, q: Array, v: Array, shape: tuple[int, ...]) -> Array:
        """Value of a callback."""
        out = np.full((1, *shape), np.nan)
        self.callbacks[name].sample(np.array([t]), np.ascontiguousarray(q), np.ascontiguousarray(v), out)
        return out[0]

    def force(self, t: float, q: Array, v: Array) -> Array:
        """F(t), the forces of a moving frame included."""
        n = len(q)
        if self.harmonic:
            constant, cosine, sine = self.terms
            angle = self.harmonic.omega * t
            F = constant + cosine * np.cos(angle) + sine * np.sin(angle)
        else:
            F = self.value("force", t, q, v, (n,))
        if "frame" in self.callbacks:
            c = self.value("frame", t, q, v, (n, 3))
            F = F - (self.M @ c[:, 2] + self.C @ c[:, 1] + self.K @ c[:, 0])
        return F

    def obstacle(self, t: float, q: Array, v: Array) -> tuple[Array, Array]:
        """Position and velocity of the obstacles."""
        if "motion" not in self.callbacks:
            return np.zeros(len(self.offset)), np.zeros(len(self.offset))
        s = self.value("motion", t, q, v, (len(self.offset), 3))
        return s[:, 0], s[:, 1]


class JointRows:
    """The joints of a scene: their sparse Jacobians, and what their obstacles move by.

    n, turning    how many there are; whether their rows change
    """

    def __init__(self, scene: Scene) -> None:
        from scipy.sparse import csr_array

        joints, n_q, p = scene.joints, scene.n_q, np.array(scene.p)
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
        addresses, self.kept = c_functions(scene, joints={k: f for k, f in given.items() if f is not None})
        self.shapes = {"entries": (size,), "gap_t": (self.n,), "motion": (self.n, 3)}
        self.callbacks = {
            name: Function(address, p, n_q, n_q, self.shapes[name])
            for name, address in addresses["joints"].items()
        }

    def at(self, t: float, q: Array, v: Array) -> tuple[Array, Array]:
        """Entries of J in the order of its rows, and the rates J_t at v = 0."""
        where = np.array([t]), np.ascontiguousarray(q), np.ascontiguousarray(v)
        values = {}
        for name, f in self.callbacks.items():
            values[name] = np.full(self.shapes[name], np.nan)
            f.sample(*where, values[name])
        data = values["entries"][self.entry] if self.turning else self.data
        if "motion" in values:
            return data, -values["motion"][:, 1]
        return data, values.get("gap_t", np.zeros(self.n))

    def matrix(self, data: Array) -> Any:
        """J with these entries."""
        from scipy.sparse import csr_array

        return csr_array((data, self.indices, self.indptr), shape=self.shape)


class Step:
    """Steps of one size h: their matrices, factorised once."""

    def __init__(self, equations: Equations, h: float, theta: float) -> None:
        e, self.h, self.theta = equations, h, theta
        A = e.M + h * theta * e.C + (h * theta) ** 2 * e.K
        self.saddle = Saddle(A, e.G)
        self.B = SparseRows(h * e.C + h * h * theta * e.K)
        self.diagonal = A.diagonal()

    def free(self, e: Equations, q: Array, v: Array, F: Array, F_next: Array) -> Array:
        """Right-hand side r without contact."""
        average = self.theta * F_next + (1.0 - self.theta) * F
        return self.h * (average - e.K_rows.times(q)) - self.B.times(v)

    def without_contact(self, r: Array) -> Array:
        """Change of the velocity, A^-1 r."""
        return np.asarray(self.saddle.free(r))

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
