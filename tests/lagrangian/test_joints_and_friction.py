import numpy as np
import pytest

from lagrangian import Coulomb, Harmonic, Joints, LinearContacts, LinearJoints, LinearSystem, Scene
from lcpstep import EventDriven, Located, Moreau, simulate
from lcpstep.kernels import states
from lcpstep.model import joint_model, tangent_model


def rod(t, q, v, p, out):
    out[0] = 0.5 * (q[0] ** 2 + q[1] ** 2 - 1.0)


def rod_jacobian(t, q, v, p, out):
    out[0, 0], out[0, 1] = q[0], q[1]


def slope(t, q, v, p, out):
    out[0, 0], out[0, 1] = np.cos(q[0]), np.sin(q[0])


def belt(t, q, v, p, out):
    out[0] = -2.0 * t


def scene(**kw):
    return Scene(
        **({"system": LinearSystem(M=np.eye(2)), "q0": [1.0, 0.0], "v0": [0.0, 0.5], "t_span": (0, 1)} | kw)
    )


def at(t, q):
    return np.array([t]), np.array([q]), np.array([[0.2, -0.3]])


def test_joints_are_evaluated_as_contacts_are():
    s = scene(joints=Joints(1, rod, rod_jacobian))
    assert s.n_j == 1
    m = joint_model(s)
    low, high = states.extremes(m, *at(0.0, [0.6, 0.9]))
    assert low[0] == high[0] == pytest.approx(0.5 * (0.36 + 0.81 - 1.0))
    assert states.own_rates(m, *at(0.0, [0.6, 0.9]), True)[0, 0] == pytest.approx(0.6 * 0.2 - 0.9 * 0.3)
    assert states.own_rates(m, *at(0.0, [0.6, 0.9]), False)[0, 0] == 0.0


def test_tangents_are_evaluated_as_rates_are():
    contacts = LinearContacts([[0.0, 1.0]], friction=Coulomb(0.3, [[1.0, 0.0]], slip=-2.0))
    m = tangent_model(scene(contacts=contacts))
    assert states.own_rates(m, *at(0.0, [0.0, 0.0]), False)[0, 0] == -2.0
    assert states.own_rates(m, *at(0.0, [0.0, 0.0]), True)[0, 0] == 0.2 - 2.0
    m = tangent_model(scene(contacts=LinearContacts([[0.0, 1.0]], friction=Coulomb(0.3, slope, slip=belt))))
    assert states.own_rates(m, *at(0.5, [0.0, 0.0]), False)[0, 0] == -1.0
    assert states.own_rates(m, *at(0.5, [0.0, 0.0]), True)[0, 0] == 0.2 - 1.0


def turning(t, q, v, p, out):
    out[0, 0], out[0, 1] = 1.0, 0.0


def swaying_belt(t, q, v, p, out):
    out[0] = -0.1 + 0.4 * np.cos(1.7 * t) - 0.3 * np.sin(1.7 * t)


@pytest.mark.parametrize("method", [EventDriven(1e-11, 1e-11), Moreau(1e-3), Located(1e-3)])
def test_a_harmonic_belt_is_that_of_a_callback(method):
    runs = []
    for tangent, slip in ((turning, swaying_belt), ([[1.0, 0.0]], Harmonic(-0.1, 0.4, -0.3, 1.7))):
        friction = Coulomb(0.3, tangent, slip=slip, mu_s=0.4)
        runs.append(
            simulate(
                scene(
                    system=LinearSystem(np.eye(2), K=np.diag([2.0, 0.0]), force=[0.0, -1.0]),
                    contacts=LinearContacts([[0.0, 1.0]], friction=friction),
                    v0=[0.0, 0.0],
                    t_span=(0.0, 10.0),
                ),
                method,
                keep=np.linspace(0.0, 10.0, 50),
            )
        )
    assert np.max(np.abs(runs[0].q - runs[1].q)) < 1e-9
    assert np.max(np.abs(runs[0].friction_impulse - runs[1].friction_impulse)) < 1e-9
    assert list(runs[0].impacts.kind) == list(runs[1].impacts.kind)


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: scene(joints=LinearJoints([[1.0, 0.0]])), "q0: the initial state does not satisfy joint 0"),
        (lambda: scene(joints=LinearJoints([[0.0, 1.0]])), "v0: the initial state does not satisfy joint 0"),
        (lambda: scene(joints=LinearJoints([[1.0]])), "joints.G: expected 2 columns"),
        (lambda: LinearContacts(1.0, friction=Coulomb(-0.1, [[1.0]])), "friction.mu"),
        (
            lambda: LinearContacts(1.0, friction=Coulomb(0.1, [[1.0], [2.0]])),
            "friction.tangent: expected 1 rows",
        ),
        (lambda: LinearContacts(1.0, friction=Coulomb(0.1, [[1.0]], slip=belt)), "friction.slip"),
        (lambda: LinearContacts(1.0, friction=Coulomb(0.1, belt, slip=Harmonic(1.0))), "friction.slip"),
        (
            lambda: LinearContacts(1.0, friction=Coulomb(0.1, [[1.0]], slip=Harmonic([1.0, 2.0]))),
            "friction.slip.constant",
        ),
        (lambda: LinearContacts(1.0, friction=Coulomb(0.1, [[1.0]], restitution=2.0)), "restitution"),
        (
            lambda: scene(contacts=LinearContacts([[0.0, 1.0]], friction=Coulomb(0.1, [[1.0]]))),
            "friction.tangent: expected 2 columns",
        ),
    ],
)
def test_what_does_not_fit_is_named(make, said):
    with pytest.raises(ValueError, match=said.replace("(", r"\(")):
        make()
