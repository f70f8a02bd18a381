"""Runs in files: equal to the last bit when they are loaded, in any process; damage is told; no code is run."""

import hashlib
import json
import pickle
from dataclasses import replace
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader

import numpy as np
import pytest

from lagrangian import Contacts, LinearContacts, LinearSystem, Scene, System, scenes
from lagrangian.drawing import Point
from lcpstep import EventDriven, LcpStepError, Located, Moreau, continued, load, simulate
from lcpstep.callbacks import functions
from lcpstep.errors import DamagedFile, NotWritten
from tests.processes import python

METHODS = [
    Moreau(0.01), Moreau(0.01, tolerance=1e-3), Located(0.01), Located(0.01, order=4), Located(0.01, order="exact"),
    EventDriven(1e-8, 1e-9),
]  # fmt: skip
ARRAYS = ("t", "q", "v", "x", "impulse", "joint_impulse", "friction_impulse", "impacts", "mode", "switches")


def bits(x):
    """An array as bytes, those between the fields of a log left out."""
    x = np.asarray(x)
    if x.dtype.names:
        return [bits(x[name]) for name in x.dtype.names]
    return x.dtype.str, x.shape, x.tobytes()


def same(a, b):
    """Whether two runs are equal to the last bit, states between the kept ones included."""
    names = [name for name in ARRAYS if hasattr(a, name)]
    times = np.linspace(a.t[0], a.t[-1], 11)
    arrays = [(getattr(a, name), getattr(b, name)) for name in names] + [(a.at(times), b.at(times))]
    told = ("method", "status", "message", "counts")
    return all(bits(x) == bits(y) for x, y in arrays) and all(getattr(a, x) == getattr(b, x) for x in told)


def sample():
    """Runs of every kind of motion, and of every form of scene."""
    short = {"t_end": 0.3}
    yield from ((scenes.bouncing_ball(h0=0.1, **short), method) for method in METHODS)
    for scene in (scenes.pendulum_stop(**short), scenes.newtons_cradle(**short), scenes.double_pendulum(**short),
                  scenes.cam_follower(**short), scenes.stick_slip_oscillator(t_end=9.0)):  # fmt: skip
        yield scene, EventDriven(1e-8, 1e-8)
    yield scenes.kane_pendulum(), Moreau(1e-3)
    yield scenes.pendulum_stop(**short), Located(1e-3)


def test_a_loaded_run_is_equal_to_the_last_bit_and_runs_again(tmp_path):
    for k, (scene, method) in enumerate(sample()):
        run = simulate(scene, method)
        back = load(run.save(tmp_path / f"{k}.nc"))
        assert same(run, back)
        assert dict(back.scene.parameters) == dict(scene.parameters)
        assert (back.scene.exact is None) == (scene.exact is None)
        assert same(simulate(back.scene, back.method), run)
        assert same(pickle.loads(pickle.dumps(back)), run)


def test_a_loaded_scene_takes_new_parameters_as_it_did_before(tmp_path):
    named = scenes.impact_oscillator(t_end=0.3)
    for k, scene in enumerate((named, replace(named, p=np.array(named.p)))):
        back = load(simulate(scene, EventDriven(1e-6, 1e-6)).save(tmp_path / f"{k}.nc")).scene
        for old in (scene, back):
            new = {**old.parameters, "omega": 3.0}
            assert replace(old, parameters=new, p=None).p[1] == 3.0
            if k == 0:  # p are the parameters', and others say nothing of where p comes from
                with pytest.raises(ValueError, match="expected p=None"):
                    replace(old, parameters=new)
            else:
                assert replace(old, parameters=new).p[1] == 2.0


def test_the_motion_in_closed_form_comes_back_with_a_ready_scene(tmp_path):
    for scene in (
        scenes.elastic_ball(bounces=3),
        scenes.chattering_table(),
        scenes.dry_friction_oscillator(),
    ):
        method = EventDriven(1e-8, 1e-8)
        back = load(simulate(scene, method).save(tmp_path / f"{scene.name}.nc"))
        times = np.linspace(*scene.t_span, 9)
        assert bits(back.scene.exact(times)) == bits(scene.exact(times))
    shorter = replace(scenes.elastic_ball(bounces=3), t_span=(0.0, 0.7))
    back = load(simulate(shorter, method).save(tmp_path / "shorter.nc"))
    assert bits(back.scene.exact(times[:3] * 0.0)) == bits(shorter.exact(times[:3] * 0.0))


@pytest.mark.slow
def test_it_is_the_same_in_another_process(tmp_path):
    run = simulate(scenes.cam_follower(rpm=660.0, t_end=0.5), EventDriven(1e-9, 1e-9))
    run.save(tmp_path / "run.nc")
    program = (
        "import sys, hashlib, lcpstep; assert 'xarray' not in sys.modules; r = lcpstep.load('run.nc');"
        "print(hashlib.sha256(r.q.tobytes() + r.v.tobytes() + r.impulse.tobytes() + r.at(0.1234)[0].tobytes())"
        ".hexdigest())"
    )
    mine = run.q.tobytes() + run.v.tobytes() + run.impulse.tobytes() + run.at(0.1234)[0].tobytes()
    assert python(program, cwd=tmp_path) == hashlib.sha256(mine).hexdigest()


