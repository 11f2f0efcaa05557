"""Runs of decks, and their results."""

import json
import pickle
import subprocess
import warnings
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, program

import pericles as pc

EXAMPLES = [path for path in sorted((ROOT / "examples").rglob("*.toml")) if path.name != "expected.toml"]


def short(path: Path) -> dict[str, str]:
    """Return overrides that cut an example to 20 steps, at most two seconds of computing; a static run has few steps."""
    deck = pc.Deck.read(path)
    facts = deck.build().facts
    return {"time.end": f"{min(facts['steps'], 20) * facts['dt']!r} s"}


#: Entries of run.json that measure the machine.
VOLATILE = {"wall_seconds", "directed_bond_updates_per_second", "peak_memory"}


def lasting(value):
    """Return the content of run.json without the entries that differ between two runs of the program."""
    if isinstance(value, dict):
        return {key: lasting(entry) for key, entry in value.items() if key not in VOLATILE}
    return [lasting(entry) for entry in value] if isinstance(value, list) else value


def files(folder: Path) -> dict[str, bytes]:
    """Return the files of a run; of run.json what two runs of the program have in common."""
    found = (path for path in folder.rglob("*") if path.is_file() and path.name != ".lock")
    out = {str(path.relative_to(folder)): path.read_bytes() for path in found}
    out["run.json"] = json.dumps(lasting(json.loads(out["run.json"]))).encode()
    return out


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: str(path.relative_to(ROOT / "examples")))
@pytest.mark.slow
def test_a_run_writes_the_bytes_of_the_program(path, tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        changes = short(path)
        result = pc.run(path, set=changes, out=tmp_path / "python")
    sets = [word for key, value in changes.items() for word in ("--set", f"{key}={value}")]
    done = subprocess.run([*program(), "run", str(path), *sets, "--out", str(tmp_path / "program"), "--quiet"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    ours, theirs = files(tmp_path / "python"), files(tmp_path / "program")
    # The clock decides at which steps a run writes checkpoints.
    unpaired = [name for name in ours.keys() ^ theirs.keys() if not name.startswith("checkpoints/")]
    assert not unpaired
    different = [name for name in ours.keys() & theirs.keys() if ours[name] != theirs[name]]
    assert not different
    assert result.info.status == "finished"


def test_results_of_a_run(plate, tmp_path):
    plate["initial"] = [{"set": "left", "velocity": [-5, 0]}]
    plate["output"] = {"fields": {"count": 4}, "history": {"every": 5}}
    result = pc.run(plate, out="a")
    assert result.folder == Path("a") and result.info.status == "finished"
    u = result.field("displacement")
    n = result.info.model.points
    assert u.shape == (n, 2) and result.points.shape == (n, 2) and n == 200
    assert not u.flags.writeable
    with pytest.raises(ValueError):
        u[0, 0] = 1
    # The outputs are ordered in time, and `time` selects the nearest one.
    assert len(result.times) == 5 and np.all(np.diff(result.times) > 0)
    middle = result.field("displacement", time=result.times[2] * 1.01)
    assert np.array_equal(middle, result.field("displacement", output=2))
    text = f"{result.times[2] * 1e6} us"
    assert np.array_equal(middle, result.field("displacement", time=text))
    for wrong in ("3 kg", "soon", [1.0, 2.0]):
        with pytest.raises(pc.PericlesError, match="number in s"):
            result.field("displacement", time=wrong)
    assert result.field("damage").shape == (n,)
    assert result.history["time"][-1] == pytest.approx(4e-6)
    assert result.history.units["kinetic_energy"] == "J"
    assert result.scalar("kinetic_energy") == result.history["kinetic_energy"][-1]
    assert result.scalar("audit.broken_bonds") == result.audit.broken_bonds
    assert abs(result.audit.balance) < 1e-3 * result.audit.initial_energy
    # A result is pickled by its path.
    again = pickle.loads(pickle.dumps(result))
    assert np.array_equal(again.field("velocity"), result.field("velocity"))
    for wrong in (lambda: result.field("pressure"), lambda: result.history["x"], lambda: result.table("y"), lambda: result.field("damage", output=7)):
        with pytest.raises(pc.PericlesError, match="there (is no|are)"):
            wrong()


def test_tables_go_to_pandas_and_polars(bar):
    result = pc.Deck.from_dict(bar).build().simulation().run().result()
    frame = result.history.to_pandas()
    assert list(frame.columns) == list(result.history)
    assert np.shares_memory(frame["kinetic_energy"].to_numpy(), result.history.to_pandas()["kinetic_energy"].to_numpy()) or len(frame)
    assert np.array_equal(frame["time"], result.history["time"])
    polars = result.history.to_polars()
    assert polars["balance"].to_numpy() == pytest.approx(result.history["balance"])


def test_fields_go_to_pyvista_and_meshio(plate):
    plate["initial"] = [{"set": "left", "velocity": [-5, 0]}]
    plate["output"] = {"fields": {"count": 1}}
    folder = pc.run(plate, out="a")
    memory = pc.Deck.from_dict(plate).build().simulation().run().result()
    grid = folder.to_pyvista()
    assert grid.n_cells == 200 and "Damage" in grid.cell_data
    # Cells where the program's are, with the same fields.
    cells = memory.to_pyvista()
    assert cells.n_cells == 200
    for mine, theirs in zip(range(200), range(200)):
        assert cells.get_cell(mine).bounds == pytest.approx(grid.get_cell(theirs).bounds, abs=1e-15)
    assert np.array_equal(cells.cell_data["Displacement"], grid.cell_data["Displacement"])
    assert cells.compute_cell_sizes()["Area"] == pytest.approx(np.full(200, 1e-6))
    points = memory.to_pyvista(cells=False)
    assert points.n_points == 200
    assert np.array_equal(points.point_data["Displacement"][:, :2], memory.field("displacement"))
    mesh = memory.to_meshio()
    assert np.array_equal(mesh.point_data["displacement"][:, :2], memory.field("displacement"))
    # The same run in memory and in files.
    assert np.array_equal(folder.field("displacement"), memory.field("displacement"))


def test_fields_are_shown_in_the_browser_and_in_notebooks(plate, monkeypatch):
    opened = []
    monkeypatch.setattr("webbrowser.open", lambda address: opened.append(address) or True)
    plate["output"] = {"fields": {"count": 3}}
    result = pc.run(plate, out="a")
    view = result.view(every=2, fields=["damage"], height=400)
    assert opened == [(result.folder / "fields.html").absolute().as_uri()]
    assert view.notes == ["3 of 4 output times are shown."]
    assert "Damage" in view.path.read_text() and "Velocity" not in view.path.read_text()
    frame = view._repr_html_()
    assert frame.startswith("<iframe sandbox=") and "height: 400px" in frame and "<script" not in frame
    with pytest.raises(pc.PericlesError, match='no field "damages"'):
        result.view(fields=["damages"])
    with pytest.raises(pc.PericlesError, match="every is 0"):
        result.view(every=0)
    memory = pc.Deck.from_dict(plate).build().simulation(keep=["damage"]).run().result()
    with pytest.raises(pc.PericlesError, match="in memory"):
        memory.view()


def test_the_output_folder_is_not_replaced(bar):
    pc.run(bar, out="a")
    with pytest.raises(pc.OutputError, match="already exists"):
        pc.run(bar, out="a")
    with pytest.raises(OSError):
        pc.open("nowhere")
    pc.run(bar, out="a", force=True)
    assert pc.run(bar).folder.name == "run" and pc.run(bar).folder.name == "run-2"


def test_results_are_compared(bar):
    a, b = pc.run(bar, out="a"), pc.run(bar, out="b")
    assert pc.diff(a, b).identical
    c = pc.run(bar, set={"material.youngs_modulus": "211 GPa"}, out="c")
    found = pc.diff(a, c, tolerance=1e-6)
    assert not found.equal
    assert max(row.relative for row in found.rows) > 1e-3


def test_unstable_runs(bar):
    bar["time"] = {"end": "1 ms", "dt": "5 us", "allow_unstable": False}
    with pytest.raises(pc.DeckError):
        pc.run(bar)
    # Beyond the stable step the motion grows until its numbers overflow.
    deck = {**bar, "time": {"end": "10 ms", "dt": "5 us", "allow_unstable": True}}
    with pytest.raises(pc.UnstableError) as caught, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        pc.Deck.from_dict(deck).build().simulation().run()
    error = caught.value
    assert isinstance(error, ArithmeticError)
    assert error.step > 0 and error.time > 0 and len(error.place) == 3
    assert error.result.info.progress.last_step <= error.step


def test_a_body_that_does_not_fit(bar):
    bar["body"] = {"shape": "block", "size": [1, 1, 1], "spacing": "1 mm"}
    del bar["initial"]
    with pytest.raises(pc.TooLargeError) as caught:
        pc.Deck.from_dict(bar).build()
    assert isinstance(caught.value, MemoryError)
    assert caught.value.needed > caught.value.allowed > 0


def test_sweeps_go_on(bar):
    values = {"body.spacing": ["2 cm", "1 cm"], "material.horizon_ratio": [3, 4]}
    points = list(pc.sweep(bar, values, jobs=2, out="s"))
    assert [p.values["body.spacing"] for p in points] == ["2 cm", "2 cm", "1 cm", "1 cm"]
    assert [p.result.info.model.points for p in points] == [50, 50, 100, 100]
    written = [(p.result.folder / "run.json").stat().st_mtime_ns for p in points]
    again = list(pc.sweep(bar, values, out="s"))
    assert [(p.result.folder / "run.json").stat().st_mtime_ns for p in again] == written
    with pytest.raises(pc.DeckError):
        next(pc.sweep(bar, {"body.spacing": ["1 kg"]}))
