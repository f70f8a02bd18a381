"""The loop over time, and steps that are made again until they end at an event, against what is known of both."""

import math

import pytest

from tests import uncompiled

KERNELS = uncompiled.kernels("lcpstep.kernels")
COURSE = KERNELS.course
FULL = 77  # a code


class Walk(COURSE.Course):
    """A walk in steps of one up to 5, that something happens to at 0 and at 3, and that is refused beyond `most`."""

    def __init__(self, most=math.inf):
        self.place, self.said, self.waits, self.most = 0, [], True, most

    def stage(self, goal):
        if self.waits:
            return COURSE.DUE
        return COURSE.AHEAD if self.place < min(goal, 5) else COURSE.ARRIVED

    def happen(self):
        self.waits = False
        self.said.append(f"at {self.place}")
        return COURSE.DONE

    def refusal(self):
        return FULL if self.place >= self.most else COURSE.DONE

    def move(self):
        self.place += 1
        self.waits = self.place == 3
        self.said.append(self.place)
        return COURSE.DONE


def test_what_is_due_precedes_the_next_step_and_a_portion_ends_at_its_goal():
    walk = Walk()
    assert walk.advance(3) == COURSE.DONE
    assert walk.said == ["at 0", 1, 2, 3, "at 3"]
    walk.advance(9)
    assert walk.said[5:] == [4, 5]


def test_no_step_is_taken_where_one_is_refused():
    walk = Walk(most=2)
    assert walk.advance(9) == FULL
    assert walk.place == 2


class Decay(KERNELS.rungekutta.RungeKutta):
    """y' = -y from 1, and the event y = exp(-0.3)."""

    def __init__(self, known=True):
        super().__init__(1, 0, 1e-10, 1e-10)
        self.y[0], self.known, self.tried = 1.0, known, []

    def rates(self, t, y, dy):
        dy[0] = -y[0]
        return True

    def miss(self, t, tau):
        self.tried.append(tau)
        longer = (self.y_new[0] - math.exp(-0.3)) / self.y_new[0]
        return longer if self.known and abs(longer) > 1e-15 else 0.0


def test_a_step_is_made_again_until_it_ends_at_the_event():
    s = Decay()
    assert s.meet(0.0, 0.25, 1.0, 0.1, 9) == pytest.approx(0.3, abs=1e-11)  # one step has this error
    assert s.y_new[0] == pytest.approx(math.exp(-0.3), abs=1e-14)
    assert 3 <= len(s.tried) <= 5


@pytest.mark.parametrize(
    ("most", "far", "tries", "length"), [(0.27, 0.1, 9, 0.27), (1.0, 1e-3, 9, 0.25), (1.0, 0.1, 0, 0.25)]
)
def test_a_step_is_bounded_and_an_event_far_off_is_another(most, far, tries, length):
    s = Decay()
    assert s.meet(0.0, 0.25, most, far, tries) == length
    assert s.y_new[0] == pytest.approx(math.exp(-length), abs=1e-12)


def test_a_step_of_which_nothing_better_is_known_stays():
    s = Decay(known=False)
    assert s.meet(0.0, 0.25, 1.0, 0.1, 9) == 0.25
    assert len(s.tried) == 1
