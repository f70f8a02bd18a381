"""Films: what a scene looks like as data, pictures from it, and what is said where they cannot be made."""

import shutil
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from lagrangian import LinearContacts, LinearSystem, Scene, drawing, scenes
from lagrangian.drawing import Circle, Line, Point, Polygon
from lcpstep import EventDriven, LcpStepError, Located, Moreau, load, simulate
from lcpstep.cli import main
from lcpstep.plot.film import STRUCK, film
from tests.processes import python

SHORT = {"seconds": 0.2, "fps": 10}


def ball_above(t, q):
    return [Line([(-1, 0), (1, 0)], fixed=True), Circle((0.0, q[0] + 0.1), 0.1, contacts=(0,))]


@pytest.fixture(scope="module")
def run():
    return simulate(scenes.bouncing_ball(), EventDriven(1e-8, 1e-8))


@pytest.mark.parametrize("name", [x for x in scenes.SCENES if x != "hybrid-abs"])
def test_every_ready_scene_has_a_drawing_whose_contacts_are_its_own(name):
    scene = scenes.SCENES[name].make()
    q0 = np.array(scene.q0 if hasattr(scene, "q0") else scene.x0)
    shapes = drawing.drawn(scene.drawing, 0.0, q0)
    moved = drawing.drawn(scene.drawing, 0.0, q0 + 0.01 * np.arange(1.0, 1.0 + len(q0)))
    assert shapes != moved
    shown = {c for shape in shapes for c in shape.contacts}
    assert shown == set(range(getattr(scene, "n_c", 0)))


def nearest(shape, other):
    """How far apart the outlines of a disc or a polygon and a line or a disc are."""
    if isinstance(shape, Polygon):
        return min(abs(y) for _, y in drawing.places(shape))
    return np.hypot(*np.subtract(shape.centre, other.centre)) - shape.radius - other.radius


def test_drawn_gaps_are_the_scenes_gaps():
    """Discs of a falling column and of a cradle are as far apart as their beads."""
    for scene, method in ((scenes.column(n=4, t_end=0.2), Moreau(1e-3)),
                          (scenes.newtons_cradle(spacing=0.1), EventDriven(1e-8, 1e-8))):  # fmt: skip
        motion = simulate(scene, method)
        for t, q, v in zip(motion.t[::7], motion.q[::7], motion.v[::7], strict=True):
            discs = [x for x in drawing.drawn(scene.drawing, t, q) if isinstance(x, Circle)]
            gaps = scene.gap(t, q, v)[0][-len(discs) + 1 :]
            seen = [nearest(a, b) for a, b in pairwise(discs)]
            assert seen == pytest.approx(gaps, abs=1e-12)


def test_the_follower_touches_its_cam_where_the_gap_is_closed():
    """The outline, turned by the cam's angle, passes through the tip of a follower at the gap 0."""
    scene = scenes.cam_follower(rpm=100.0)
    for t in np.linspace(0.0, 0.6, 13):
        cam, *_, follower = drawing.drawn(scene.drawing, float(t), np.zeros(1))
        x, y = np.vstack([cam.corners, cam.corners[:1]]).T
        crossing = np.flatnonzero((x[:-1] * x[1:] <= 0.0) & (y[:-1] > 0.0) & (x[:-1] != x[1:]))[0]
        share = x[crossing] / (x[crossing] - x[crossing + 1])
        top = y[crossing] + share * (y[crossing + 1] - y[crossing])
        assert follower.corners[0][1] == pytest.approx(top, abs=2e-4)


@pytest.mark.slow
def test_an_impact_turns_its_shape_red_and_fades(run):
    made = film(run, seconds=5.0, fps=10)
    red = np.array([np.sum(np.all(np.abs(x - 255.0 * np.array(STRUCK)) < 40, axis=2)) for x in made.frames()])
    first = run.impacts.time[0]
    struck = int(np.argmin(np.abs(made.times - first)))
    assert red[struck] > 100
    assert red[struck - 2] == 0
    assert red[struck + 5] == 0