STIFFNESS = 30.0


def spring(t, q, v, p, out):
    out[0] = -helped(q[0]) - p[0] * v[0]


def helped(x):
    return STIFFNESS * x


def other_spring(t, q, v, p, out):
    out[0] = -helped(q[0]) - 2.0 * p[0] * v[0]


def wall_gap(t, q, v, p, out):
    out[0] = q[0] + 0.1


def wall_jacobian(t, q, v, p, out):
    out[0, 0] = 1.0


def own(force=spring, **more):
    scene = {"q0": 0.5, "v0": 0.0, "t_span": (0.0, 1.0), "parameters": {"c": 0.1}, "name": "own"}
    contacts = Contacts(1, wall_gap, wall_jacobian, restitution=0.5)
    return Scene(System(1, 1.0, force), contacts=contacts, **(scene | more))


def test_own_functions_stay_at_home_and_the_scene_may_be_given(tmp_path):
    scene = own()
    run = simulate(scene, Located(0.01, order=4))
    file = run.save(tmp_path / "own.nc")
    back = load(file)
    assert bits(back.q) == bits(run.q)
    assert "STIFFNESS * x" in back.scene.system.force.source
    with pytest.raises(LcpStepError, match=r"spring: files carry no code that is run; give the scene"):
        back.scene.system.force(0.0, back.q[0], back.v[0], back.scene.p, np.zeros(1))
    with pytest.raises(LcpStepError, match="spring: files carry no code"):
        back.at(0.123)
    assert same(load(file, scene=own()), run)
    assert load(file, scene=scene).scene is scene
    again = load(back.save(tmp_path / "again.nc"), scene=scene)
    assert same(again, run)


def drawn(t, q):
    return [Point((q[0], 0.0))]


@pytest.mark.parametrize("ask", [
    lambda run: continued(run, t_end=2.0), lambda run: replace(run.scene, q0=0.4),
    lambda run: run.animate().save("film.gif"),
])  # fmt: skip
def test_what_needs_functions_that_stayed_at_home_says_so_first(tmp_path, ask):
    file = simulate(own(drawing=drawn), Moreau(0.1)).save(tmp_path / "own.nc")
    with pytest.raises(LcpStepError, match=r"^tests\.test_saving:\w+: files carry no code that is run; give"):
        ask(load(file))


@pytest.mark.parametrize(("change", "named"), [
    ({"force": other_spring}, "system.force"), ({"q0": 0.6}, "q0"), ({"name": "mine"}, "name"),
    ({"parameters": {"c": 0.2}}, "p"), ({"t_span": (0.0, 2.0)}, "t_span"),
])  # fmt: skip
def test_another_scene_is_refused_and_the_difference_named(tmp_path, change, named):
    file = simulate(own(), Moreau(0.01)).save(tmp_path / "own.nc")
    with pytest.raises(ValueError, match=rf"scene: it is not the one of the file, {named}"):
        load(file, scene=own(**change))


def test_comments_do_not_make_another_function_and_what_is_called_does(tmp_path):
    def compiled(source):
        space = {}
        exec(source, space)
        return space["f"]

    text = "def g(x): return {} * x\ndef f(x): return g(x)"
    assert functions.checksum(compiled(text.format(2))) != functions.checksum(compiled(text.format(3)))
    sums = []
    for k, more in enumerate(("", "  # of the spring", " + 0.0")):
        file = tmp_path / f"commented{k}.py"
        file.write_text(f"def f(x):\n    return 2.0 * x{more}\n")
        loader = SourceFileLoader("commented", str(file))
        module = module_from_spec(spec_from_loader("commented", loader))
        loader.exec_module(module)
        sums.append(functions.checksum(module.f))
    assert sums[0] == sums[1] != sums[2]


def test_error_bar_and_audit_come_back(tmp_path):
    for k, method in enumerate(
        (Located(0.01, audit=True), EventDriven(1e-8, 1e-8, audit=True), Moreau(0.01))
    ):
        run = simulate(scenes.bouncing_ball(t_end=1.0), method, error=True)
        back = load(run.save(tmp_path / f"{k}.nc"))
        assert same(run, back)
        assert back.audit == run.audit
        assert back.error.as_dict() == run.error.as_dict()
        for name in ("t", "impact_time", "impact_impulse", "left_out"):
            assert bits(getattr(back.error, name)) == bits(getattr(run.error, name))
        assert bits(back.error.position.largest) == bits(run.error.position.largest)


def test_nothing_of_a_file_is_run(tmp_path):
    """A name that leads out of the ready scenes is not looked up."""
    for name in (
        "os:system",
        "lagrangian.derived:load",
        "lagrangian.scenes.table:sine_table.__call__",
        "builtins:exec",
    ):
        assert isinstance(functions.found(name, "", ""), functions.Absent)
    changed = functions.found("lagrangian.scenes.table:sine_table", "", "0")
    assert "another one in this version" in changed.reason


