"""One pass over a finished run says no less than what it saves, and costs a share of a short run."""

import math
from dataclasses import replace

import numpy as np
import pytest

from lagrangian import Contacts, Scene, scenes
from lcpstep import Located, Moreau, simulate
from lcpstep.doubts.depth import gaps, normal
from lcpstep.kernels import looks
from lcpstep.kernels.states import power
from lcpstep.model import looked_at, model
from tests.uncompiled import both_ways

CURVED = [
    name for name, entry in scenes.CATALOGUE.items()
    if isinstance(entry.make(), Scene) and isinstance(entry.make().contacts, Contacts)
]  # fmt: skip


def short(name):
    """The first twentieth of a ready scene."""
    scene = scenes.CATALOGUE[name].make()
    begin, end = scene.t_span
    return replace(scene, t_span=(begin, begin + 0.05 * (end - begin)))


@pytest.mark.parametrize("name", CURVED)
def test_what_lies_inside_is_what_the_gaps_say(name):
    """Shares just below and above the largest depth over the way, from the scene's own functions."""
    scene = short(name)
    run = simulate(scene, Moreau(min(1e-3, 0.05 * (scene.t_span[1] - scene.t_span[0]))))
    k = np.unique(np.linspace(0, len(run.t) - 1, 64).astype(int))
    states = [(float(run.t[i]), run.q[i], run.v[i]) for i in k]
    g, way = gaps(run.scene, states), np.ptp(run.q[k], axis=0)
    towards = [-g[i, c] / (np.abs(normal(run.scene, c, states[i])) @ way) for i, c in np.argwhere(g < 0.0)]
    m = model(run.scene)
    for share, toward in ((-g.min() / np.linalg.norm(way), False), (max(towards, default=-1.0), True)):
        for factor, inside in ((0.999, share > 0.0), (1.001, False)):
            found = looks.lies_inside(m, run.t, run.q, 64, factor * max(share, 0.0), toward)
            assert found == inside


def test_the_highest_frequency_is_that_of_the_power():
    run = simulate(short("double-pendulum"), Located(1e-3))
    m, near = model(run.scene), 1e-5
    k = ((np.arange(8) + 1) * ((len(run.t) - 1) / 8)).astype(int)
    t, q, v = run.t[k], run.q[k], run.v[k]
    kinetic, after = power(m, t, q + near * v, v)
    _, before = power(m, t, q - near * v, v)
    expected = np.max(np.abs(after - before) / (4.0 * near * kinetic))
    assert math.isclose(looks.highest(m, run.t, run.q, run.v, 8, near), expected, rel_tol=1e-12)


def test_a_run_is_looked_at_with_its_own_model():
    scene = short("bowl")
    simulate(scene, Located(1e-2))
    first = looked_at(scene)
    assert looked_at(scene) is first
    assert looked_at(short("bowl")) is not first


LOOKED_AT = """
from dataclasses import replace

from lagrangian import scenes
from lcpstep import Moreau, simulate
from lcpstep.kernels.fast_turn import first_turn
from lcpstep.kernels.looks import highest, lies_inside
from lcpstep.model import model

for name in ("bowl", "double-pendulum"):
    scene = scenes.CATALOGUE[name].make()
    run = simulate(replace(scene, t_span=(0.0, 0.05 * scene.t_span[1])), Moreau(1e-3))
    m = model(run.scene)
    print([lies_inside(m, run.t, run.q, 9, share, True) for share in (0.0, 1e-4, 1e-3, 1e-2)])
    print(lies_inside(m, run.t, run.q, 9, 1e-4, False), highest(m, run.t, run.q, run.v, 4, 1e-5).hex())
    print([first_turn(m, run.t, run.q, run.v, 50, 8, 0.618, faster) for faster in (10.0, 1e-3)])
"""


@pytest.mark.slow
def test_uncompiled_looks_say_the_same():
    built, plain = both_ways(LOOKED_AT)
    assert built == plain
    assert len(built) == 6