def test_files_of_every_kind(run, tmp_path):
    from PIL import Image

    gif = run.animate(tmp_path / "ball.gif", **SHORT)
    with Image.open(gif) as image:
        assert image.n_frames == 3
        assert image.info["duration"] == 100
    page = run.animate(tmp_path / "ball.html", **SHORT).read_text()
    assert page.count("iVBORw0KGgo") == 3  # how a PNG begins
    assert "iVBORw0KGgo" in run.animate(**SHORT)._repr_html_()


@pytest.mark.parametrize(("fps", "seconds"), [(10, 0.3), (24, 0.25), (30, 0.3), (60, 0.2), (120, 0.1)])
def test_a_gif_plays_as_fast_as_it_says(run, tmp_path, fps, seconds):
    """Its pictures last whole hundredths of a second, and players do not keep up with less than two."""
    from PIL import Image

    made, done = run.animate(seconds=seconds, fps=fps), []
    assert np.diff(made.times) * fps == pytest.approx(made.speed, rel=1e-12)
    with Image.open(made.save(tmp_path / "new" / "ball.gif", lambda k, n: done.append((k, n)))) as image:
        shown = [image.info["duration"] for k in range(image.n_frames) if image.seek(k) is None]
    assert sum(shown) == pytest.approx(1000.0 * (seconds + 1.0 / fps), abs=20.0)
    assert min(shown) >= 20
    assert done == [(k + 1, len(shown)) for k in range(len(shown))]  # none is drawn that is not shown


@pytest.mark.skipif(shutil.which("ffmpeg") is None, reason="no ffmpeg here")
def test_mp4(run, tmp_path):
    file = run.animate(tmp_path / "ball.mp4", **SHORT)
    assert file.read_bytes()[4:8] == b"ftyp"


