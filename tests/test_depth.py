"""A run that is through the wall says so; the penetration that belongs to time-stepping is none of this."""

import json
from dataclasses import dataclass, replace

import numpy as np
import pytest

from benchmarks.judge.describe import Description
from lagrangian import Contacts, Coulomb, LinearContacts, LinearSystem, Scene, scenes
from lcpstep import EventDriven, Located, Moreau, cli, simulate
from lcpstep.doubts.depth import too_deep
from lcpstep.trajectory import Status

FALLING = LinearSystem(M=1.0, force=-9.81)
FREE = Scene(FALLING, 1.0, 0.0, (0.0, 2.0), name="free fall")
FLOOR = LinearContacts(1.0)


@dataclass(frozen=True)
class Through:
    """A method that does not see contacts."""

    method: object
    h: float = 0.0

    def run(self, scene, kept, progress):
        method = replace(self.method, h=self.h) if self.h else self.method
        found = method.run(replace(scene, contacts=None), kept, progress)
        return replace(found, scene=scene, impulse=np.zeros((len(found.t), scene.n_c)))


def height(t, q, v, p, out):
    out[0] = q[0]


def one(t, q, v, p, out):
    out[0, 0] = 1.0


@pytest.mark.parametrize("keep", [1, 100, [2.0], [0.1, 1.0, 2.0]])
@pytest.mark.parametrize(
    "method", [Moreau(1e-2), Located(1e-2), EventDriven()], ids=["moreau", "located", "event"]
)
@pytest.mark.parametrize("contacts", [FLOOR, Contacts(1, height, one)], ids=["flat", "curved"])
def test_a_motion_through_the_floor_says_so(contacts, method, keep):
    m = simulate(replace(FREE, contacts=contacts), Through(method), keep=keep)
    assert m.status is Status.DONE
    deep = 0.5 * 9.81 * 4.0 - 1.0  # at the end
    assert m.doubt.startswith(f"contact 0 lies {deep:.3g} m inside of its obstacle at t = 2 s")
    assert m.message.endswith(f"the span, but {m.doubt}")
    assert simulate(FREE, method, keep=keep).doubt == ""


