"""The page that shows every figure and every number beside what the thesis prints."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from lcpstep.thesis.catalogue import FIGURES, make
from lcpstep.thesis.numbers import Number, numbers
from lcpstep.thesis.printed import PRINTED

CHAPTERS = {
    2: "Smooth bifurcations of maps",
    3: "The cam-follower: time series and attractors",
    4: "Bifurcation diagrams, chattering, basins",
    5: "The corner impact",
    6: "Border collisions",
    7: "The hybrid anti-lock controller",
}
DPI = 90  # of the pictures in the page
HEAD = """# Reproducing the thesis

Figures and numbers of G. Osorio, *Complex Behavior in Impacting Systems* (PhD thesis, University of Naples
Federico II), made by this library. Written by `lcpstep thesis --page`; each figure alone, as PNG and SVG with
its data, by `lcpstep thesis NUMBER`. Parameters of the cam-follower are those of
`lagrangian/scenes/cam_follower.py`, for the thesis' text gives none. The thesis' own pictures are not copied
here: what is known to us of each stands in words above ours. Figures whose number is not known to us go by
their window or by what they show. "Printed" is what the thesis states, a dash where the number is not at hand;
computed numbers are written with the digits that are known.
Studies in words, with their commands: [thesis-notes.md](thesis-notes.md).
"""
CONTRADICTED = {
    4: "The accumulation points printed as 119.72 and 136.38 rpm are 0.0075 and 0.068 rpm off where the located "
    "event lies on the corner; sequences summed hop by hop in 110 digits have it at 119.712481039598 and "
    "136.312372392874 (`tests/cam_sequences.py`). O(2, 2), born at the flip, ends at once in a corner impact; "
    "the chaotic attractor that follows it grows at 740.13 rpm or before. "
    "Isolated columns of the diagram 357.5-361.5 rpm are no transients: at 358.4524 and 359.1441 rpm "
    "orbits of 23 and 11 periods, with one complete chattering sequence each, attract some of the starts.",
    5: "1.0052 and 0.4120 are off in their last digit: 1.00515 and 0.41207 follow from the period in closed "
    "form, by 40 digits. The normal form is y -> Ã± y + B̃ m with y = W x + (shift, 0) m and the border at y₁ "
    "= 0, W that of the observer form: continuity makes B̃ one vector for both sides. det Ã± = r² = 0.64, as "
    "it must be.",
    7: "The thesis prints 0.147, 0.419 and 0.517 s for its cycle. With its thresholds and k = 10 kN m/s the "
    "torque takes 600/10000 = 0.06 s from one threshold to the other in either reading of the model, and no "
    "two of these numbers, nor zero and one of them, differ by that: they do not follow from the printed "
    "parameters. The two asphalts are those of the thesis: (1.11, 23.99, 0.52) and (0.687, 33.822, 0.347), of "
    "which Burckhardt has the first coefficients as 1.2801 and 0.857. Dry cobblestone (1.3713, 6.4565, "
    "0.6691) and snow (0.1946, 94.129, 0.0646) are quoted from his table: M. Burckhardt, Fahrwerktechnik: "
    "Radschlupf-Regelsysteme (Vogel 1993), and U. Kiencke, L. Nielsen, Automotive Control Systems (Springer "
    "2000), and rounded to (1.37, 6.46, 0.67) and (0.19, 94.13, 0.06) in the literature on anti-lock "
    "controllers.",
}


def write_page(file: Path, told: Callable[[str], None]) -> None:
    """Make all figures beside the page, in a folder of its name, and write it; `told` hears what is being made."""
    folder = file.parent / "thesis"
    parts = [HEAD]
    found = numbers()
    for chapter, title in CHAPTERS.items():
        parts.append(f"## Chapter {chapter}: {title}\n")
        for name in (name for name in FIGURES if chapter_of(name) == chapter):
            told(name)
            make(name, folder, overwrite=True, kinds=("png",), dpi=DPI)
            figure = FIGURES[name]
            command = f"`lcpstep thesis {name}`" + (f" or `{figure.command}`" if figure.command else "")
            parts.append(
                f"### {name}: {figure.about}\n\n*In the thesis:* {PRINTED[name]}\n\n*Here:* by {command}.\n\n"
                f"![{figure.about}]({folder.name}/figure-{name}.png)\n"
            )
        rows = [n for n in found if n.chapter == chapter]
        if rows:
            parts.append(table(rows))
        if chapter in CONTRADICTED:
            parts.append(CONTRADICTED[chapter] + "\n")
    file.write_text("\n".join(parts))


def chapter_of(name: str) -> int:
    """Chapter of a figure; windows are of chapter 4."""
    first = name.partition(".")[0].partition("-")[0]
    return int(first) if first in ("2", "3", "4", "5", "6", "7") else 4


def table(rows: list[Number]) -> str:
    """Numbers beside the printed ones."""
    lines = ["| what | printed | computed | digits that agree | known by |", "|---|---|---|---|---|"]
    lines += [
        f"| {n.what} | {n.printed or '-'} | {n.text} | {n.agreement or '-'} | {n.check} |" for n in rows
    ]
    return "\n".join(lines) + "\n"
