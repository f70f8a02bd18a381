"""Films of a run: its scene's drawing at equal distances of time, impacts as flashes; GIF, MP4 or a page.

What stands still is drawn once. A shape whose contacts are struck turns red, the stronger the impulse the more, and
fades. The playing speed is written in the film, for a film of a quick motion is slow.
"""

from __future__ import annotations

import io
import shutil
import subprocess
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import checks
from lagrangian.drawing import Circle, Drawing, Point, Polygon, Shape, drawn, extent, places
from lagrangian.labels import own_unit
from lcpstep.errors import LcpStepError
from lcpstep.files import file_path, replacing
from lcpstep.plot.player import page
from lcpstep.trajectory import blows

Pixels = NDArray[np.uint8]  # (height, width, 3)
SHORTEST, LONGEST = 3.0, 8.0  # of a film whose length nobody has chosen [s]
FLASH = 0.35  # how long an impact is seen [s of the film]
WEAKEST = 0.25  # how much is seen of the weakest impact
MARGIN = 0.06  # around the picture, of its size
LARGE, SMALL = (5.6, 4.8), (3.8, 2.2)  # what a picture measures at most and at least [inch]
BESIDE = (0.8, 0.9)  # of it are labels and words [inch]
DPI = 100
WORDS = 0.34  # above the axes are left to a line of words [inch]
BODY, FIXED, STRUCK = (0.12, 0.47, 0.71), (0.35, 0.35, 0.35), (0.84, 0.15, 0.16)
COLOURS = 64  # of a GIF
FASTEST = 50  # pictures of it in a second: players slow down what is quicker


@dataclass(frozen=True, eq=False)
class Film:
    """A run as a film; a notebook shows it, `save` writes it.

    Attributes
    ----------
    run : Trajectory or HybridTrajectory
    drawing : function (t, q) -> shapes
    seconds : from the first picture to the last
    fps : pictures in a second
    """

    run: Any
    drawing: Drawing
    seconds: float
    fps: int

    @cached_property
    def times(self) -> NDArray[np.float64]:
        """The times of the run that are shown [s]."""
        return np.linspace(self.run.t[0], self.run.t[-1], 1 + max(1, round(self.seconds * self.fps)))

    @property
    def speed(self) -> float:
        """Seconds of the motion in a second of the film."""
        return float(self.run.t[-1] - self.run.t[0]) / (len(self.times) - 1) * self.fps

    def save(self, path: str | Path, progress: Callable[[int, int], None] | None = None) -> Path:
        """Write the film: .gif, .mp4 (needs ffmpeg), or .html, a page with controls.

        Raises
        ------
        ValueError   the name ends in something else
        LcpStepError   the drawing fails, or there is no ffmpeg
        NotWritten   no permission, no space
        """
        path = file_path(path)
        writer = _writer(path)
        film = replace(self, fps=min(self.fps, FASTEST)) if path.suffix == ".gif" else self
        with replacing(path) as draft:
            draft.touch()
            writer(draft, film._told(progress), film.fps)
        return path

    def frames(self) -> Iterator[Pixels]:
        """The pictures, one after another."""
        states = self.run.at(self.times)
        q = states[0] if isinstance(states, tuple) else states
        try:
            shapes = [drawn(self.drawing, float(t), x) for t, x in zip(self.times, q, strict=True)]
        except ValueError as error:
            raise LcpStepError(f"{error}; it is drawn by {_name(self.drawing)}") from error
        yield from _pictures(self, shapes, self._glow())

    def _told(self, progress: Callable[[int, int], None] | None) -> Iterator[Pixels]:
        for k, picture in enumerate(self.frames()):
            yield picture
            if progress is not None:
                progress(k + 1, len(self.times))

    def _glow(self) -> NDArray[np.float64]:
        """How bright each contact shines in each picture, (frames, n_c) in [0, 1]."""
        glow = np.zeros((len(self.times), getattr(self.run.scene, "n_c", 0)))
        log = getattr(self.run, "impacts", None)
        struck = [] if log is None else [x for x in blows(log) if x.impulse > 0.0]
        strongest = max((float(x.impulse) for x in struck), default=0.0)
        for x in struck:
            since = (self.times - x.time) / self.speed
            strength = WEAKEST + (1.0 - WEAKEST) * float(x.impulse) / strongest
            light = np.where(
                (since >= -0.5 / self.fps) & (since < FLASH), strength * (1.0 - since / FLASH), 0.0
            )
            glow[:, x.contact] = np.maximum(glow[:, x.contact], np.clip(light, 0.0, 1.0))
        return glow

    def _repr_html_(self) -> str:
        """The film with its controls, for notebooks."""
        return page(list(map(png, self.frames())), self.fps)


