"""Ground with edges and valleys, where the row of a contact jumps with the place: nobody names a time for that."""

import numpy as np
import pytest

from lagrangian import Contacts, Coulomb, LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Located, Moreau, Status, simulate

FALLS = LinearSystem(np.eye(2), force=[0.0, -9.81])


def slope_at(q, p):
    """Slopes p[0] on the left of the edge, which is at p[2], and p[1] on its right."""
    return p[0] if q[0] < p[2] else p[1]


def gap(t, q, v, p, out):
    out[0] = q[1] - slope_at(q, p) * (q[0] - p[2])


def normal(t, q, v, p, out):
    out[0, 0], out[0, 1] = -slope_at(q, p), 1.0


def tangent(t, q, v, p, out):
    out[0, 0], out[0, 1] = 1.0, slope_at(q, p)


def at_rest(t, q, v, p, out):
    out[0] = 0.0


def sliding(slopes, speed, friction=None, edge=0.0):
    """A particle that slides up to the edge from 0.3 m on its left."""
    ground = Contacts(1, gap, normal, bias=at_rest, restitution=0.3, friction=friction)
    return Scene(
        FALLS,
        [edge - 0.3, -0.3 * slopes[0]],
        [speed, speed * slopes[0]],
        (0.0, 0.3),
        ground,
        p=[*slopes, edge],
    )


def at_the_edge(slopes, speed):
    """When it is there, and how fast along x."""
    pull = -9.81 * slopes[0] / (1.0 + slopes[0] ** 2)
    reached = np.sqrt(speed**2 + 0.6 * pull)
    return 0.6 / (speed + reached), reached


PLAIN = [
    EventDriven(),
    Located(1e-3),
    Located(1e-3, 4),
    Located(1e-2, tolerance=1e-6),
    Located(1e-2, 4, tolerance=1e-7),
]
METHODS = [(method, None) for method in PLAIN]
METHODS += [(EventDriven(), 1e-14), (Located(1e-3), 1e-14), (Located(1e-3, 4), 1e-14)]


@pytest.mark.parametrize(("method", "mu"), METHODS)
@pytest.mark.parametrize("slopes", [(0.5, -0.5), (0.22, -0.37), (-0.2, -0.9)])
def test_what_slides_over_a_ridge_flies_off(method, mu, slopes):
    """It was held to the other slope, as if glued to it."""
    friction = None if mu is None else Coulomb(mu, tangent, slip=at_rest)
    for speed in (3.0, 3.3, 3.7):
        m = simulate(sliding(slopes, speed, friction), method, keep=[0.15])
        time, reached = at_the_edge(slopes, speed)
        later = 0.15 - time
        true = [reached * later, slopes[0] * reached * later - 0.5 * 9.81 * later**2]
        assert m.q[-1] == pytest.approx(true, abs=1e-8)


def over_a_roof(slope, speed, mu):
    """A scene in which a particle slides over a roof with friction and flies off, and where it is after 0.15 s."""
    pull = -9.81 * (slope + mu) / (1.0 + slope**2)
    reached = np.sqrt(speed**2 + 0.6 * pull)
    later = 0.15 - 0.6 / (speed + reached)
    true = [reached * later, slope * reached * later - 0.5 * 9.81 * later**2]
    return sliding((slope, -slope), speed, Coulomb(mu, tangent, slip=at_rest)), true


def landing_before_an_edge(rise, share):
    """One that hops, lands shortly before an edge, and hops over it; and where it is after 0.04 s."""
    speed, mu, r, time = 2.0, 0.1, 0.3, 2.0 * rise / 9.81
    rough = Coulomb(mu, tangent, slip=at_rest)
    ground = Contacts(1, gap, normal, bias=at_rest, restitution=r, friction=rough)
    start = -share * speed * time
    later, slower, up = 0.04 - time, speed - mu * (1.0 + r) * rise, r * rise
    true = [start + speed * time + slower * later, up * later - 0.5 * 9.81 * later**2]
    return Scene(FALLS, [start, 0.0], [speed, rise], (0.0, 0.04), ground, p=[0.0, -0.6, 0.0]), true


@pytest.mark.parametrize("method", PLAIN)
@pytest.mark.parametrize(("slope", "speed"), [(0.5, 3.0), (0.6, 3.7)])
def test_what_slides_over_a_roof_with_friction_flies_off(slope, speed, method):
    """By a tolerance steps became too short to be told from the edge, and the body was dragged round it."""
    scene, true = over_a_roof(slope, speed, 0.3)
    assert simulate(scene, method, keep=[0.15]).q[-1] == pytest.approx(true, abs=1e-8)


