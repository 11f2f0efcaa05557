"""What the program offers besides runs."""

import subprocess
import sys

import numpy as np
import pytest
from conftest import BAR, PLATE, ROOT, changed

import pericles as pc


def test_modes_of_a_bar():
    """Longitudinal modes of a free bar: f = k c / (2 L) for long waves."""
    deck = changed(BAR, body={"spacing": "5 mm"})
    found = pc.modes(deck, count=3)
    speed = (210e9 / 7850) ** 0.5
    assert found.frequencies == pytest.approx(speed / 2 * np.array([1, 2, 3]), rel=0.03)
    assert found.shapes.shape == (3, 200, 1) and np.abs(found.shapes).max() == pytest.approx(1)
    x = found.points[:, 0]
    first = found.shapes[0][:, 0]
    assert abs(np.corrcoef(first, np.cos(np.pi * x))[0, 1]) > 0.999
    assert found.rigid_modes == 1


def test_dispersion_of_a_plate():
    found = pc.dispersion(PLATE)
    assert len(found.curves) > 2 and found.polar is not None
    assert "stability" in found or len(found) > 3


def test_mesh_and_geodesics():
    found = pc.mesh(ROOT / "examples/geometry/dogbone.msh", unit="mm")
    assert found.points > 0 and found.volume > 0
    spheres = pc.geodesics("icosphere(2)", 0.8)
    # The area of a polyhedron in the unit sphere approaches 4 pi from below.
    assert 0.9 * 4 * np.pi < spheres.area < 4 * np.pi
    assert spheres.methods[0].mean_error >= 0


def test_errors_of_commands():
    with pytest.raises(pc.PericlesError, match="there is no study"):
        pc.reproduce("no-such-study")
    with pytest.raises(pc.PericlesError):
        pc.mesh("nowhere.msh")
    with pytest.raises(pc.DeckError):
        pc.modes(changed(BAR, body={"spacing": 0}))


def test_the_command_line_is_that_of_the_program():
    done = subprocess.run([sys.executable, "-m", "pericles", "--version"], capture_output=True, text=True)
    assert done.returncode == 0 and pc.__version__ in done.stdout
    done = subprocess.run([sys.executable, "-m", "pericles", "run", "nowhere.toml"], capture_output=True, text=True)
    assert done.returncode == 3 and "nowhere.toml" in done.stderr
