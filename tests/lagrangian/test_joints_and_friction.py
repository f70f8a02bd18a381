import numpy as np
import pytest

from lagrangian import Coulomb, Joints, LinearContacts, LinearJoints, LinearSystem, Scene
from lcpstep.dynamics import gap_rates, gaps
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


def test_joints_are_evaluated_as_contacts_are():
    s = scene(joints=Joints(1, rod, rod_jacobian))
    m, _ = joint_model(s)
    g, G, g_t = np.ones(1), np.ones((1, 2)), np.ones(1)
    assert s.n_j == 1
    plain = m._replace(gap=rod, jacobian=rod_jacobian)
    gaps(plain, 0.0, np.array([0.6, 0.9]), np.zeros(2), g)
    gap_rates(plain, 0.0, np.array([0.6, 0.9]), np.zeros(2), G, g_t)
    assert g[0] == pytest.approx(0.5 * (0.36 + 0.81 - 1.0))
    assert G.tolist() == [[0.6, 0.9]]
    assert g_t[0] == 0.0


def test_tangents_are_evaluated_as_rates_are():
    contacts = LinearContacts([[0.0, 1.0]], friction=Coulomb(0.3, [[1.0, 0.0]], slip=-2.0))
    m, _ = tangent_model(scene(contacts=contacts))
    G, g_t = np.ones((1, 2)), np.ones(1)
    gap_rates(m, 0.0, np.zeros(2), np.zeros(2), G, g_t)
    assert G.tolist() == [[1.0, 0.0]]
    assert g_t[0] == -2.0
    m, _ = tangent_model(
        scene(contacts=LinearContacts([[0.0, 1.0]], friction=Coulomb(0.3, slope, slip=belt)))
    )
    plain = m._replace(jacobian=slope, gap_t=belt)
    gap_rates(plain, 0.5, np.zeros(2), np.zeros(2), G, g_t)
    assert G.tolist() == [[1.0, 0.0]]
    assert g_t[0] == -1.0


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
