"""The notebooks: kept without outputs, run from the first cell to the last, and saying which cells take how long."""

import re
from datetime import datetime
from pathlib import Path

import pytest

import lcpstep
from tests.marks import shared

ROOT = Path(lcpstep.__file__).parents[1]
NOTEBOOKS = sorted((ROOT / "notebooks").glob("*.ipynb"))
TAKES = re.compile(r"\*\*Takes about (\w+)\s+seconds\.\*\*")
SLOWER = 20.0  # what this machine may be slower than the one of the notebooks, at most
QUICK = 1.0  # of a cell that says nothing [s]
NUMBERS = {"two": 2.0, "three": 3.0, "four": 4.0}


def read(file):
    return pytest.importorskip("nbformat").read(file, 4)


def code(notebook):
    """Cells of code, each with the text before it."""
    cells = notebook.cells
    return [
        (cell, cells[k - 1].source if cells[k - 1].cell_type == "markdown" else "")
        for k, cell in enumerate(cells)
        if cell.cell_type == "code"
    ]


def test_there_are_three():
    assert [file.stem for file in NOTEBOOKS] == ["1-tour", "2-accuracy-study", "3-attractors"]


@pytest.mark.parametrize("file", NOTEBOOKS, ids=lambda file: file.stem)
def test_a_notebook_is_kept_without_outputs_and_says_how_long_its_cells_take(file):
    notebook = read(file)
    pytest.importorskip("nbformat").validate(notebook)
    assert all(cell.outputs == [] and cell.execution_count is None for cell, _ in code(notebook))
    assert "takes about a second or less, but for those that say otherwise" in notebook.cells[0].source
    said = [words for _, before in code(notebook) for words in TAKES.findall(before)]
    assert said
    assert set(said) <= set(NUMBERS)


@pytest.mark.parametrize("file", shared(NOTEBOOKS, 3), ids=lambda file: file.stem)
def test_a_notebook_runs_and_its_last_figures_are_shown(file, tmp_path, monkeypatch):
    client = pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    notebook = read(file)
    client.NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(tmp_path)}}).execute()
    for cell, before in code(notebook):
        when = cell.metadata.execution
        begun, ended = (
            datetime.fromisoformat(when[x].replace("Z", "+00:00"))
            for x in ("iopub.execute_input", "shell.execute_reply")
        )
        takes = TAKES.search(before)
        assert (ended - begun).total_seconds() < SLOWER * (NUMBERS[takes[1]] if takes else QUICK)
        figures = [o for o in cell.outputs if "<Figure size" in o.get("data", {}).get("text/plain", "")]
        assert all("image/png" in figure.data for figure in figures)


def test_a_figure_is_shown_by_a_notebook_that_has_not_loaded_pyplot():
    from lagrangian import scenes
    from lcpstep import EventDriven, simulate

    figure = simulate(scenes.bouncing_ball(), EventDriven()).plot()
    assert figure._repr_png_().startswith(b"\x89PNG")
