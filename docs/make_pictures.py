"""The pictures of README and of the first pages, into docs/pictures.

    python docs/make_pictures.py

The chaotic cam as a film, what accuracy costs, what motions settle to; and what the program of the first five minutes
draws.
"""

import os
import runpy
import shutil
import tempfile
from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from PIL import Image

from lagrangian import scenes
from lagrangian.drawing import drawn, places
from lcpstep import EventDriven, Kind, Located, Moreau, simulate, study
from lcpstep.analysis.basins import basins
from lcpstep.analysis.bifurcation import bifurcation
from lcpstep.plot.bifurcation import points, thinned

HERE = Path(__file__).resolve().parent
FOLDER = HERE / "pictures"
BODY, STRUCK, FIXED = "#1f77b4", "#d62728", "0.55"
FPS, SECONDS, SPAN = 20, 9.0, 1.0
MEASURE = "sup_position"
FLASH = 0.012  # how long an impact is seen [s of the motion]


def main() -> None:
    """Make all."""
    FOLDER.mkdir(exist_ok=True)
    cam_film(FOLDER / "cam.gif")
    accuracy().savefig(FOLDER / "accuracy.png", dpi=100)
    attractors().savefig(FOLDER / "attractors.png", dpi=100)
    first_pictures()


def cam_film(file: Path) -> None:
    """The cam at 660 rpm: the mechanism, and beside it the path in the plane of position and velocity."""
    run = simulate(scenes.cam_follower(rpm=660.0, t_end=SPAN), EventDriven())
    struck = run.impacts.time[run.impacts.kind == Kind.IMPACT]
    times = np.linspace(0.0, SPAN, round(FPS * SECONDS))
    figure = Figure(figsize=(7.2, 4.0), dpi=100, layout="constrained")
    canvas = FigureCanvasAgg(figure)
    left, right = figure.subplots(1, 2, width_ratios=[1.0, 2.1])
    left.set(xlim=(-0.75, 0.75), ylim=(-0.7, 2.1), aspect="equal", xticks=(), yticks=())
    right.set(xlabel="follower above the cam [m]", ylabel="its velocity [m/s]")
    fine = np.unique(np.concatenate([np.linspace(0.0, SPAN, 6001), struck, np.nextafter(struck, 0.0)]))
    q, v = (x[:, 0] for x in run.at(fine))
    right.set(xlim=(-0.03, 1.05 * q.max()), ylim=(1.1 * v.min(), 1.1 * v.max()))
    right.axvline(0.0, color=FIXED, lw=3.0)
    right.grid(alpha=0.3)
    (path,) = right.plot([], [], color=BODY, lw=0.8)
    (point,) = right.plot([], [], "o", color=STRUCK, ms=6)
    pictures = []
    for t in times:
        light = bool(np.any((struck <= t) & (t < struck + FLASH)))
        for artist in (*left.lines, *left.patches):
            artist.remove()
        for shape in drawn(run.scene.drawing, float(t), run.at(t)[0]):
            colour = FIXED if shape.fixed else STRUCK if light and shape.contacts else BODY
            xy = places(shape)
            if len(xy) > 2 and type(shape).__name__ == "Polygon":
                left.fill(*xy.T, facecolor=colour, alpha=0.6, edgecolor="k", lw=0.6)
            else:
                left.plot(*xy.T, "-" if len(xy) > 1 else "o", color=colour, lw=1.4, ms=5)
        shown = np.searchsorted(fine, t, side="right")
        path.set_data(q[:shown], v[:shown])
        point.set_data(q[shown - 1 : shown], v[shown - 1 : shown])
        left.set_title(f"t = {t:.2f} s, {SECONDS / SPAN:g} times slower", fontsize=9)
        canvas.draw()
        pictures.append(Image.fromarray(np.asarray(canvas.buffer_rgba())[:, :, :3].copy()))
    strip = np.array([struck_colours(width=40)] * pictures[-1].height)  # rare, but to be seen
    palette = Image.fromarray(np.hstack([np.asarray(pictures[-1]), strip])).quantize(48)
    colours = np.array(palette.getpalette()).reshape(-1, 3)
    colours[colours.min(axis=1) > 245] = 255  # the paper is white
    paper = Image.new("P", (1, 1))
    paper.putpalette(colours.ravel().tolist())
    pictures = [x.quantize(palette=paper, dither=Image.Dither.NONE) for x in pictures]
    pictures[0].save(
        file, save_all=True, append_images=pictures[1:], duration=1000 // FPS, loop=0, optimize=True
    )


