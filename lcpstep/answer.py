"""What any answer of a run can be asked to do: be drawn, labelled, written to a file; each loads what it needs."""

from __future__ import annotations

from pathlib import Path
from typing import Any


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
