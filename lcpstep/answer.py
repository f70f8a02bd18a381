"""What any answer of a run can be asked to do: be drawn, labelled, written to a file; each loads what it needs."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import checks

Array = NDArray[np.float64]


def require_kept(times: Array, kept: Array) -> None:
    """ValueError where one of these times is none of the kept states."""
    if not np.all(np.isin(times, kept)):
        raise ValueError("t: states between the kept ones are not known; keep=1 keeps every step")


def asked(t: ArrayLike, known: Array) -> Array:
    """Times at which states are asked for, (m,); ValueError where they are none within those known of the run."""
    if len(known) == 0:
        raise ValueError("t: no state of this run was kept")
    start, end = known[0], known[-1]
    times = checks.vector("t", t)
    outside = ~((times >= start) & (times <= end))
    if np.any(outside):
        raise ValueError(f"t: expected times within [{start}, {end}] s, got {times[outside][0]}")
    return times


class Answer:
    """Base of `Trajectory` and of `HybridTrajectory`."""

    def plot(self) -> Any:
        """The motion over time: position, velocity, impulses at impacts; states and modes of a system with modes.

        Returns
        -------
        matplotlib.figure.Figure, which a notebook shows; elsewhere `run.plot().savefig("motion.png")`
        """
        from lcpstep.plot.motion import overview

        return overview(self)  # type: ignore[arg-type]

    def animate(
        self,
        path: str | Path | None = None,
        *,
        drawing: Any = None,
        seconds: float | None = None,
        fps: int = 25,
    ) -> Any:
        """The motion as a film, in which impacts flash; from the scene's drawing, or one that is given here.

        Parameters
        ----------
        path : where to write it: .gif, .mp4 (where ffmpeg is installed), or .html; None to write nothing
        drawing : function (t, q) -> shapes of `lagrangian.drawing`; default: the scene's
        seconds : how long the film plays; default: as long as the motion, but at least 3 s and at most 8 s
        fps : pictures in a second

        Returns
        -------
        a film, which a notebook shows and whose `save(path)` writes it; the path where one is given

        Raises
        ------
        ValueError   path, drawing, seconds or fps is none
        LcpStepError   there is no drawing, or it fails; ffmpeg is missing
        NotWritten   the file cannot be written
        """
        from lcpstep.plot.film import film

        made = film(self, drawing=drawing, seconds=seconds, fps=fps)
        return made if path is None else made.save(path)

    def to_xarray(self) -> Any:
        """States, impulses and the log as an `xarray.Dataset`: variables with units, attributes with what was run."""
        from lcpstep.saving import to_xarray

        return to_xarray(self)

    def to_dataframe(self, of: str = "states") -> Any:
        """A `pandas.DataFrame`.

        Parameters
        ----------
        of : "states": a line for each kept state, columns q0, q1, ..., v0, ..., impulse0, ...; the index is the
            time t [s]. "events": a line for each line of the log
        """
        from lcpstep.saving import to_dataframe

        return to_dataframe(self, of)

    def save(self, path: str | Path, *, overwrite: bool = False) -> Path:
        """Write the run to a NetCDF file that `lcpstep.load` makes equal to it again, to the last bit.

        The file holds states, impulses, log, status, counts, states between the kept ones, the scene (numbers;
        functions by name, source and checksum), the method and the versions. It appears complete or not at all.

        Parameters
        ----------
        path : a name that ends in .nc
        overwrite : whether a file that exists may be replaced

        Returns
        -------
        the path

        Raises
        ------
        FileExistsError   the file exists and `overwrite` is not set
        LcpStepError   the scene or the method holds something that no file can take; the message says what
        NotWritten   there is no space for it, or no permission
        """
        from lcpstep.saving import save

        return save(self, path, overwrite=overwrite)

    def _repr_html_(self) -> str:
        """What a notebook shows: a table of how the run went, and the motion as a small picture."""
        from lcpstep.summary import html

        return html(self)