@pytest.mark.slow
def test_every_damage_is_told(tmp_path):
    run = simulate(scenes.bouncing_ball(t_end=1.0), Located(0.01))
    file = run.save(tmp_path / "run.nc")
    content = file.read_bytes()
    random = np.random.default_rng(3)
    for place in random.integers(0, len(content), 60):
        damaged = bytearray(content)
        damaged[place] ^= 1 << int(random.integers(8))
        file.write_bytes(damaged)
        try:
            unread = same(load(file), run)  # a byte that nobody reads
        except DamagedFile as error:
            unread = "run.nc" in str(error)
        assert unread
    for rest in (b"", content[:4], content[: len(content) // 2], b"PK\x03\x04 something else"):
        file.write_bytes(rest)
        with pytest.raises(DamagedFile, match=r"run\.nc"):
            load(file)


def test_what_is_no_run_is_said_to_be_none(tmp_path):
    import xarray

    file = tmp_path / "other.nc"
    xarray.Dataset({"temperature": ("x", [1.0, 2.0])}).to_netcdf(file)
    with pytest.raises(DamagedFile, match=r"expected a run written by Trajectory.save; .* holds temperature"):
        load(file)
    with pytest.raises(FileNotFoundError, match="nowhere"):
        load(tmp_path / "nowhere.nc")
    with pytest.raises(IsADirectoryError, match=r"expected a file .*, and this is a folder"):
        load(tmp_path)


def test_names_folders_and_files_that_are_there(tmp_path, monkeypatch):
    run = simulate(scenes.bouncing_ball(t_end=0.1), Moreau(0.01))
    with pytest.raises(ValueError, match=r"path: expected a name that ends in \.nc"):
        run.save(tmp_path / "run.npz")
    run.save(tmp_path / "run.nc")
    with pytest.raises(FileExistsError, match=r"run\.nc exists already"):
        run.save(tmp_path / "run.nc")
    run.save(tmp_path / "run.nc", overwrite=True)
    monkeypatch.chdir(tmp_path)
    for name in ("~/run.nc", "new/../run of mine.nc", "-ü #1.nc"):  # all as they stand
        assert np.array_equal(load(run.save(name)).q, run.q)
    (tmp_path / "file").write_text("")
    with pytest.raises(NotWritten, match=r"run\.nc could not be written"):
        run.save(tmp_path / "file" / "run.nc")


@pytest.mark.usefixtures("sparse_steps")
def test_large_and_sparse_scenes(tmp_path):
    from scipy.sparse import eye_array

    scene = Scene(LinearSystem(eye_array(50), force=-1.0 * np.ones(50)), q0=np.ones(50), v0=np.zeros(50),
                  t_span=(0.0, 2.0), contacts=LinearContacts(eye_array(50)))  # fmt: skip
    run = simulate(scene, Moreau(0.1))
    back = load(run.save(tmp_path / "sparse.nc"))
    assert same(run, back)
    assert same(simulate(back.scene, back.method), run)


def test_tables_and_datasets(tmp_path):
    run = simulate(scenes.newtons_cradle(t_end=0.3), EventDriven(1e-8, 1e-8))
    data, states, events = run.to_xarray(), run.to_dataframe(), run.to_dataframe("events")
    assert np.array_equal(data.q.values, run.q)
    assert data.q.attrs["units"] == "m"
    assert json.loads(data.attrs["counts"])["steps"] == run.counts.steps
    assert np.array_equal(states[["v0", "v1", "v2"]].to_numpy(), run.v)
    assert np.array_equal(states.index, run.t)
    assert np.array_equal(events["impulse"], run.impacts.impulse)
    with pytest.raises(ValueError, match='expected "states" or "events"'):
        run.to_dataframe("impacts")
    assert simulate(scenes.pendulum_stop(t_end=0.1), Moreau(0.01)).to_xarray().v.attrs["units"] == "rad/s"
    modes = simulate(scenes.stick_slip_oscillator(t_end=9.0), EventDriven(1e-8, 1e-8))
    assert list(modes.to_dataframe()["mode"]) == modes.mode.tolist()
    assert len(modes.to_xarray().switch_time) == len(modes.switches)


def test_a_notebook_shows_a_summary_and_the_motion():
    from xml.etree import ElementTree

    for run in (simulate(scenes.bouncing_ball(), Located(0.01)),
                simulate(scenes.stick_slip_oscillator(t_end=9.0), EventDriven(1e-8, 1e-8)),
                simulate(scenes.column(), Moreau(0.01))):  # fmt: skip
        page = run._repr_html_()
        ElementTree.fromstring(page)
        assert run.scene.name in page
        assert "DONE" in page
        assert page.count("<svg") == min(3, (run.q if hasattr(run, "q") else run.x).shape[1])
    assert "&lt;b&gt;" in simulate(own(name="<b>"), Moreau(0.1))._repr_html_()
