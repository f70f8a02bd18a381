"""A diagram on MPI processes is the diagram of one process; where mpi4py and an mpiexec are installed."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.processes import ROOT

PROGRAM = """
import numpy as np
if __name__ == "__main__":
    from mpi4py.futures import MPIPoolExecutor
    from lagrangian.scenes import cam_follower
    from lcpstep.analysis.bifurcation import bifurcation
    study = {"drop": 20, "keep": 3, "most": 4}
    speeds = np.linspace(357.0, 362.0, 16)
    with MPIPoolExecutor() as pool:
        there = bifurcation(cam_follower, "rpm", speeds, executor=pool, **study)
        print(pool.num_workers, there.identical(bifurcation(cam_follower, "rpm", speeds, **study)))
"""


def test_a_diagram_on_mpi_processes_is_that_of_one_process(tmp_path):
    pytest.importorskip("mpi4py")
    mpiexec = shutil.which("mpiexec", path=f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}")
    if mpiexec is None:
        pytest.skip("no mpiexec")
    program = tmp_path / "study.py"
    program.write_text(PROGRAM)
    done = subprocess.run(
        [mpiexec, "-n", "3", sys.executable, "-m", "mpi4py.futures", str(program)],
        env={**os.environ, "PYTHONPATH": str(ROOT)}, capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == ["2", "True"]