def test_mp4_is_written_by_what_is_called_ffmpeg(run, tmp_path, monkeypatch):
    """The command gets all pictures, of even width and height, and a name to write to."""
    tool = tmp_path / "ffmpeg"
    tool.write_text('#!/bin/sh\nfor last; do :; done\ncat > "$last"\n')
    tool.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=":")
    height, width, _ = next(run.animate(**SHORT).frames()).shape
    file = run.animate(tmp_path / "ball.mp4", **SHORT)
    assert file.stat().st_size == 3 * (width // 2 * 2) * (height // 2 * 2) * 3
    tool.write_text("#!/bin/sh\ncat > /dev/null\necho Unknown codec >&2\nexit 1\n")
    with pytest.raises(LcpStepError, match="ffmpeg failed: Unknown codec; write"):
        run.animate(tmp_path / "other.mp4", **SHORT)
    assert not (tmp_path / "other.mp4").exists()


def test_what_cannot_be_drawn_or_written_is_said_in_a_line(run, tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", "")
    with pytest.raises(LcpStepError, match=r"ball.mp4 needs ffmpeg, .*; install it, or write .gif or .html"):
        run.animate(tmp_path / "ball.mp4")
    with pytest.raises(ValueError, match=r"path: expected a name that ends in .gif, .mp4, .html, got .*avi"):
        run.animate(tmp_path / "ball.avi")
    bare = Scene(
        LinearSystem(1.0), q0=0.0, v0=1.0, t_span=(0.0, 1.0), contacts=LinearContacts(1.0), name="bare"
    )
    with pytest.raises(LcpStepError, match="'bare' has no drawing; give animate"):
        simulate(bare, Moreau(0.1)).animate()
    for bad, said in ((lambda t, q: 1 / 0, r"failed at t = 0, q = \[1.0\]: ZeroDivisionError"),
                      (lambda t, q: 3, r"is to return shapes in a list, not 3, at t = 0"),
                      (lambda t, q: None, r"is to return shapes in a list, not None"),
                      (lambda t, q: (1 / 0 for _ in "x"), r"failed at t = 0, q = \[1.0\]: ZeroDivisionError"),
                      (lambda t, q: ["ball"], "expected Point, Line, Circle or Polygon, got 'ball'"),
                      (lambda t, q: [Circle((0, np.nan), 1.0)], r"expected places \(x, y\) of finite numbers"),
                      (lambda t, q: [Circle((0, 0), -1.0)], "expected places"),
                      (lambda t, q: [Point(3.0)], "expected places")):  # fmt: skip
        with pytest.raises(LcpStepError, match=f"drawing: .*{said}"):
            run.animate(tmp_path / "ball.gif", drawing=bad, **SHORT)
    assert list(tmp_path.iterdir()) == []
    for more, named in (({"seconds": 0.0}, "seconds"), ({"fps": 0}, "fps"), ({"drawing": 3}, "drawing")):
        with pytest.raises(ValueError, match=named):
            run.animate(**more)
    with pytest.raises(ValueError, match="drawing: expected a function"):
        replace(bare, drawing="ball")


def test_the_picture_has_the_proportions_of_what_moves(run):
    """Wide, square and tall mechanisms, a metre or a kilometre long: little space around them, and room for words."""
    for wide, high in ((10.0, 1.0), (1.0, 1.0), (1.0, 10.0), (3e3, 1e3)):
        made = run.animate(
            drawing=lambda t, q, a=wide, b=high: [Line([(0, 0), (a, 0), (a, b), (0, 0.1 * t * b)])], **SHORT
        )
        picture = next(made.frames())
        height, width, _ = picture.shape
        assert 380 <= width <= 560
        assert 220 <= height <= 480
        used = np.argwhere(np.any(picture[40:] < 200, axis=2))
        if 0.5 < wide / high < 3.5:
            assert np.all(np.ptp(used, axis=0) > [0.85 * (height - 40), 0.85 * width])


@pytest.mark.slow
def test_own_drawings_systems_with_modes_and_loaded_runs(run, tmp_path):
    own = replace(run.scene, drawing=ball_above)
    mine = simulate(own, Located(0.01)).animate(**SHORT)
    assert [x.shape for x in mine.frames()] == 3 * [(378, 560, 3)]
    modes = simulate(scenes.stick_slip_oscillator(t_end=9.0), EventDriven(1e-8, 1e-8))
    assert len(list(modes.animate(**SHORT).frames())) == 3
    back = load(run.save(tmp_path / "run.nc"))
    pictures = zip(back.animate(**SHORT).frames(), run.animate(**SHORT).frames(), strict=True)
    assert all(np.array_equal(a, b) for a, b in pictures)


def test_axes_have_the_unit_of_the_coordinates(run, monkeypatch):
    from matplotlib.axes import Axes

    said = []
    monkeypatch.setattr(
        Axes, "set_aspect", lambda ax, *_, **__: said.append((ax.get_xlabel(), ax.get_ylabel()))
    )
    for names in ((), ["height [mm]"]):
        own = simulate(replace(run.scene, coordinates=names), Located(0.01), keep=[0.0, 0.1])
        next(own.animate(seconds=0.1, fps=10).frames())
    assert said == [("x [m]", "y [m]"), ("x [mm]", "y [mm]")]


def test_a_radius_is_any_real_number():
    for r in (1, 1.0, np.float32(1.0), np.int64(1)):
        assert drawing.extent(Circle((0.0, 0.0), r)) == (-1.0, -1.0, 1.0, 1.0)
    for r in (0.0, -1.0, np.nan, np.inf, "1", None):
        with pytest.raises(ValueError, match="of finite numbers, and a finite radius above zero, got Circle"):
            drawing.extent(Circle((0.0, 0.0), r))


def test_models_draw_nothing_themselves():
    program = "import sys, lagrangian; lagrangian.scenes.bouncing_ball(); print('matplotlib' in sys.modules)"
    assert python(program) == "False"


def test_the_command_writes_films(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("lcpstep.plot.film.SHORTEST", 0.2)
    file = tmp_path / "ball.gif"
    assert main(["simulate", "bouncing-ball", "--t-end", "0.5", "--h", "0.01", "--film", str(file)]) == 0
    assert f"wrote {file}" in capsys.readouterr().out
    assert file.stat().st_size > 1000