@pytest.mark.parametrize("method", PLAIN)
def test_rounding_of_places_hides_no_edge(method):
    """Far from the origin the time of the jump is told more finely than its place: bodies were dragged round it."""
    for edge in (100.2, 456.7, -1e4 - 0.3):
        for slopes, mu in (((0.5, -0.5), 0.0), ((0.3, -0.2), 0.0), ((0.5, -0.5), 0.2)):
            friction = Coulomb(mu, tangent, slip=at_rest) if mu > 0.0 else None
            m = simulate(sliding(slopes, 3.1, friction, edge), method, keep=[0.15])
            pull = -9.81 * (slopes[0] + mu) / (1.0 + slopes[0] ** 2)
            reached = np.sqrt(3.1**2 + 0.6 * pull)
            later = 0.15 - 0.6 / (3.1 + reached)
            true = [edge + reached * later, slopes[0] * reached * later - 0.5 * 9.81 * later**2]
            assert m.q[-1] == pytest.approx(true, rel=0.0, abs=1e-7)


@pytest.mark.parametrize("method", PLAIN)
@pytest.mark.parametrize(("rise", "share"), [(0.05, 1.005), (0.005, 1.02), (0.001, 1.2)])
def test_an_edge_hides_no_landing_just_before_it(rise, share, method):
    """The gap was above zero at both ends of a step, and the edge between its landing and the end of that step.

    The low hop that follows passes the edge: `EventDriven` came nearer and nearer to it, but not beyond.
    """
    scene, true = landing_before_an_edge(rise, share)
    assert simulate(scene, method).q[-1] == pytest.approx(true, abs=1e-9)


@pytest.mark.parametrize("tolerance", [1e-4, 1e-6])
def test_moreau_by_a_tolerance_meets_it_beyond_edges(tolerance):
    """One step and its halves agreed on a velocity that they had braked up to the end of the step, or not at all."""
    cases = [over_a_roof(*drawn) for drawn in ((0.5, 3.0, 0.3), (0.4, 3.4, 0.2), (0.6, 3.7, 0.02))]
    cases += [landing_before_an_edge(*drawn) for drawn in ((0.05, 1.005), (0.05, 1.05))]
    for scene, true in cases:
        m = simulate(scene, Moreau(1e-2, tolerance=tolerance), keep=[0.15 if scene.t_span[1] > 0.1 else 0.04])
        assert m.status == Status.DONE
        assert m.q[-1] == pytest.approx(true, abs=10.0 * tolerance)


@pytest.mark.parametrize("method", [*PLAIN, Moreau(1e-2, tolerance=1e-6)])
@pytest.mark.parametrize("slopes", [(-0.4, 0.3), (0.1, 0.8), (-0.9, -0.1)])
def test_what_slides_into_a_valley_goes_on_up_its_other_side(slopes, method):
    """Its gap velocity before is zero, and does not rebound: what is left is the velocity along the other slope."""
    for speed in (3.0, 3.3, 3.7):
        m = simulate(sliding(slopes, speed), method, keep=[0.15])
        time, reached = at_the_edge(slopes, speed)
        onward = reached * (1.0 + slopes[0] * slopes[1]) / (1.0 + slopes[1] ** 2)
        later, pull = 0.15 - time, -9.81 * slopes[1] / (1.0 + slopes[1] ** 2)
        close = 1e-6 if isinstance(method, Moreau) else 1e-10
        assert m.q[-1, 0] == pytest.approx(onward * later + 0.5 * pull * later**2, abs=close)


def test_a_hop_passes_an_edge_shortly_before_it_would_land():
    """Its gap was looked at up to 0.93 of it, and the edge lay beyond."""
    slope, r = -0.1067, 0.32
    speed, rise, x, time = 1.5, 0.7, 0.0, 0.0
    start = [speed, slope * speed + rise]
    for _ in range(3):
        x, time = x + speed * 2.0 * rise / 9.81, time + 2.0 * rise / 9.81
        speed, rise = speed - slope * (1.0 + r) * rise / (1.0 + slope**2), r * rise
    start_x, later = -x - 0.98 * speed * 2.0 * rise / 9.81, 0.05
    ground = Contacts(1, gap, normal, bias=at_rest, restitution=r)
    scene = Scene(
        FALLS, [start_x, slope * start_x], start, (0.0, time + later), ground, p=[slope, -0.52, 0.0]
    )
    m = simulate(scene, EventDriven())
    x += start_x
    true = [x + speed * later, slope * (x + speed * later) + rise * later - 0.5 * 9.81 * later**2]
    assert m.q[-1] == pytest.approx(true, abs=1e-9)


HOPS = [
    (0.8814671487857262, 0.8212232385192159, 0.6594251159345395, 0.5941594508599993, -0.10039945465653566)
]
HOPS += [
    (0.36432712811972556, 0.7151897662822347, 0.7476208357792027, 0.30602428704577783, -0.6699650970111957)
]
HOPS += [(0.7222556724119291, 0.640834184011673, 0.5461876620485476, 0.4177680734751351, -0.5866269753789466)]


@pytest.mark.parametrize(("slope", "restitution", "x", "y", "speed"), HOPS)
def test_a_hop_may_end_on_the_other_side_of_a_valley(slope, restitution, x, y, speed):
    """Its landing was put where the acceleration above the first slope would have it, below the second."""
    planes = LinearContacts([[-slope, 1.0], [slope, 1.0]], restitution=restitution)
    flat = simulate(Scene(FALLS, [x, y], [speed, 0.0], (0.0, 0.8), planes), EventDriven())
    end = flat.impacts.time[flat.impacts.contact == 1][0] + 0.005
    valley = Contacts(1, gap, normal, bias=at_rest, restitution=restitution)
    scene = Scene(FALLS, [x, y], [speed, 0.0], (0.0, end), valley, p=[-slope, slope, 0.0])
    m = simulate(scene, EventDriven(), keep=[end])
    assert m.q == pytest.approx(flat.at(m.t)[0], abs=1e-9)


def test_two_bodies_coupled_by_a_spring_fly_off_one_after_the_other():
    """The edge was found on a step that was too long to be exact, and a jump so near it was excused as drift."""

    def each(t, q, v, p, out):
        for k in range(2):
            out[k] = q[2 * k + 1] - (p[0] if q[2 * k] < 0.0 else p[1]) * q[2 * k]

    def rows(t, q, v, p, out):
        out[:] = 0.0
        for k in range(2):
            out[k, 2 * k], out[k, 2 * k + 1] = -(p[0] if q[2 * k] < 0.0 else p[1]), 1.0

    slopes, speed, k, mu, x, d = (
        [0.18275911524109278, -0.5474696116332041],
        2.0617630755090612,
        23.605325637359034,
        0.2555000666558205,
        -0.1791076592435124,
        0.26784251650220603,
    )
    stiff = np.zeros((4, 4))
    stiff[::2, ::2] = [[k, -k], [-k, k]]
    pair = LinearSystem(np.eye(4), K=stiff, force=[0.0, -9.81, 0.0, -9.81])
    rough = Coulomb(mu, rows_along, slip=two_at_rest)
    ground = Contacts(2, each, rows, bias=two_at_rest, restitution=0.4510753630911693, friction=rough)
    q, v = [x, slopes[0] * x, x - d, slopes[0] * (x - d)], 2 * [speed, speed * slopes[0]]
    scene = Scene(pair, q, v, (0.0, 0.254994477429067), ground, p=[*slopes, 0.0])
    end = [scene.t_span[1]]
    reference = simulate(scene, EventDriven(), keep=end).q
    assert simulate(scene, Located(1e-2, tolerance=1e-6), keep=end).q == pytest.approx(reference, abs=1e-4)


def rows_along(t, q, v, p, out):
    out[:] = 0.0
    for k in range(2):
        out[k, 2 * k], out[k, 2 * k + 1] = 1.0, (p[0] if q[2 * k] < 0.0 else p[1])


def two_at_rest(t, q, v, p, out):
    out[:] = 0.0


def beyond(q):
    """How far the centre of a disc of radius 1 is beyond the edge of its table, which it rolls around."""
    return max(q[0], 0.0)


def distance(t, q, v, p, out):
    out[0] = np.hypot(beyond(q), q[1]) - 1.0


def direction(t, q, v, p, out):
    r = np.hypot(beyond(q), q[1])
    out[0, 0], out[0, 1] = beyond(q) / r, q[1] / r


@pytest.mark.parametrize("method", [EventDriven(), Located(0.1, 4, tolerance=1e-8)])
@pytest.mark.parametrize("speed", [3.14, 3.3, 5.0, 12.0])
def test_a_disc_faster_than_its_weight_can_turn_flies_off_the_edge_where_the_curvature_jumps(method, speed):
    """Beyond it no force would hold it at speeds above sqrt(g R); the gap's acceleration is left to differences."""
    edge = 0.5 / speed
    table = Contacts(1, distance, direction)
    run = simulate(Scene(FALLS, [-0.5, 1.0], [speed, 0.0], (0.0, edge + 0.5), table), method)
    t = np.linspace(0.0, edge + 0.5, 301)
    exact = np.stack([speed * t - 0.5, 1.0 - 0.5 * 9.81 * np.maximum(t - edge, 0.0) ** 2], axis=1)
    assert run.status == Status.DONE
    np.testing.assert_allclose(run.at(t)[0], exact, atol=1e-10)
