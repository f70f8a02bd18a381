"""One list of what is refused: every line of it is raised in its words, and the table of the docs is made from it."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scipy.sparse

from lagrangian import Coulomb, Joints, LinearContacts, LinearSystem, Scene, Surface, scenes
from lcpstep import EventDriven, LcpStepError, Located, Moreau, simulate
from lcpstep.analysis.hybrid_variation import monodromy as hybrid_monodromy
from lcpstep.analysis.variation import monodromy
from lcpstep.refusals import REFUSALS, with_table
from tests.events.rough import block
from tests.events.switching import two_gravities

PAGE = Path(__file__).parent.parent / "docs" / "choosing.md"
EXACT = Located(1e-2, "exact")


def sparse(n=2001, joints=None, **more):
    """Masses whose matrices are sparse; those of `more` beside their first coordinate are of a friction."""
    first, along = (scipy.sparse.csr_array(([1.0], ([0], [k])), shape=(1, n)) for k in (0, 1))
    friction = Coulomb(0.3, more.pop("tangent", along), **more) if more else None
    return Scene(
        system=LinearSystem(scipy.sparse.eye_array(n, format="csr")), q0=np.ones(n), v0=np.zeros(n),
        contacts=LinearContacts(first, friction=friction), t_span=(0.0, 1.0), joints=joints,
    )  # fmt: skip


def along_the_second(t, q, v, p, out):
    out[:] = 0.0
    out[0, 1] = 1.0


def on_a_circle(t, q, v, p, out):
    out[0] = 0.5 * (q[0] * q[0] + q[1] * q[1]) - 1.0


def its_row(t, q, v, p, out):
    out[:] = 0.0
    out[0, 0], out[0, 1] = q[0], q[1]


def moving(t, q, v, p, out):
    out[0, 0] = out[0, 1] = out[0, 2] = 0.0


def two_with_a_moving_wall():
    return Scene(
        system=LinearSystem(np.eye(2)), contacts=LinearContacts([[1.0, 0.0]], motion=moving), q0=[1.0, 1.0],
        v0=[0.0, 0.0], t_span=(0.0, 1.0),
    )  # fmt: skip


def falls_flat():
    scene = Scene(
        system=LinearSystem(np.eye(3), force=[0.0, -9.81, 0.0]),
        contacts=LinearContacts([[0, 1, 0.3], [0, 1, -0.3]], friction=Coulomb(0.3, [[1, 0, 0.4]] * 2)),
        q0=[0.0, 0.2, 0.0], v0=[0.5, 0.0, 0.0], t_span=(0.0, 0.3),
    )  # fmt: skip
    return monodromy(scene, EventDriven(), [0.0, 0.2, 0.0, 0.5, 0.0, 0.0], (0.0, 0.3))


def height(t, x, p, out):
    out[0] = x[0] - p[2]


def with_a_surface():
    scene = two_gravities()
    return replace(scene, system=replace(scene.system, surfaces=[Surface(height, "low", "high")]))


def comes_to_rest_in_a_corner():
    scene = block(61045)
    x = np.concatenate([scene.q0, scene.v0]) + np.array([0.0, 0.1, 0.0, 0.0, 0.0, 0.3])
    return monodromy(scene, EventDriven(1e-12, 1e-12), x, (0.0, 0.7))


ASKED = {
    "exact-joints": lambda: simulate(scenes.pendulum_stop(form="rod"), EXACT),
    "exact-friction": lambda: simulate(scenes.sliding_block(), EXACT),
    "exact-forces": lambda: simulate(scenes.pendulum_stop(), EXACT),
    "exact-curved": lambda: simulate(scenes.bowl(), EXACT),
    "exact-moving": lambda: simulate(two_with_a_moving_wall(), EXACT),
    "exact-tolerance": lambda: Located(1e-2, "exact", tolerance=1e-6),
    "solver-beyond-contacts": lambda: simulate(scenes.sliding_block(), Moreau(1e-2, lcp="pgs")),
    "solver-tolerance": lambda: Moreau(1e-2, lcp="pgs", tolerance=1e-3),
    "sparse-tolerance": lambda: simulate(sparse(), Moreau(1e-2, tolerance=1e-3)),
    "sparse-solver": lambda: simulate(sparse(), Moreau(1e-2, lcp="pgs")),
    "sparse-projected": lambda: simulate(sparse(), Moreau(1e-2, projected=True)),
    "sparse-stronge": lambda: simulate(sparse(law="stronge"), Moreau(1e-2)),
    "sparse-tangents": lambda: simulate(sparse(tangent=along_the_second), Moreau(1e-2)),
    "sparse-joints": lambda: simulate(sparse(joints=Joints(1, on_a_circle, its_row)), Moreau(1e-2)),
    "dense": lambda: simulate(sparse(), EventDriven()),
    "modes-error": lambda: simulate(scenes.bilinear_oscillator(), EventDriven(), error=True),
    "modes-method": lambda: simulate(scenes.bilinear_oscillator(), Moreau(1e-2)),
    "modes-audit": lambda: simulate(scenes.bilinear_oscillator(), EventDriven(audit=True)),
    "modes-surfaces": lambda: simulate(with_a_surface(), EventDriven()),
    "modes-maps": lambda: hybrid_monodromy(simulate(two_gravities(0.3), EventDriven())),
    "together": falls_flat,
    "endless-together": comes_to_rest_in_a_corner,
}


@pytest.mark.parametrize("key", ASKED)
def test_what_is_refused_is_raised_in_the_words_of_the_list(key):
    with pytest.raises((LcpStepError, ValueError)) as error:
        ASKED[key]()
    said, line = str(error.value), REFUSALS[key]
    argument = "M" if key == "dense" else line.argument
    for word in (argument + ": ", line.method, line.feature, line.reason, line.instead):
        assert word in said


@pytest.mark.parametrize(
    "method", [Moreau(1e-2, tolerance=1e-3), Moreau(1e-2, lcp="pgs"), Moreau(1e-2, projected=True)]
)
def test_sparse_scenes_that_are_small_take_dense_steps_for_what_sparse_ones_do_not_know(method):
    scene = scenes.column(n=3, restitution=0.5, t_end=0.5)
    system, contacts = scene.system, scene.contacts
    system = LinearSystem(scipy.sparse.csr_array(system.M), force=system.force)
    as_sparse = replace(
        scene, system=system, contacts=replace(contacts, G=scipy.sparse.csr_array(contacts.G))
    )
    a, b = simulate(as_sparse, method), simulate(scene, method)
    assert as_sparse.system.sparse
    np.testing.assert_array_equal(a.q, b.q)


def test_every_line_of_the_list_is_asked_for():
    assert set(ASKED) == set(REFUSALS)


def test_the_table_of_the_docs_is_that_of_the_list():
    page = PAGE.read_text()
    assert with_table(page) == page, "run: python -m lcpstep.refusals docs/choosing.md"
    assert page.count("does not treat") >= 1
