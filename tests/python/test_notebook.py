"""The notebook runs to its end, and what it asserts holds."""
import pathlib

import pytest

nbformat = pytest.importorskip("nbformat")
nbclient = pytest.importorskip("nbclient")
pytest.importorskip("mitsuba")
pytest.importorskip("matplotlib")

EXAMPLES = pathlib.Path(__file__).parents[2] / "examples"


def test_from_a_measurement_to_mitsuba():
    notebook = nbformat.read(EXAMPLES / "measured_to_mitsuba.ipynb", as_version=4)
    nbclient.NotebookClient(notebook, timeout=600, kernel_name="python3").execute()
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    text = "".join(output.get("text", "") for output in outputs)
    assert "'energy': 'certified'" in text and "'hrl': 0" in text
    assert sum("image/png" in output.get("data", {}) for output in outputs) >= 4
