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

NOTEBOOKS = sorted((ROOT / "python/notebooks").glob("*.py"))
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
def test_notebooks(path, tmp_path):
    environment = {**os.environ, "MPLBACKEND": "Agg", "PYVISTA_OFF_SCREEN": "true", "PERICLES_EXAMPLES": str(ROOT / "examples")}
    done = subprocess.run([sys.executable, str(path)], cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr


def test_stubs(tmp_path):
    stubtest = pytest.importorskip("mypy.stubtest")
    assert stubtest
    done = subprocess.run(
        [sys.executable, "-m", "mypy.stubtest", "pericles", "--mypy-config-file", str(ROOT / "pyproject.toml")],
        cwd=tmp_path,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_types():
    pytest.importorskip("mypy")
    done = subprocess.run([sys.executable, "-m", "mypy", "--config-file", str(ROOT / "pyproject.toml")], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout
