"""Impacts of two runs matched: which are partners, and which are the first different event."""

import math

import numpy as np
import pytest

from lcpstep.errorbar.partners import partners
from lcpstep.trajectory import IMPACT_DTYPE, Kind

FINE = 1e-9


def log(*rows, kind=Kind.IMPACT):
    """Impacts (time, contact, jump), of unit mass from rest."""
    return np.array([(t, c, -j / 2, j / 2, j, kind) for t, c, j in rows], dtype=IMPACT_DTYPE).view(
        np.recarray
    )


def test_partners_have_the_same_place_in_the_order_of_their_contact():
    a = log((1.0, 0, 2.0), (1.5, 1, 1.0), (2.0, 0, 1.5))
    b = log((1.01, 0, 2.1), (1.5, 1, 1.0), (2.03, 0, 1.4))
    found = partners(a, b, 3.0, FINE)
    assert found.differs == math.inf
    assert sorted(found.pairs.rows) == [0, 1, 2]
    by_row = dict(zip(found.pairs.rows, found.pairs.of_row, strict=True))
    assert found.pairs.time[by_row[0]] == pytest.approx(0.01)
    assert found.pairs.time[by_row[1]] == 0.0
    assert found.pairs.impulse[by_row[2]] == pytest.approx(0.1)


@pytest.mark.parametrize("swapped", [False, True])
def test_a_strong_impact_without_partner_is_a_different_event_and_a_weak_one_is_not(swapped):
    some, more = [(1.0, 0, 2.0), (3.0, 0, 2.0)], [(1.0, 0, 2.0), (2.0, 0, 0.5), (3.0, 0, 2.0)]
    pair = [log(*some), log(*more)]
    found = partners(*(pair[::-1] if swapped else pair), 4.0, FINE)
    assert found.differs == 2.0
    assert f"an impact of the {'run' if swapped else 'companion'} without partner" in found.reason
    more[1] = (2.0, 0, 0.03)
    pair = [log(*some), log(*more)]
    found = partners(*(pair[::-1] if swapped else pair), 4.0, FINE)
    assert (found.differs, len(found.pairs.time)) == (math.inf, 2)


def test_partners_of_another_strength_are_a_different_event():
    found = partners(log((1.0, 0, 2.0), (2.0, 1, 2.0)), log((1.0, 0, 2.0), (2.0, 1, 0.5)), 3.0, FINE)
    assert found.differs == 2.0
    assert "another strength at contact 1" in found.reason


def test_impacts_within_the_resolution_count_as_one():
    apart = log((1.0, 0, 1.0), (1.05, 0, 1.0), (2.0, 0, 1.0))
    together = log((1.02, 0, 2.0), (2.0, 0, 1.0))
    assert partners(apart, together, 3.0, FINE).differs < math.inf
    found = partners(apart, together, 3.0, 0.1)
    assert found.differs == math.inf
    assert list(found.pairs.many) == [2, 1]
    assert np.allclose(found.pairs.impulse, 0.0)


def test_what_falls_beyond_the_end_of_one_run_is_no_different_event():
    a, b = log((1.0, 0, 2.0), (1.99, 0, 2.0)), log((1.02, 0, 2.0), (2.01, 0, 2.0))
    assert partners(a, b, 2.0, FINE).differs == math.inf
    assert partners(a, b[:1], 3.0, FINE).differs == 1.99


def test_events_after_which_the_runs_move_alike_do_not_differ():
    a = log((1.0, 0, 1.0), (1.0, 1, 1.0), (2.0, 0, 1.0))
    b = log((1.0, 0, 1.0), (2.0, 0, 1.0))
    assert partners(a, b, 3.0, FINE).differs == 1.0
    asked = []

    def alike(time, jump):
        asked.extend(zip(time, jump, strict=True))
        return time + 0.1

    found = partners(a, b, 3.0, FINE, alike=alike)
    assert asked == [(1.0, 1.0)]
    assert found.differs == math.inf
    assert [1.0, 1.1] in found.windows.tolist()


def test_the_end_of_a_chattering_sequence_is_no_different_event():
    jumps = [2.0 * 0.5**k for k in range(12)]
    times = np.cumsum([0.0, *jumps[:-1]])
    end = float(times[-1] + 2.0 * jumps[-1])
    rows = [(t, 0, j) for t, j in zip(times, jumps, strict=True)]
    long = np.concatenate([log(*rows), log((end, 0, 0.0), kind=Kind.ACCUMULATION)])
    short = np.concatenate([log(*rows[:8]), log((end, 0, 0.0), kind=Kind.ACCUMULATION)])
    found = partners(long, short, 10.0, FINE)
    assert found.differs == math.inf
    assert any(times[7] < start <= times[8] and stop == pytest.approx(end) for start, stop in found.windows)


def test_a_sequence_that_ends_long_after_the_last_partners_is_left_out_from_where_it_begins():
    some = [(1.0, 0, 2.0), (50.0, 0, 1e-12), (50.0 + 1e-6, 0, 1e-13)]
    rest, end = log((1.5, 0, 0.0), kind=Kind.STICK), log((50.1, 0, 0.0), kind=Kind.ACCUMULATION)
    found = partners(np.concatenate([log(*some), rest, end]), log((1.0, 0, 2.0)), 100.0, FINE)
    assert found.differs == math.inf
    assert sum(stop - start for start, stop in found.windows) < 0.2


def test_no_impacts_at_all():
    found = partners(log(), log(), 1.0, FINE)
    assert (found.differs, found.reason, len(found.pairs.time), len(found.windows)) == (math.inf, "", 0, 0)