@pytest.mark.parametrize("theta", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("steps", [5, 20, 100])
@pytest.mark.parametrize(
    "name",
    [
        "bouncing-ball",
        "chattering-table",
        "jumping-table",
        "impact-oscillator",
        "block-on-feet",
        "heavy-on-light",
    ],
)
def test_what_order_one_lies_inside_of_an_obstacle_is_not_told(name, steps, theta):
    scene = scenes.CATALOGUE[name].make()
    for keep in (1, [scene.t_span[1]]):
        m = simulate(scene, Moreau((scene.t_span[1] - scene.t_span[0]) / steps, theta), keep=keep)
        assert too_deep(m) == ""
        # Steps of 5 s in a period of 6.3 s are told for their own sake, and explicit ones of 1 s, which feed it
        told = name == "impact-oscillator" and keep == 1 and (steps == 20 or (steps == 100 and theta == 0.0))
        assert bool(m.doubt) is ("but" in m.message) is told


def test_what_rests_is_not_told():
    at_rest = Scene(FALLING, 0.0, 0.0, (0.0, 1e3), FLOOR)
    for method in (Moreau(1.0), Located(1.0), EventDriven()):
        assert simulate(at_rest, method).doubt == ""


def test_rounding_of_a_force_that_begins_at_zero_is_not_told():
    """It holds in a slit without clearance, 843 states of which are off by 1e-23 m at most."""
    slit = Description(
        M=((0.325,),), q0=(0.0,), v0=(0.0,), t_span=(257.0, 257.0413162), h=4.91e-05, G=((1.0,), (-1.0,)),
        offset=(0.0, 0.0), K=((149000.0,),), constant=(-0.618146124643362,), cosine=(-0.357,), sine=(0.537,),
        force_omega=10.4, general=True, family="slit",
    )  # fmt: skip
    for method in (
        Located(slit.h),
        Located(slit.h, 4),
        Located(8.0 * slit.h, tolerance=1e-4),
        Moreau(slit.h),
    ):
        assert simulate(slit.scene(), method).doubt == ""


@pytest.mark.parametrize("share", [1e-4, 1e-2])
def test_steps_in_the_middle_of_a_run_count_where_impacts_are_found(share):
    """A hundredth of its way inside for a fiftieth of the run: half a step, which time-stepping alone explains."""
    ball = replace(FREE, contacts=FLOOR)
    m = simulate(ball, Located(1e-2))
    q = m.q.copy()
    q[100:105] = -share
    for method, told in ((m.method, share > 1e-3), (Moreau(1e-2), False)):
        assert bool(too_deep(replace(m, q=q, method=method))) is told


@pytest.mark.parametrize("order", [2, 4])
@pytest.mark.parametrize("scale", [1.0, 1e-6])
def test_rounding_that_comes_from_a_coordinate_beside_is_not_told(order, scale):
    """A slit without clearance holds one coordinate; masses and springs couple the other, shaken, to it."""
    frame = (-0.00242 * scale, -0.00127 * scale)
    beside = Description(
        M=((0.724, 0.126), (0.126, 2.98)), q0=(0.0, 0.0), v0=(0.0, 0.0), t_span=(0.0, 0.0814), h=0.00185,
        G=((1.0, 0.0), (-1.0, 0.0)), offset=(0.0, 0.0), restitution=(0.81, 0.3),
        K=((0.407, 1.22), (1.22, 4.62)), frame=frame, omega=27.6, family="slit",
    )  # fmt: skip
    m = simulate(beside.scene(), Located(beside.h, order))
    assert (m.status, m.doubt) == (Status.DONE, "")


def test_rounding_of_beads_that_one_of_them_presses_together_is_not_told():
    """Forces act on the third alone; the first contact has none of its own."""
    G = np.diff(np.eye(6), axis=0)
    beads = LinearContacts(np.vstack([G, np.eye(6)[0]]), restitution=0.26)
    pressed = Scene(
        LinearSystem(np.eye(6), force=-11.5 * np.eye(6)[2]), np.zeros(6), np.zeros(6), (0.0, 1.0), beads
    )
    rounded = np.array([np.zeros(6), 1e-17 * np.arange(6, 0, -1)])
    m = simulate(pressed, Located(0.1), keep=[0.5, 1.0])
    assert too_deep(replace(m, q=rounded, v=np.zeros((2, 6)))) == ""


@pytest.mark.parametrize("form", [[], ["--json"]])
def test_the_command_tells_and_exits_with_one(capsys, monkeypatch, form):
    monkeypatch.setitem(cli.simulate.METHODS, "moreau", lambda *given: Through(Moreau(1e-2)))
    assert cli.main(["simulate", "bouncing-ball", "--t-end", "2", *form]) == 1
    out = capsys.readouterr().out
    assert "inside of its obstacle" in (json.loads(out)["message"] if form else out.split("\n")[0])
    monkeypatch.undo()
    assert cli.main(["simulate", "bouncing-ball", "--t-end", "2", *form]) == 0


def test_the_comparison_tells_too(capsys, monkeypatch):
    monkeypatch.setattr(cli.compare, "moreau", lambda *given: Through(Moreau(1e-2), 1e-2))
    arguments = ["compare", "bouncing-ball", "--t-end", "2", "--no-pictures"]
    assert cli.main(arguments) == 1
    assert "inside of its obstacle" in capsys.readouterr().out
    monkeypatch.undo()
    assert cli.main(arguments) == 0


@pytest.mark.parametrize("mu", [None, 0.3])
def test_links_that_fly_off_together_do_not_hide_one_that_is_inside_of_another(mu):
    """The second runs into the first by 0.3 m while both go 20 m, rubbing or not."""
    friction = None if mu is None else Coulomb(mu, [[0.0, 0.0, 1.0]])
    pair = LinearContacts([[-1.0, 1.0, 0.0]], [0.1], [0.5], friction=friction)
    scene = Scene(
        LinearSystem(np.eye(3), force=np.zeros(3)), [0.0] * 3, [10.2, 10.0, 0.0], (0.0, 2.0), contacts=pair
    )
    m = simulate(scene, Through(EventDriven()))
    assert m.doubt.startswith("contact 0 lies 0.3 m inside of its obstacle at t = 2 s")
    assert simulate(scene, EventDriven()).doubt == simulate(scene, Located(0.1)).doubt == ""


def squeezing(ratio):
    """A light body at rest between a wall and a heavy one that comes at 1 m/s; all elastic."""
    masses = LinearSystem(np.diag([1.0, ratio]))
    walls = LinearContacts([[1.0, 0.0], [-1.0, 1.0]], 0.0, 1.0)
    return Scene(masses, [0.5, 1.0], [0.0, -1.0], (0.0, 3.0), walls)


def test_a_heavy_body_that_a_light_and_fast_one_lets_through_the_wall_is_told():
    """It turns round at sqrt(1/ratio)/2 from the wall, whatever passes between: x2 = 2 m, nearly, at the end."""
    run = simulate(squeezing(1e8), Moreau(1e-2))
    assert run.q[-1, 1] < -1.5
    assert "inside of its obstacle" in run.doubt
    resolved = simulate(squeezing(1e2), Moreau(1e-3))
    assert resolved.q[-1, 1] == pytest.approx(2.0, abs=0.03)
    assert resolved.doubt == ""
