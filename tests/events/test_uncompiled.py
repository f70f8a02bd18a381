"""The event loop's kernels as plain Python give what they give when built."""

import pytest

from tests.uncompiled import both_ways

PROGRAM = """
from lagrangian import Contacts, Joints, LinearContacts, LinearSystem, Scene, System
from lcpstep import EventDriven, simulate

def weight(t, q, v, p, out):
    out[0], out[1] = 0.0, -9.81

def length(t, q, v, p, out):
    out[0] = q[0] * q[0] + q[1] * q[1] - 1.0

def radius(t, q, v, p, out):
    out[0, 0], out[0, 1] = 2.0 * q[0], 2.0 * q[1]

def drag(t, q, v, p, out):
    out[0] = -9.81 - 0.3 * v[0]

ball = Scene(
    system=System(1, 1.0, drag), q0=[0.01], v0=[0.0], t_span=(0.0, 0.16),
    contacts=LinearContacts(1.0, restitution=0.5), corners=[0.1355],
)
pendulum = Scene(
    system=System(2, [[1.0, 0.0], [0.0, 1.0]], weight), q0=[0.6, -0.8], v0=[0.0, 0.0], t_span=(0.0, 0.5),
    joints=Joints(1, length, radius), contacts=LinearContacts([[1.0, 0.0]], restitution=0.5),
)
beads = Scene(
    system=LinearSystem([[1.0, 0.0], [0.0, 2.0]], force=[-9.81, -19.62]), q0=[0.1, 0.3], v0=[0.0, 0.0],
    t_span=(0.0, 0.4), contacts=LinearContacts([[1.0, 0.0], [-1.0, 1.0]], restitution=[0.5, 0.8]),
)
for scene in (ball, pendulum, beads):
    run = simulate(scene, EventDriven(rtol=1e-7, atol=1e-7), keep=1)
    print(len(run.t), run.counts, *(float(x).hex() for x in (*run.q[-1], *run.v[-1], *run.impacts.impulse)))
"""


WITH_MODES = """
from lagrangian import Guard, HybridScene, HybridSystem, LinearContacts, Mode
from lcpstep import EventDriven, simulate

def heavy(t, x, p, out):
    out[0], out[1] = x[1], -9.81

def light(t, x, p, out):
    out[0], out[1] = x[1], -2.0

def low(t, x, p, out):
    out[0] = 0.05 - x[0]

def slow(t, x, p, out):
    out[0] = x[1] - 0.3

def kicked(t, x, p, out):
    out[0], out[1] = x[0], 0.9 * x[1]

modes = {
    "heavy": Mode(heavy, [Guard(low, "light", at_once=False)]),
    "light": Mode(light, [Guard(slow, "heavy", -1, kicked)]),
}
ball = HybridScene(
    HybridSystem(2, modes, mass=[[2.0]]), [0.1, 0.0], "heavy", (0.0, 0.7), contacts=LinearContacts([[1.0]], 0.0, 0.6)
)
run = simulate(ball, EventDriven(rtol=1e-7, atol=1e-7))
print(run.status.name, len(run.t), run.counts, *run.switches.target, *run.impacts.kind)
print(*(float(x).hex() for x in (*run.x[-1], *run.impacts.impulse, *run.switches.time)))
"""


@pytest.mark.slow
def test_systems_with_modes_and_contacts_of_the_sources_alone_are_those_of_what_is_built():
    built, plain = both_ways(WITH_MODES)
    assert built == plain
    assert built[0].startswith("DONE")


@pytest.mark.slow
def test_motions_of_the_sources_alone_are_those_of_what_is_built():
    built, plain = both_ways(PROGRAM)
    assert built == plain
