"""The same motion whatever else is asked: span, start of time, names, units, what is kept, a stop half-way."""

import math

import numpy as np
import pytest

from lagrangian import Contacts, Harmonic, LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Kind, Status, simulate
from tests.events.test_corners_and_slits import bundle
from tests.marks import shared

TOLERANCE, SPAN = 1e-11, 5.0
METHOD = EventDriven(TOLERANCE, TOLERANCE, max_events=50_000)
WELL_SEEN = 1e-3  # m/s: lower impacts of a chattering sequence may be left out


def same(scene, t0=0.0, span=SPAN, order=None, unit=1.0, state=None):
    """The scene begun at t0, its contacts in another order, its lengths in another unit, from another state."""
    w, terms = scene.system.force.omega, scene.system.force.terms(scene.n_q)
    constant, c, s = (unit * np.asarray(term) for term in terms)
    cosine = c * math.cos(w * t0) - s * math.sin(w * t0)
    sine = c * math.sin(w * t0) + s * math.cos(w * t0)
    force = Harmonic(constant=constant, cosine=cosine, sine=sine, omega=w)
    contacts, order = scene.contacts, np.arange(scene.n_c) if order is None else order
    q0, v0 = (scene.q0, scene.v0) if state is None else state
    return Scene(
        LinearSystem(M=scene.system.M, K=scene.system.K, force=force), unit * np.asarray(q0),
        unit * np.asarray(v0), (t0, t0 + span),
        LinearContacts(
            G=np.asarray(contacts.G)[order], offset=unit * np.asarray(contacts.offset)[order],
            restitution=np.broadcast_to(contacts.restitution, scene.n_c)[order],
        ),
        name=scene.name,
    )  # fmt: skip


def assert_same(m, other, until=SPAN, t0=0.0, unit=1.0):
    """First impacts of any size at the same times, and the same positions."""
    times = []
    for run, start, scale in ((m, 0.0, 1.0), (other, t0, unit)):
        hits = run.impacts[(run.impacts.kind == Kind.IMPACT) & (run.impacts.before < -WELL_SEEN * scale)]
        times.append((hits.time - start)[hits.time - start < until - 1e-6][:8])
    np.testing.assert_allclose(times[0], times[1], rtol=0, atol=1e-7)
    t = np.linspace(0.0, 0.25 * min(until, m.t[-1], other.t[-1] - t0), 100)
    positions = other.at(np.clip(t + t0, other.t[0], other.t[-1]))[0] / unit
    np.testing.assert_allclose(positions, m.at(t)[0], rtol=0, atol=1e-6)


def each_plane_once(scene):
    """Where a plane is given twice, rounding decides which contact is told, and whose restitution is the law's."""
    contacts = scene.contacts
    planes = np.column_stack([contacts.G, contacts.offset])
    planes /= np.linalg.norm(contacts.G, axis=1)[:, None]
    first = [c for c in range(scene.n_c) if not np.any(np.all(np.abs(planes[:c] - planes[c]) < 1e-9, axis=1))]
    r = np.broadcast_to(contacts.restitution, scene.n_c)[first]
    kept = LinearContacts(G=contacts.G[first], offset=contacts.offset[first], restitution=r)
    return Scene(scene.system, scene.q0, scene.v0, scene.t_span, kept, name=scene.name)


def check(seed):
    scene = each_plane_once(bundle(seed))
    m = simulate(same(scene), METHOD)
    assert m.status is Status.DONE, m.message
    for span in (0.47 * SPAN, 3.0 * SPAN):
        assert_same(m, simulate(same(scene, span=span), METHOD), until=min(span, SPAN))
    for t0 in (-1e3, 1e3):
        assert_same(m, simulate(same(scene, t0=t0), METHOD), t0=t0)
    order = np.random.default_rng(seed).permutation(scene.n_c)
    assert_same(m, simulate(same(scene, order=order), METHOD))
    for unit in (1e-3, 1e3):
        method = EventDriven(TOLERANCE, unit * TOLERANCE, max_events=50_000)
        assert_same(m, simulate(same(scene, unit=unit), method), unit=unit)
    kept = simulate(same(scene), METHOD, keep=np.linspace(0.0, SPAN, 7))
    np.testing.assert_array_equal(kept.impacts.time, m.impacts.time)


@pytest.mark.parametrize("seed", range(20))
def test_the_motion_does_not_depend_on_how_it_is_asked_for(seed):
    check(seed)


@pytest.mark.parametrize("seed", shared(range(20, 300), 5))
def test_nor_do_many_more(seed):
    check(seed)


@pytest.mark.parametrize("seed", range(20))
def test_a_motion_goes_on_from_its_middle_as_if_it_had_not_been_stopped(seed):
    scene = bundle(seed)
    scene = Scene(  # without time in its force
        LinearSystem(M=scene.system.M, K=np.eye(scene.n_q), force=scene.system.force.constant), scene.q0,
        scene.v0, (0.0, SPAN), scene.contacts,
    )  # fmt: skip
    m = simulate(scene, METHOD)
    breaks = np.concatenate([[1.0], m.impacts.time[(m.impacts.time > 1.0) & (m.impacts.time < 3.0)], [3.0]])
    k = np.argmax(np.diff(breaks))
    middle = 0.5 * (breaks[k] + breaks[k + 1])  # of the longest time without an event
    q, v = m.at(middle)
    rest = Scene(scene.system, q, v, (middle, SPAN), scene.contacts)
    t = np.linspace(middle, middle + 0.3 * (SPAN - middle), 100)
    np.testing.assert_allclose(simulate(rest, METHOD).at(t)[0], m.at(t)[0], rtol=0, atol=1e-6)


def over_hills(t, q, v, p, out):
    out[0] = q[1] - 0.2 * math.cos(9.0 * q[0])


def off_hills(t, q, v, p, out):
    out[0, 0], out[0, 1] = 1.8 * math.sin(9.0 * q[0]), 1.0


def test_late_times_do_not_change_the_motion_over_hills():
    """An elastic body that falls onto hills; its impacts separate neighbours, so that little errors are seen."""
    hills = Contacts(1, over_hills, off_hills, restitution=1.0)
    system = LinearSystem(M=np.eye(2), force=[0.0, -250.0])
    early, late = (
        simulate(Scene(system, [0.1, 0.6], [1.4, 0.0], (t0, t0 + 0.5), hills), EventDriven()).impacts
        for t0 in (0.0, 1e4)
    )
    assert len(early) == len(late) >= 7
    np.testing.assert_allclose(late.before, early.before, rtol=0, atol=1e-9)
