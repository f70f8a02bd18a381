"""The same kernels in plain Python: for callbacks that cannot be compiled, and with NUMBA_DISABLE_JIT=1."""

import math

import numpy as np
import pytest

from lagrangian import Contacts, Joints, LinearContacts, LinearSystem, Scene, System, scenes
from lcpstep import EventDriven, Located, Moreau, SimulationError, simulate
from lcpstep.model import UncompiledCallback
from tests.marks import compiled_only
from tests.models import ball_on_table, bowl_scene, pendulum
from tests.processes import python

SEEN = {}


def remembering(f):
    """The callback f, made impossible to compile."""

    def plain(t, q, v, p, out):
        SEEN[f.__name__] = t
        f(t, q, v, p, out)

    return plain


def plain(scene):
    """The same scene with callbacks that numba cannot compile."""
    s, c = scene.system, scene.contacts
    if isinstance(s, System):
        s = System(s.n_q, s.mass, remembering(s.force), s.force_q, s.force_v)
    elif isinstance(c, LinearContacts) and c.motion is not None:
        c = LinearContacts(c.G, c.offset, c.restitution, remembering(c.motion))
    elif isinstance(c, Contacts):
        c = Contacts(c.n_c, remembering(c.gap), c.jacobian, c.gap_t, c.bias, c.restitution)
    else:
        s = LinearSystem(s.M, s.C, s.K, s.force, frame=remembering(s.frame))
    return Scene(
        system=s, contacts=c, q0=scene.q0, v0=scene.v0, t_span=scene.t_span, p=scene.p, corners=scene.corners,
        period=scene.period, name=scene.name,
    )  # fmt: skip


SCENES = [
    pytest.param(scenes.cam_follower(t_end=0.1), id="cam-follower"),
    pytest.param(ball_on_table(0.01, 40.0, 0.3, 0.02, 0.0, 0.2), id="table"),
    pytest.param(pendulum(1.0, 0.5, 3.0), id="pendulum"),
    pytest.param(bowl_scene([0.5, -0.2], [0.0, 0.0], 2.0), id="bowl"),
]


@compiled_only
@pytest.mark.parametrize("scene", SCENES)
@pytest.mark.parametrize(
    "method",
    [Moreau(1e-3), Located(1e-3), Located(1e-2, order=4), EventDriven(1e-9, 1e-9)],
    ids=["moreau", "located", "order four", "event-driven"],
)
def test_plain_python_gives_the_same_motion_with_a_notice(scene, method):
    expected = simulate(scene, method)
    with pytest.warns(
        UncompiledCallback, match=f"{scene.name!r} cannot be compiled and runs in plain Python"
    ):
        m = simulate(plain(scene), method)
    # one source, but compilers contract and reorder: rounding, a few times magnified
    assert len(m.t) == len(expected.t)
    np.testing.assert_allclose(m.t, expected.t, rtol=0, atol=1e-12)
    np.testing.assert_allclose(m.q, expected.q, rtol=0, atol=1e-11)
    np.testing.assert_array_equal(m.impacts.kind, expected.impacts.kind)
    middle = 0.5 * (m.t[0] + m.t[-1])
    np.testing.assert_allclose(m.at(middle), expected.at(middle), rtol=0, atol=1e-10)


@compiled_only
def test_the_notice_names_the_callback():
    with pytest.warns(UncompiledCallback, match=r"^motion of scene 'table'"):
        simulate(plain(ball_on_table(0.01, 40.0, 0.3, 0.02, 0.0, 0.01)), Moreau(1e-3))


@compiled_only
def test_joints_run_in_plain_python_where_one_of_several_callbacks_cannot_be_compiled():
    def weight(t, q, v, p, out):
        out[0], out[1] = 0.0, -9.81

    def circle(t, q, v, p, out):
        out[0] = q[0] ** 2 + q[1] ** 2 - 1.0

    def normal(t, q, v, p, out):
        out[0, 0], out[0, 1] = 2.0 * q[0], 2.0 * q[1]

    system, start = System(2, np.eye(2), weight), ([1.0, 0.0], [0.0, 0.0], (0.0, 0.3))
    expected = simulate(Scene(system, *start, joints=Joints(1, circle, normal)), EventDriven(1e-9, 1e-9))
    with pytest.warns(UncompiledCallback, match=r"^joints\.gap of scene"):
        m = simulate(
            Scene(system, *start, joints=Joints(1, remembering(circle), normal)), EventDriven(1e-9, 1e-9)
        )
    np.testing.assert_allclose(m.q[-1], expected.q[-1], rtol=0, atol=1e-10)


def test_callbacks_that_read_variables_around_them_are_compiled():
    stiffness = 7.0

    def spring(t, q, v, p, out):
        out[0] = -stiffness * q[0]

    scene = Scene(system=System(1, 1.0, spring), q0=1.0, v0=0.0, t_span=(0.0, 1.0))
    m = simulate(scene, Moreau(1e-3))  # a warning would be an error here
    assert m.q[-1, 0] == pytest.approx(math.cos(math.sqrt(7.0)), abs=1e-6)


def test_every_callback_of_a_closure_has_its_own_numbers():
    def scene(k):
        def spring(t, q, v, p, out):
            out[0] = -k * q[0]

        return Scene(system=System(1, 1.0, spring), q0=1.0, v0=0.0, t_span=(0.0, 1.0))

    for k in (1.0, 4.0, 9.0):
        assert simulate(scene(k), Moreau(1e-3)).q[-1, 0] == pytest.approx(math.cos(math.sqrt(k)), abs=1e-5)


GRAVITY = 8.0


def fall(t, q, v, p, out):
    out[0] = -GRAVITY


