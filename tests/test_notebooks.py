"""The notebooks of `examples/` are executed, small, and run as a script."""

import json

import matplotlib
import pytest
from matplotlib import pyplot

from blockshake.files import PACKAGE

NOTEBOOKS = sorted((PACKAGE.parents[1] / "examples").glob("*.ipynb"))
LARGEST = 300_000  # bytes, outputs included


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.name)
def test_a_notebook_runs_as_a_script_and_holds_its_outputs(path, tmp_path, monkeypatch):
    assert path.stat().st_size < LARGEST
    cells = [cell for cell in json.loads(path.read_text())["cells"] if cell["cell_type"] == "code"]
    assert [cell["execution_count"] for cell in cells] == list(range(1, len(cells) + 1))
    outputs = [output for cell in cells for output in cell["outputs"]]
    assert not any(output["output_type"] == "error" for output in outputs)
    assert any("image/png" in output.get("data", ()) for output in outputs)
    monkeypatch.chdir(tmp_path)
    matplotlib.use("agg")
    names = {}
    for cell in cells:
        exec("".join(cell["source"]), names)
    pyplot.close("all")
    assert names["run"].attrs["status"] == "completed"
    assert list(tmp_path.iterdir()) == []


def test_there_is_one():
    assert NOTEBOOKS