def film(run: Any, *, drawing: Drawing | None = None, seconds: float | None = None, fps: int = 25) -> Film:
    """The film of a run; see `Trajectory.animate`."""
    checks.has("run", run, "scene", "a Trajectory")
    drawing = run.scene.drawing if drawing is None else drawing
    if drawing is None:
        raise LcpStepError(
            f"scene: {run.scene.name!r} has no drawing; give animate(drawing=f) or the scene a function "
            "f(t, q) that returns shapes of lagrangian.drawing"
        )
    if not callable(drawing):
        raise ValueError(f"drawing: expected a function f(t, q) that gives shapes, got {drawing!r}")
    if len(run.t) < 2 or not run.t[-1] > run.t[0]:
        raise LcpStepError(f"{run.scene.name!r}: a film needs a run of some length, of which states are kept")
    span = float(run.t[-1] - run.t[0])
    length = min(max(span, SHORTEST), LONGEST) if seconds is None else checks.positive("seconds", seconds)
    return Film(run, drawing, length, checks.count("fps", fps))


def png(picture: Pixels) -> bytes:
    """One picture as a PNG of few colours."""
    stream = io.BytesIO()
    _in_few_colours(picture).save(stream, "png", optimize=False)
    return stream.getvalue()


def _in_few_colours(picture: Pixels) -> Any:
    """Those of an octree, which takes a tenth of the time of the best ones."""
    from PIL import Image

    return Image.fromarray(picture).quantize(COLOURS, Image.Quantize.FASTOCTREE)


# --- writers


def _writer(path: Path) -> Callable[[Path, Iterator[Pixels], int], None]:
    if path.suffix not in WRITERS:
        raise ValueError(f"path: expected a name that ends in {', '.join(WRITERS)}, got {str(path)!r}")
    if path.suffix == ".mp4" and shutil.which("ffmpeg") is None:
        raise LcpStepError(
            f"path: {path.name} needs ffmpeg, which is not on the PATH; install it, or write .gif or .html"
        )
    return WRITERS[path.suffix]


def _gif(draft: Path, pictures: Iterator[Pixels], fps: int) -> None:
    """Pictures last whole hundredths of a second."""
    images = [_in_few_colours(x) for x in pictures]
    shown = 10 * np.diff(np.round(100.0 / fps * np.arange(len(images) + 1))).astype(int)
    images[0].save(draft, save_all=True, append_images=images[1:], duration=shown.tolist(), loop=0)


def _mp4(draft: Path, pictures: Iterator[Pixels], fps: int) -> None:
    first = next(pictures)
    height, width = first.shape[0] // 2 * 2, first.shape[1] // 2 * 2  # the codec takes even numbers
    command = [
        "ffmpeg", "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}",
        "-r", str(fps), "-i", "-", "-pix_fmt", "yuv420p", str(draft),
    ]  # fmt: skip
    content = b"".join(x[:height, :width].tobytes() for x in (first, *pictures))
    done = subprocess.run(command, input=content, capture_output=True, check=False)
    if done.returncode != 0:
        said = done.stderr.decode(errors="replace").strip().splitlines()
        raise LcpStepError(
            f"path: ffmpeg failed: {said[-1] if said else done.returncode}; write .gif or .html"
        )


def _html(draft: Path, pictures: Iterator[Pixels], fps: int) -> None:
    draft.write_text(f"<!doctype html><meta charset='utf-8'>{page(list(map(png, pictures)), fps)}")


WRITERS = {".gif": _gif, ".mp4": _mp4, ".html": _html}


# --- pictures


