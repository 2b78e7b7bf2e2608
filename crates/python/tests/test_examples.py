"""Examples find what they look for, and the docs' code runs."""

from __future__ import annotations

import importlib
import os
import re
import shutil
import sys
from pathlib import Path

import pytest
import sinew

from conftest import ROOT

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"


def test_a_sample_is_identified() -> None:
    pytest.importorskip("scipy")
    sys.path.insert(0, str(EXAMPLES))
    identify = importlib.import_module("identify")
    scene = sinew.Scene.from_text(identify.TEST)
    young, poisson, runs = identify.identify(identify.measurement(scene, 3000, 0.45), scene)
    # noise s of 2.6e-3 N along x, where the forces of shearing change by 0.42 N for each unit of the logarithm of E
    # (their root of squares), bounds it with 3 s/0.42 = 2 %
    assert young == pytest.approx(3000, rel=0.02) and poisson == pytest.approx(0.45, abs=0.005)
    assert runs < 100


def test_code_in_the_docs_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = (ROOT / "docs/python.md").read_text()
    blocks = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    assert len(blocks) >= 10
    shutil.copytree(ROOT / "scenes", tmp_path / "scenes")
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {"__name__": "docs"}
    for number, block in enumerate(blocks):
        place = text[: text.index(block)].count("\n")
        # lines of tracebacks are those of the page
        exec(compile("\n" * place + block, f"docs/python.md, block {number}", "exec"), names)  # noqa: S102
    assert "pandas" not in sys.modules and os.listdir(tmp_path)


def test_the_notebook_runs(tmp_path: Path) -> None:
    nbclient = pytest.importorskip("nbclient")
    nbformat = pytest.importorskip("nbformat")
    notebook = nbformat.read(EXAMPLES / "quickstart.ipynb", as_version=4)
    shutil.copytree(ROOT / "scenes", tmp_path / "scenes")
    assert not any(cell.get("outputs") for cell in notebook.cells), "it is kept without outputs"
    place = {"metadata": {"path": tmp_path}}
    nbclient.NotebookClient(notebook, timeout=120, kernel_name="python3", resources=place).execute()
    shown = [kind for cell in notebook.cells for output in cell.get("outputs", []) for kind in output.get("data", {})]
    assert shown.count("image/png") >= 2
