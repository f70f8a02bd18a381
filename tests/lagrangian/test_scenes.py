"""Scenes: numbers, contacts, times and corners that are refused, and the start outside of obstacles."""

import copy
import dataclasses
import math
import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lagrangian import Contacts, Coulomb, Harmonic, LinearContacts, LinearJoints, LinearSystem, scenes
from tests.lagrangian.ball import height, scene, upward

NOT_FINITE = st.sampled_from([math.nan, math.inf, -math.inf])


# --- numbers


@given(st.sampled_from(["q0", "v0"]), NOT_FINITE)
def test_the_initial_state_must_be_finite(name, bad):
    with pytest.raises(ValueError, match=rf"^{name}: .*finite"):
        scene(**{name: bad})


@pytest.mark.parametrize("name", ["q0", "v0"])
@pytest.mark.parametrize("bad", [[1.0, 2.0], [], [[1.0, 2.0]], "up", 1j, [[1.0], [2.0, 3.0]]])
def test_the_initial_state_must_have_one_entry_per_coordinate(name, bad):
    with pytest.raises(ValueError, match=rf"^{name}: "):
        scene(**{name: bad})


@given(st.floats(-1e6, 1e6), st.floats(0.0, 1e6))
def test_the_span_must_not_be_empty_or_reversed(t_start, length):
    with pytest.raises(ValueError, match=r"^t_span: .*t_start < t_end"):
        scene(t_span=(t_start, t_start - length))


@pytest.mark.parametrize(
    "bad", [(0.0, math.nan), (math.inf, 1.0), (0.0, math.inf), 5.0, (0.0, 1.0, 2.0), (1.0,), "ab"]
)
def test_the_span_must_be_two_times(bad):
    with pytest.raises(ValueError, match=r"^t_span: "):
        scene(t_span=bad)


@pytest.mark.parametrize("period", [0.0, -1.0, math.nan, "daily"])
def test_the_period_must_be_positive(period):
    with pytest.raises(ValueError, match=r"^period: "):
        scene(period=period)


@pytest.mark.parametrize("corners", [[-0.1], [0.5, 1.0], [2.0], [math.nan], [[0.1, 0.2]], ["noon"]])
def test_corners_must_lie_within_the_period(corners):
    with pytest.raises(ValueError, match=r"^corners: "):
        scene(corners=corners, period=1.0)


def test_corners_are_sorted():
    np.testing.assert_array_equal(scene(corners=[0.7, 0.2], period=1.0).corners, [0.2, 0.7])


@pytest.mark.parametrize("p", [[math.nan], [[1.0, 2.0], [3.0]], ["stiff"]])
def test_parameters_must_be_finite_numbers(p):
    with pytest.raises(ValueError, match=r"^p: "):
        scene(p=p)


def test_parameters_are_the_values_of_the_named_ones_unless_given():
    np.testing.assert_array_equal(scene(parameters={"a": 2.0, "b": "x", "c": 3}).p, [2.0, 3.0])
    np.testing.assert_array_equal(scene(parameters={"a": 2.0}, p=[5.0]).p, [5.0])


def test_new_parameters_beside_old_values_are_refused():
    old = pickle.loads(pickle.dumps(scene(parameters={"a": 2.0, "b": "x"})))
    with pytest.raises(ValueError, match=r"^parameters: expected p=None beside new ones"):
        dataclasses.replace(old, parameters={"a": 3.0, "b": "x"})
    assert dataclasses.replace(old, parameters={"a": 3.0, "b": "x"}, p=None).p.tolist() == [3.0]
    assert dataclasses.replace(old, parameters={"a": 2.0, "b": "y"}, p=[4.0]).p.tolist() == [4.0]
    assert dataclasses.replace(dataclasses.replace(old, name="other"), t_span=(0.0, 2.0)).p.tolist() == [2.0]


# --- contacts


@given(st.one_of(st.floats(max_value=0.0, exclude_max=True), st.floats(min_value=1.0, exclude_min=True)))
def test_restitution_lies_between_zero_and_one(r):
    with pytest.raises(ValueError, match=r"^restitution: "):
        LinearContacts(G=1.0, restitution=r)
    with pytest.raises(ValueError, match=r"^restitution: "):
        Contacts(n_c=1, gap=height, jacobian=upward, restitution=r)


@pytest.mark.parametrize("bad", [math.nan, [0.5, 0.5, 0.5], "hard", [[0.5, 0.5]], [0.5, 1.1]])
def test_restitution_has_one_number_for_each_contact(bad):
    with pytest.raises(ValueError, match=r"^restitution: "):
        LinearContacts(G=np.eye(2), restitution=bad)