def _pictures(film: Film, shapes: list[list[Shape]], glow: NDArray[np.float64]) -> Iterator[Pixels]:
    """Each picture: axes from one drawing, moving shapes upon them."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    x0, y0, x1, y1 = _frame([extent(shape) for these in shapes for shape in these])
    size = _size(x1 - x0, y1 - y0)
    top = 1.0 - WORDS / size[1]
    figure = Figure(figsize=size, dpi=DPI, layout=ConstrainedLayoutEngine(rect=(0.0, 0.0, 1.0, top)))
    canvas, ax = FigureCanvasAgg(figure), figure.subplots()
    unit = own_unit("m", film.run.scene.labels)
    ax.set(xlim=(x0, x1), ylim=(y0, y1), xlabel=f"x [{unit}]", ylabel=f"y [{unit}]")
    ax.set_aspect("equal", adjustable="box")
    ax.locator_params(axis="x", nbins=int(np.clip(6.0 * (x1 - x0) / (y1 - y0), 2, 9)))
    ax.grid(alpha=0.2)
    words = figure.text(0.02, 1.0 - 0.3 * WORDS / size[1], "", va="top", fontsize=9, animated=True)
    canvas.draw()
    figure.set_layout_engine("none")
    background = canvas.copy_from_bbox(figure.bbox)
    for t, these, light in zip(film.times, shapes, glow, strict=True):
        canvas.restore_region(background)
        for shape in these:
            ax.draw_artist(
                _artist(ax, shape, max((light[c] for c in shape.contacts if c < len(light)), default=0.0))
            )
        for artist in (*ax.patches, *ax.lines):
            artist.remove()
        words.set_text(f"{film.run.scene.name}   t = {t:.3f} s   {_speed(film.speed)}")
        ax.draw_artist(words)
        yield np.asarray(canvas.buffer_rgba())[:, :, :3].copy()


def _artist(ax: Any, shape: Shape, light: float) -> Any:
    """A shape as matplotlib draws it."""
    from matplotlib import patches

    own = np.array(FIXED if shape.fixed else BODY)
    colour = tuple(own + light * (np.array(STRUCK) - own))
    if isinstance(shape, Circle):
        face = "none" if shape.fixed else colour
        return ax.add_patch(
            patches.Circle((shape.centre[0], shape.centre[1]), shape.radius, fc=face, ec=colour, lw=1.2)
        )
    if isinstance(shape, Polygon):
        face = (*colour, 0.5)
        return ax.add_patch(patches.Polygon(places(shape), closed=True, fc=face, ec=colour, lw=1.2))
    x, y = places(shape).T
    if isinstance(shape, Point):
        return ax.plot(x, y, "o", color=colour, ms=5)[0]
    return ax.plot(x, y, "-", color=colour, lw=1.6, solid_joinstyle="round")[0]


def _frame(extents: list[tuple[float, float, float, float]]) -> tuple[float, float, float, float]:
    """Limits of the axes around all shapes of all pictures, in the proportions of the picture."""
    corners = np.array(extents or [(-1.0, -1.0, 1.0, 1.0)])
    low, high = np.min(corners[:, :2], axis=0), np.max(corners[:, 2:], axis=0)
    size = high - low
    least = 0.35 * float(np.max(size)) or 1.0
    middle, size = 0.5 * (low + high), np.maximum(size, least) * (1.0 + 2.0 * MARGIN)
    low, high = middle - 0.5 * size, middle + 0.5 * size
    return float(low[0]), float(low[1]), float(high[0]), float(high[1])


def _size(width: float, height: float) -> tuple[float, float]:
    """Of a picture whose axes have these proportions [inch]: as large as it may be, and little around the axes."""
    scale = min(
        (most - beside) / length for most, beside, length in zip(LARGE, BESIDE, (width, height), strict=True)
    )
    wide, high = (
        max(least, scale * length + beside)
        for least, beside, length in zip(SMALL, BESIDE, (width, height), strict=True)
    )
    return wide, high


def _speed(speed: float) -> str:
    """How fast it plays, in words."""
    if abs(speed - 1.0) < 0.01:
        return "as fast as it is"
    return f"{1.0 / speed:.3g} times slower" if speed < 1.0 else f"{speed:.3g} times faster"


def _name(f: Any) -> str:
    inner = getattr(f, "func", f)
    return str(getattr(inner, "__qualname__", type(inner).__name__))