def test_a_changed_global_is_seen_by_the_next_run(monkeypatch):
    scene = Scene(system=System(1, 1.0, fall), q0=0.0, v0=0.0, t_span=(0.0, 1.0))
    assert simulate(scene, Moreau(0.5)).v[-1, 0] == -8.0
    monkeypatch.setitem(globals(), "GRAVITY", 2.0)
    assert simulate(scene, Moreau(0.5)).v[-1, 0] == -2.0


RUN = """
import numpy as np
from lagrangian import Scene, System, scenes
from lcpstep import EventDriven, Located, Moreau, SimulationError, SimulationInterrupted, simulate
import sys

def swing(t, q, v, p, out):
    out[0] = -np.sin(q[0]) + np.cos(t)

own = Scene(System(1, 1.0, swing), q0=1.0, v0=0.0, t_span=(0.0, 0.1))
for scene in (scenes.cam_follower(t_end=0.1), scenes.bouncing_ball(t_end=1.0), own):
    for method in Moreau(1e-3), EventDriven():
        m = simulate(scene, method)
        print(*(x.hex() for x in m.at(0.09)[0]), len(m.t), len(m.impacts))
print("numba" in sys.modules)
"""
NO_NUMBA = """
import sys, warnings

class Missing:
    @staticmethod
    def find_spec(name, path=None, target=None):
        if name.partition(".")[0] in ("numba", "llvmlite"):
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)

sys.meta_path.insert(0, Missing)
warnings.simplefilter("always")
from lcpstep.maps import periods
from lcpstep.model import UncompiledCallback

def push(t, x, p, out):
    out[0], out[1] = x[1], -x[0]

def falling_side(t, x, p, out):
    out[0] = x[0]

def own_gap(t, q, v, p, out):
    out[0] = q[0] + 2.0

def own_slope(t, q, v, p, out):
    out[0, 0] = 1.0
"""
EVERY_METHOD = """
from lagrangian import Contacts, Guard, HybridScene, HybridSystem, Mode
from lcpstep import LcpStepError
both = Scene(System(1, 1.0, swing), 1.0, 0.0, (0.0, 0.1), Contacts(1, own_gap, own_slope))
system = HybridSystem(2, {"right": Mode(push, [Guard(falling_side, "left")]), "left": Mode(push)})
with warnings.catch_warnings(record=True) as said:
    for scene in (both, own, HybridScene(system, [-0.05, 1.0], "right", (0.0, 0.1))):
        for method in (
            Moreau(1e-2), Moreau(1e-2, tolerance=1e-2), Moreau(1e-2, lcp="newton"), Located(1e-2), Located(1e-2, 4),
            Located(1e-2, tolerance=1e-2), EventDriven(),
        ):
            if scene in (both, own) or isinstance(method, EventDriven):
                print(simulate(scene, method).status.name)
print(*(w.message for w in said if w.category is UncompiledCallback), sep=chr(10))
"""


def test_everything_runs_without_numba_and_one_line_says_that_it_is_missing():
    program = NO_NUMBA + RUN.partition("for scene in")[0] + EVERY_METHOD
    *states, said = python(program).split("\n")
    assert states == ["DONE"] * 15
    assert said.startswith("numba cannot be imported (No module named")


@pytest.mark.slow
def test_the_environment_can_ask_for_plain_python():
    plain, fast = (python(RUN, NUMBA_DISABLE_JIT=x) for x in "10")
    *plain, without = plain.split("\n")
    *fast, with_numba = fast.split("\n")
    assert (without, with_numba) == ("False", "True")
    for a, b in zip(plain, fast, strict=True):
        (q, *counts), (q_fast, *counts_fast) = a.split(), b.split()
        assert counts == counts_fast
        assert float.fromhex(q) == pytest.approx(float.fromhex(q_fast), abs=1e-13)


# --- what a callback keeps, and what it writes into later


@compiled_only
def test_states_that_a_callback_keeps_stay_as_they_were():
    kept = []

    def force(t, q, v, p, out):
        kept.append((t, q, v, p, out))
        out[0] = -p[0]

    scene = Scene(System(1, 1.0, force), 1.0, 0.0, (0.0, 0.4), p=[8.0])
    with pytest.warns(UncompiledCallback):
        simulate(scene, Located(1e-2))
    assert len(kept) >= 40
    for t, q, v, p, out in kept:
        assert (p[0], out[0]) == (8.0, -8.0)
        assert q[0] == pytest.approx(1.0 - 4.0 * t * t, abs=1e-3)
        assert v[0] == pytest.approx(-8.0 * t, abs=0.1)  # velocity Verlet asks with one foretold
    for *_, out in kept:
        out[0] = 7.0  # nobody else's memory


@compiled_only
@pytest.mark.parametrize("way", ["flags", "base"])
@pytest.mark.parametrize("method", [Moreau(1e-2), EventDriven()], ids=["moreau", "event-driven"])
def test_no_way_leads_to_the_numbers_of_the_run(way, method):
    def force(t, q, v, p, out):
        out[0] = -8.0
        if t > 0.2 and way == "flags":
            q.flags.writeable = True
        if t > 0.2:
            x = q if way == "flags" or q.base is None else q.base
            x[0] = 5.0

    with (
        pytest.warns(UncompiledCallback),
        pytest.raises(SimulationError, match=r"ValueError|TypeError") as caught,
    ):
        simulate(Scene(System(1, 1.0, force), 1.0, 0.0, (0.0, 0.4)), method)
    run = caught.value.trajectory
    np.testing.assert_allclose(run.q[:, 0], 1.0 - 4.0 * run.t**2, atol=0.02)