@pytest.mark.parametrize("G", [[[math.nan]], "up", np.zeros((1, 1, 2)), [[1.0], [1.0, 2.0]], [[1j]]])
def test_the_gap_jacobian_is_a_real_matrix(G):
    with pytest.raises(ValueError, match=r"^G: "):
        LinearContacts(G=G)


def test_the_gap_jacobian_has_a_column_for_each_coordinate():
    with pytest.raises(ValueError, match=r"contacts\.G: expected 1 columns"):
        scene(contacts=LinearContacts(G=[[1.0, 0.0]]))


@pytest.mark.parametrize("offset", [math.nan, [1.0, 2.0], "far"])
def test_the_offset_has_one_number_for_each_contact(offset):
    with pytest.raises(ValueError, match=r"^offset: "):
        LinearContacts(G=1.0, offset=offset)


@pytest.mark.parametrize("n_c", [0, -1, 1.5, None])
def test_the_number_of_contacts_is_a_positive_integer(n_c):
    with pytest.raises(ValueError, match=r"^n_c: "):
        Contacts(n_c=n_c, gap=height, jacobian=upward)


# --- the start


@given(st.floats(1e-12, 1e6))
def test_a_start_inside_the_obstacle_is_refused_with_its_depth(depth):
    with pytest.raises(ValueError, match=r"^q0: .*inside the obstacle.*contact 0 is -.*t = 0, q = "):
        scene(q0=-depth)


def test_the_obstacle_that_is_entered_is_named():
    system = LinearSystem(M=np.eye(2))
    with pytest.raises(ValueError, match=r"^q0: .*contact 1 is -0\.25 m"):
        scene(system=system, q0=[0.0, -0.25], v0=[0.0, 0.0], contacts=LinearContacts(G=np.eye(2)))


def test_a_start_inside_a_moving_obstacle_is_refused():
    with pytest.raises(ValueError, match=r"^q0: .*inside the obstacle"):
        scene(contacts=LinearContacts(G=1.0, motion=risen))
    with pytest.raises(ValueError, match=r"^q0: .*inside the obstacle"):
        scenes.cam_follower(q0=-1e-6)
    with pytest.raises(ValueError, match=r"^q0: .*inside the obstacle"):
        scenes.cam_follower(q0=-1e-6, coordinates="absolute")


@pytest.mark.parametrize("where", [1e-3, 1.0, 1e6])
def test_a_start_on_the_obstacle_is_taken_up_to_rounding(where):
    contacts = LinearContacts(G=1.0, offset=-where)
    assert scene(q0=where, contacts=contacts).gap(0.0, where, 0.0)[0][0] == 0.0
    scene(q0=np.nextafter(where, 0.0), contacts=contacts)
    with pytest.raises(ValueError, match=r"^q0: "):
        scene(q0=where * (1 - 1e-9) - 1e-9, contacts=contacts)


def test_a_start_that_falls_towards_the_obstacle_on_it_is_taken():
    g, u = scene(q0=0.0, v0=-1.0).gap(0.0, 0.0, -1.0)
    assert (g[0], u[0]) == (0.0, -1.0)


def risen(t, q, v, p, out):
    out[0, 0], out[0, 1], out[0, 2] = 1.5, 0.0, 0.0


def test_a_motion_in_closed_form_is_kept_as_long_as_it_starts_from_the_initial_state():
    def rising(t):
        return (1.0 + t)[:, None], np.ones((len(t), 1))

    made = scene(q0=1.0, v0=1.0, exact=rising)
    assert made.exact(np.array([2.0]))[0].tolist() == [[3.0]]
    assert dataclasses.replace(made, t_span=(0.0, 7.0)).exact is rising
    assert dataclasses.replace(made, q0=1.1).exact is None
    assert dataclasses.replace(made, v0=1.1).exact is None
    with pytest.raises(ValueError, match=r"^exact: q: expected shape \(1, 1\)"):
        scene(q0=1.0, v0=1.0, exact=lambda t: (np.zeros((len(t), 2)), np.ones((len(t), 1))))


# --- what is no number, no system, no period


