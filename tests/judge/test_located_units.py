"""Scenes in other units of length, time and mass, by powers of two, which round nothing: the same runs."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.judge.describe import Description, numbers
from benchmarks.judge.draw import draw
from benchmarks.judge.runs import run

SHORT = 300  # steps


def in_units(d, length, time, mass):
    """The description of the same scene, whose numbers are so many times as large."""
    units = {
        "M": mass, "K": mass / time**2, "C": mass / time, "q0": length, "v0": length / time, "offset": length,
        "constant": mass * length / time**2, "cosine": mass * length / time**2, "sine": mass * length / time**2,
        "force_omega": 1.0 / time, "t_span": time, "h": time, "omega": 1.0 / time, "amplitude": length,
        "frame": length, "b": 1.0 / length, "pendulum": mass * length**2 / time**2, "spread": mass * length**2,
    }  # fmt: skip
    new = {name: np.array(getattr(d, name)) * unit for name, unit in units.items()}
    return replace(d, **{name: numbers(x) if x.ndim else float(x) for name, x in new.items()})


def described(seed, count):
    """Flat scenes without joints, with their units; roots of the unit of mass are powers of two too."""
    rng, k, found = np.random.default_rng(seed), 0, 0
    while found < count:
        d = draw(seed, k)
        k += 1
        if not (d.curved or d.J) and d.length < SHORT * d.h:
            found += 1
            yield d, 2.0 ** rng.integers(-20, 21), 2.0 ** rng.integers(-10, 11), 4.0 ** rng.integers(-10, 11)


@pytest.mark.slow
@pytest.mark.parametrize("method", ["located", "located-4", "located-exact"])
def test_a_scene_moves_alike_in_any_units(method):
    for d, length, time, mass in described(11, 40):
        a, b = (
            run(d, method, keep=[d.t_span[1]]),
            run(in_units(d, length, time, mass), method, keep=[d.t_span[1] * time]),
        )
        assert a.status == b.status
        if a.done:
            np.testing.assert_array_equal(a.motion.q * length, b.motion.q, err_msg=repr(d))
            np.testing.assert_array_equal(
                a.motion.impacts.time * time, b.motion.impacts.time, err_msg=repr(d)
            )


@pytest.mark.parametrize("unit", [2.0**-40, 2.0**-20, 2.0**20])
def test_what_starts_at_zero_has_the_scale_of_its_forces(unit):
    """A ball on a table under a force that begins at zero."""
    d = Description(
        M=((1.0,),), q0=(0.0,), v0=(0.0,), t_span=(0.0, 12.0), h=0.01, G=((1.0,),), offset=(0.0,), restitution=0.5,
        sine=(3.0,), force_omega=4.0, constant=(-1.0,),
    )  # fmt: skip
    one, other = run(d, "located"), run(in_units(d, unit, 1.0, 1.0), "located")
    assert len(one.motion.impacts) > 5
    np.testing.assert_array_equal(one.motion.q * unit, other.motion.q)
