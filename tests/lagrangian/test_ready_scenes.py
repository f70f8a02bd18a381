"""The scenes ready to use: their names, defaults and arguments."""

import inspect
import math

import numpy as np
import pytest

from lagrangian import Harmonic, scenes


@pytest.mark.parametrize("name", scenes.CATALOGUE | scenes.LARGE)
def test_every_scene_of_the_catalogue_starts_from_its_defaults(name):
    made = scenes.SCENES[name].make()
    assert made.name == name
    assert np.all(made.gap(made.t_span[0], made.q0, made.v0)[0] >= 0.0)


@pytest.mark.parametrize("name", scenes.WITH_MODES)
def test_every_scene_with_modes_starts_from_its_defaults(name):
    made = scenes.WITH_MODES[name].make()
    assert made.name == name
    assert len(made.labels) == made.n_x == len(made.x0)


@pytest.mark.parametrize("name", scenes.SCENES)
def test_every_numeric_argument_of_every_scene_is_checked_by_name(name):
    make = scenes.SCENES[name].make
    for argument, parameter in inspect.signature(make).parameters.items():
        if isinstance(parameter.default, float):
            for bad in (math.nan, math.inf, "much"):
                with pytest.raises(ValueError, match=rf"^{argument}: "):
                    make(**{argument: bad})


@pytest.mark.parametrize(
    ("make", "arguments"),
    [
        (scenes.bouncing_ball, {"h0": 1.0, "v0": 0.0, "g": 9.81, "restitution": 0.8, "t_end": 5.0}),
        (
            scenes.cam_follower,
            {"rpm": 358.0, "q0": 0.4, "v0": 0.4, "t_end": 2.0, "coordinates": "relative"},
        ),
        (
            scenes.impact_oscillator,
            {
                "zeta": 0.05, "omega": 2.0, "amplitude": 1.0, "stop": 0.0, "restitution": 0.8,
                "q0": -0.5, "v0": 0.0, "t_end": 100.0,
            },
        ),
    ],
)  # fmt: skip
def test_scenes_have_the_documented_arguments_in_order(make, arguments):
    parameters = list(inspect.signature(make).parameters.values())[: len(arguments)]
    assert {x.name: x.default for x in parameters} == arguments
    assert [x.name for x in parameters] == list(arguments)


MAKERS = [entry.make for entry in scenes.SCENES.values()]


def taking(argument):
    return [make for make in MAKERS if argument in inspect.signature(make).parameters]


@pytest.mark.parametrize("make", taking("restitution"))
@pytest.mark.parametrize("r", [-0.1, 1.1])
def test_scenes_refuse_a_restitution_outside_zero_and_one(make, r):
    with pytest.raises(ValueError, match=r"^restitution: "):
        make(restitution=r)


@pytest.mark.parametrize("make", MAKERS)
@pytest.mark.parametrize("t_end", [0.0, -1.0])
def test_scenes_refuse_an_end_before_their_start(make, t_end):
    with pytest.raises(ValueError, match=r"^t_end: "):
        make(t_end=t_end)


def test_the_oscillator_refuses_a_start_beyond_its_stop():
    with pytest.raises(ValueError, match=r"^q0: .*inside"):
        scenes.impact_oscillator(q0=0.1)


def test_the_follower_refuses_coordinates_that_it_does_not_have():
    with pytest.raises(ValueError, match=r'^coordinates: .*"relative" or "absolute", got \'polar\''):
        scenes.cam_follower(coordinates="polar")


@pytest.mark.parametrize("bad", [0.0, -1.0])
@pytest.mark.parametrize("argument", ["rpm", "m"])
def test_the_follower_refuses_a_cam_or_a_mass_that_is_not_positive(argument, bad):
    with pytest.raises(ValueError, match=rf"^{argument}: "):
        scenes.cam_follower(**{argument: bad})


def test_the_follower_starts_at_the_first_corner_relative_to_the_cam():
    relative, absolute = (scenes.cam_follower(coordinates=c) for c in ("relative", "absolute"))
    assert relative.corners[0] == 0.0
    for made in (relative, absolute):
        g, u = made.gap(0.0, made.q0, made.v0)
        # the lift there is 0.1 m up to rounding, at rest
        np.testing.assert_allclose([g[0], u[0]], [0.4, 0.4], rtol=1e-15)
    assert absolute.q0[0] == pytest.approx(0.5, rel=1e-15)
    assert relative.period == pytest.approx(60.0 / 358.0, rel=1e-15)


def test_a_harmonic_force_is_what_its_name_says():
    made = scenes.impact_oscillator(omega=3.0, amplitude=2.0)
    assert isinstance(made.system.force, Harmonic)
    assert made.period == pytest.approx(2 * math.pi / 3.0, rel=1e-15)