@pytest.mark.parametrize(
    "value", ["1", True, np.ma.masked_array([1.0], mask=[True]), 1j, None, [["1"]], b"1"]
)
@pytest.mark.parametrize(
    "make",
    [
        lambda x: LinearSystem(M=x), lambda x: LinearSystem(M=1.0, force=Harmonic(cosine=x, omega=1.0)),
        lambda x: LinearSystem(M=1.0, force=Harmonic(cosine=1.0, omega=x)), lambda x: LinearContacts(x),
        lambda x: LinearContacts(1.0, offset=x), lambda x: LinearContacts(1.0, restitution=x),
        lambda x: LinearContacts(1.0, friction=Coulomb(x, 1.0)), lambda x: LinearJoints(x),
        lambda x: scene(q0=x), lambda x: scene(v0=x), lambda x: scene(t_span=(x, x)),
        lambda x: scene(corners=[x]), lambda x: scene(period=x), lambda x: scene(p=[x]),
    ],
)  # fmt: skip
def test_what_only_looks_like_a_number_is_refused_by_name(make, value):
    with pytest.raises(
        ValueError,
        match=r"^(M|G|offset|restitution|force\.\w+|friction\.mu|q0|v0|t_span|corners|period|p): expected",
    ):
        make(value)


@pytest.mark.parametrize(
    "make", [lambda K: K, lambda K: pytest.importorskip("scipy.sparse").csr_array(K)], ids=["dense", "sparse"]
)
def test_an_unsymmetric_stiffness_is_refused_and_gyroscopic_terms_are_not(make):
    circulatory = np.array([[3.0, 1.0], [-1.0, 3.0]])
    LinearSystem(M=np.eye(2), C=make(circulatory))
    with pytest.raises(ValueError, match=r"^K: expected a symmetric matrix, .*lagrangian\.System"):
        LinearSystem(M=make(np.eye(2)), K=make(circulatory))
    LinearSystem(M=np.eye(2), K=make(circulatory + circulatory.T) * (1.0 + 1e-16))


@pytest.mark.parametrize("make", [LinearContacts, LinearJoints])
@pytest.mark.parametrize("sparse", [False, True])
def test_a_gap_that_depends_on_nothing_is_refused(make, sparse):
    G = np.array([[1.0, 0.0], [0.0, 0.0]])
    with pytest.raises(
        ValueError, match=r"^G: row 1 is zero: .* G has shape \(2, 2\), a row for each contact"
    ):
        make(pytest.importorskip("scipy.sparse").csr_array(G) if sparse else G)


@pytest.mark.parametrize(
    ("period", "right"), [(math.pi, True), (2 * math.pi, True), (3.141592654, True), (math.inf, True),
                          (1.0, False), (0.5 * math.pi, False), (3.1416, False), (1e-9, False)],
)  # fmt: skip
def test_a_period_is_a_whole_number_of_turns_of_the_force(period, right):
    system = LinearSystem(M=1.0, force=Harmonic(constant=-1.0, cosine=2.0, omega=-2.0))
    if right:
        assert scene(system=system, period=period).period == period
    else:
        with pytest.raises(
            ValueError, match=r"^period: .* no whole number of turns of the force.*3\.14159265 s"
        ):
            scene(system=system, period=period)
    resting = LinearSystem(M=1.0, force=Harmonic(constant=-1.0, omega=2.0))
    assert scene(system=resting, period=period).period == period


def test_parameters_stay_as_they_are():
    made = scenes.bouncing_ball()
    for change in (
        lambda p: p.update(g=1.0), lambda p: p.__setitem__("g", 1.0), lambda p: p.pop("g"), lambda p: p.clear(),
        lambda p: p.setdefault("x", 1.0), lambda p: p.__delitem__("g"), lambda p: p.popitem(),
    ):  # fmt: skip
        with pytest.raises(TypeError, match="make another scene"):
            change(made.parameters)
    p = made.parameters
    for same in (copy.copy(p), copy.deepcopy(p), pickle.loads(pickle.dumps(p))):
        assert same == made.parameters
        with pytest.raises(TypeError):
            same["g"] = 1.0
    assert {**made.parameters, "g": 1.0}["g"] == 1.0
    given = {"g": 9.81}
    own = scene(parameters=given)
    given["g"] = 1.0
    assert own.parameters["g"] == 9.81


@pytest.mark.parametrize("part", ["system", "contacts", "joints"])
def test_a_part_of_another_class_is_refused_by_name(part):
    with pytest.raises(TypeError, match=rf"^{part}: expected a Linear"):
        scene(**{part: 3.0})
    with pytest.raises(TypeError, match=r"^friction: expected a Coulomb"):
        LinearContacts(1.0, friction=0.3)


def test_a_scene_says_on_one_line_what_it_is():
    assert repr(scenes.bouncing_ball()) == (
        "Scene('bouncing-ball', 1 coordinate, 1 contact, t = 0 .. 5 s, h0=1, v0=0, g=9.81, restitution=0.8)"
    )
    assert "3 coordinates" in repr(scenes.newtons_cradle())
    assert "starts in stick" in repr(scenes.stick_slip_oscillator().started([0.0, 0.1], "stick"))
