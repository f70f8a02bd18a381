"""Maps from period to period refuse functions that do not repeat after it, and take all others."""

import math

import numpy as np
import pytest

from lagrangian import Contacts, LinearContacts, Scene, System, scenes
from lcpstep import EventDriven
from lcpstep.analysis.bifurcation import bifurcation
from lcpstep.maps import StroboscopicMap
from lcpstep.maps.batch import periodic

OMEGA = 30.0


def table(t, q, v, p, out):
    a, phase = p[0], OMEGA * t
    out[0, 0], out[0, 1], out[0, 2] = (
        a * math.sin(phase),
        a * OMEGA * math.cos(phase),
        -a * OMEGA**2 * math.sin(phase),
    )


def gap(t, q, v, p, out):
    out[0] = q[0] - p[0] * math.sin(OMEGA * t)


def gap_q(t, q, v, p, out):
    out[0, 0] = 1.0


def gap_t(t, q, v, p, out):
    out[0] = -p[0] * OMEGA * math.cos(OMEGA * t)


def push(t, q, v, p, out):
    out[0] = -9.81 * (1.0 + 0.1 * math.cos(OMEGA * t))


def weight(t, q, v, p, out):
    out[0] = -9.81


def ball(period, contacts=None, force=weight, **others):
    contacts = contacts or LinearContacts(1.0, motion=table, restitution=0.5)
    return Scene(System(1, 1.0, force), 0.05, 0.0, (0.0, 1.0), contacts, p=[0.01], period=period, **others)


@pytest.mark.parametrize(
    ("named", "parts"),
    [
        ("contacts.motion", {}),
        ("contacts.gap", {"contacts": Contacts(1, gap, gap_q, gap_t)}),
        ("system.force", {"contacts": LinearContacts(1.0), "force": push}),
    ],
)
@pytest.mark.parametrize("turns", [0.5, 0.955, 1.3, 2.5])
def test_what_is_another_function_a_period_later_is_named(named, parts, turns):
    period = turns * 2.0 * math.pi / OMEGA
    with pytest.raises(ValueError, match=rf"^period: {named} is .* a period of {period:.9g} s later") as told:
        StroboscopicMap(ball(period, **parts), EventDriven())
    assert "is the same again" in str(told.value)


def test_diagrams_refuse_it_before_any_run():
    def make(a):
        motion = LinearContacts(1.0, motion=lambda t, q, v, p, out: table(t, q, v, (a,), out))
        return ball(0.2, motion)

    with pytest.raises(ValueError, match=r"^period: contacts\.motion is "):
        bifurcation(make, "a", [0.011, 0.012], x0=[0.05, 0.0], drop=1, keep=1, jobs=1)


@pytest.mark.parametrize("turns", [1.0, 3.0, 1.0 + 1e-4])
def test_whole_turns_are_taken_also_rounded(turns):
    StroboscopicMap(ball(turns * 2.0 * math.pi / OMEGA), EventDriven())


def test_noise_and_what_fails_beyond_its_table_are_taken():
    numbers = np.random.default_rng(0)

    def noisy(t, q, v, p, out):
        out[0] = -9.81 + numbers.normal()

    def ends(t, q, v, p, out):
        if t > 0.25:
            raise ValueError("the table ends here")
        out[0] = -9.81 * (1.0 + 0.1 * math.cos(OMEGA * t))

    for force in (noisy, ends):
        periodic(ball(0.2, LinearContacts(1.0), lambda *a, f=force: f(*a)))


@pytest.mark.parametrize(
    "make", [scenes.ball_on_table, scenes.cam_follower, scenes.chattering_table, scenes.mass_on_shaken_belt]
)
def test_ready_scenes_are_taken(make):
    periodic(make())
