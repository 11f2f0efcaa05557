"""Docstrings, the book, notebooks, the README and the stubs."""

import doctest
import importlib
import os
import pkgutil
import re
import subprocess
import sys
import warnings
from pathlib import Path

import pytest
from conftest import ROOT

import pericles

NOTEBOOKS = sorted((ROOT / "python/notebooks").glob("*.ipynb"))
SURFACE = ROOT / "python/tests/surface.py"
MODULES = [name for _, name, _ in pkgutil.iter_modules(pericles.__path__) if name not in ("__main__", "_pericles")]


@pytest.mark.parametrize("name", ["", *MODULES])
def test_examples_of_docstrings(name):
    module = importlib.import_module(f"pericles.{name}" if name else "pericles")
    failed, _ = doctest.testmod(module, optionflags=doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE)
    assert failed == 0


def test_every_public_item_is_documented():
    for name in pericles.__all__:
        item = getattr(pericles, name)
        if name in ("__version__", "STOP"):
            continue
        assert (item.__doc__ or "").strip().endswith((".", "]", ")", ">>>", "x\"))", "True")) or item.__doc__, name
        for inner, value in vars(item).items() if isinstance(item, type) else ():
            if not inner.startswith("_") and (callable(value) or isinstance(value, property)):
                assert value.__doc__, f"{name}.{inner}"


def blocks(path: Path) -> list[str]:
    """Return the Python blocks of a page."""
    return re.findall(r"^```python\n(.*?)^```", path.read_text(encoding="utf-8"), re.S | re.M)


@pytest.mark.slow
@pytest.mark.parametrize("page, least", [(ROOT / "README.md", 1), (ROOT / "book/src/how-to/python.md", 8)], ids=["readme", "book"])
def test_pages(page, least, tmp_path, monkeypatch):
    pytest.importorskip("matplotlib")
    monkeypatch.setenv("MPLBACKEND", "Agg")
    os.symlink(ROOT / "examples", tmp_path / "examples")
    space: dict = {}
    found = blocks(page)
    assert len(found) >= least
    for number, block in enumerate(found):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            exec(compile(block, f"{page.name}, block {number + 1}", "exec"), space)


@pytest.mark.slow
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebooks(path, tmp_path, monkeypatch):
    """Notebooks run from the first cell to the last and draw their figures; they are stored without outputs."""
    client, format = pytest.importorskip("nbclient"), pytest.importorskip("nbformat")
    monkeypatch.setenv("PYVISTA_OFF_SCREEN", "true")
    notebook = format.read(path, as_version=4)
    format.validate(notebook)
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert not any(cell.outputs or cell.execution_count for cell in code)
    client.NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(tmp_path)}}).execute()
    outputs = [output for cell in code for output in cell.outputs]
    assert any("image/png" in output.get("data", {}) for output in outputs)


def test_stubs(tmp_path):
    stubtest = pytest.importorskip("mypy.stubtest")
    assert stubtest
    # Aliases for type checkers do not exist when the package runs.
    (tmp_path / "allowed").write_text("pericles\\._types\\..*\n")
    done = subprocess.run(
        [
            *(sys.executable, "-m", "mypy.stubtest", "pericles", "--mypy-config-file", str(ROOT / "pyproject.toml")),
            *("--allowlist", str(tmp_path / "allowed"), "--ignore-unused-allowlist"),
        ],
        cwd=tmp_path,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize("of", ["package", "user"])
def test_types(of):
    """The package, and a script of a user that covers its surface, pass mypy --strict."""
    pytest.importorskip("mypy")
    files = [] if of == "package" else [str(SURFACE)]
    command = [sys.executable, "-m", "mypy", "--strict", "--config-file", str(ROOT / "pyproject.toml"), *files]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_surface_runs():
    pytest.importorskip("matplotlib")
    environment = {**os.environ, "MPLBACKEND": "Agg"}
    done = subprocess.run([sys.executable, str(SURFACE)], env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_the_surface_is_covered():
    """Every public name, and every public method and property, occurs in the script."""
    text = SURFACE.read_text(encoding="utf-8")
    for name in pericles.__all__:
        assert re.search(rf"\bpc\.{name}\b", text), name
        item = getattr(pericles, name)
        if isinstance(item, type) and not issubclass(item, BaseException):
            own = [inner for inner, value in vars(item).items() if not inner.startswith("_") and (callable(value) or isinstance(value, property))]
            missing = [inner for inner in own if not re.search(rf"\.{inner}\b", text)]
            assert not missing, (name, missing)