def struck_colours(width: int) -> np.ndarray:
    """What shines, as a line and as a face on white, (2 width, 3)."""
    line = 255.0 * np.array(to_rgb(STRUCK))
    face = 0.6 * line + 0.4 * 255.0
    return np.repeat([line, face], width, axis=0).astype(np.uint8)


def accuracy() -> Figure:
    """Error over CPU time of the methods on the cam-follower before it is chaotic."""
    methods = {"Moreau": Moreau(), "Located, order 2": Located(), "Located, order 4": Located(order=4)}
    found = study(
        scenes.cam_follower(rpm=358.0, t_end=1.0),
        [*methods.values(), EventDriven()],
        h=[1e-2, 1e-3, 1e-4, 1e-5],
        tolerances=[1e-12],
        measures=[MEASURE],
    )
    figure = Figure(figsize=(7.6, 4.0), layout="constrained")
    ax = figure.subplots()
    for label, name, style in zip(methods, found.methods, ("o-", "s--", "D:"), strict=False):
        levels = [x for x in found.curve(name, MEASURE, trusted=False) if x.errors[MEASURE] > 0.0]
        ax.loglog([x.seconds for x in levels], [x.errors[MEASURE] for x in levels], style, label=label)
        last = levels[-1]
        ax.annotate(
            f"h = {last.value:.0e} s",
            (last.seconds, last.errors[MEASURE]),
            (0, 7),
            fontsize=8,
            textcoords="offset points",
        )
    exact = found.curve(found.methods[-1], MEASURE, trusted=False)[0]
    ax.loglog(
        exact.seconds,
        found.uncertainty[MEASURE],
        "k*",
        ms=13,
        label="EventDriven, which is\nknown to be as near",
    )
    ax.set(
        xlim=(2e-4, 2e-1),
        xlabel="CPU time [s]",
        ylabel="largest error of the position [m]",
        title="cam-follower at 358 rpm, 1 s",
    )
    ax.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)
    ax.grid(alpha=0.3)
    return figure


def attractors() -> Figure:
    """What the follower settles to over the speed, and where its motions end at 358.5 rpm."""
    data = bifurcation(scenes.cam_follower, "rpm", np.linspace(660.0, 760.0, 500), jobs=1)
    ends = basins(
        scenes.cam_follower(rpm=358.5, coordinates="absolute"), [0.1, -60.0], [1.6, 60.0], (400, 400), jobs=1
    )
    figure = Figure(figsize=(11.0, 3.8), layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=[1.5, 1.0])
    left.plot(*thinned(*points(data, "position")), "k.", ms=2.2, mew=0.0, rasterized=True)
    left.set(xlabel="cam speed [rpm]", ylabel="position once a turn [m]", xlim=(660.0, 760.0))
    left.set_title("chaos, one impact a turn, two, chaos", fontsize=10)
    label = ends["label"].values
    shades = np.array([(90, 90, 90), (255, 255, 255), (31, 119, 180), (190, 215, 240)], dtype=np.uint8)
    right.imshow(shades[label + 2], origin="lower", aspect="auto", extent=(0.1, 1.6, -60.0, 60.0))
    for k, (name, share) in enumerate(zip(ends["name"].values, ends["share"].values, strict=True)):
        right.plot([], [], "s", color=shades[k + 2] / 255.0, label=f"{name}: {100.0 * share:.0f} %")
    right.set(xlabel="position at the start [m]", ylabel="velocity at the start [m/s]")
    right.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)
    right.set_title("where motions at 358.5 rpm end", fontsize=10)
    return figure


def first_pictures() -> None:
    """What the program of docs/first-five-minutes.md writes."""
    page = (HERE / "first-five-minutes.md").read_text()
    before = Path.cwd()
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "motion.py"
        file.write_text(page.split("```python\n")[1].split("```")[0])
        os.chdir(folder)
        try:
            runpy.run_path(str(file))
        finally:
            os.chdir(before)
        shutil.copy(Path(folder) / "motion.png", FOLDER / "first-motion.png")
        shutil.copy(Path(folder) / "motion.gif", FOLDER / "first-film.gif")


if __name__ == "__main__":
    main()
