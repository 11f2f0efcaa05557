"""Runs of decks, and their results."""

import json
import pickle
import subprocess
import warnings
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, changed, program

import pericles as pc

EXAMPLES = [path for path in sorted((ROOT / "examples").rglob("*.toml")) if path.name != "expected.toml"]


def short(path: Path) -> dict[str, str]:
    """Return overrides that cut an example to 20 steps, at most two seconds of computing; a static run has few steps."""
    deck = pc.Deck.read(path)
    if deck.steps:
        return {}
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
    """Return the files of a run; of each run.json what two runs of the program have in common."""
    found = (path for path in folder.rglob("*") if path.is_file() and path.name != ".lock")
    out = {str(path.relative_to(folder)): path.read_bytes() for path in found}
    for name in out:
        if name.endswith("run.json"):
            # The runs of steps name the checkpoint from which they start.
            out[name] = json.dumps(lasting(json.loads(out[name]))).replace(f"{folder}/", "").encode()
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
    assert result.history.units["kinetic_energy"] == "J/m"
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


def test_results_are_mappings_of_fields(plate):
    memory = pc.Deck.from_dict(plate).build().simulation(keep=["displacement", "damage"]).run().result()
    assert list(memory) == ["displacement", "damage"] and "damage" in memory and "stress" not in memory
    assert np.array_equal(memory["displacement"], memory.field("displacement"))
    with pytest.raises(pc.PericlesError, match="stress"):
        memory["stress"]


def test_records_show_names_and_values(plate):
    plate["output"] = {"fields": {"count": 1}}
    result = pc.run(plate, out="a")
    shown = str(result.info)
    assert "status" in shown and "finished" in shown and "    points" in shown and " 200" in shown
    assert f"{result.audit.kinetic_energy:.6g}" in str(result.audit)
    # A long text, such as that of the deck, takes one line.
    assert len(max(shown.splitlines(), key=len)) < 400 and "… (" in shown
    assert pc.check(plate).deck == "<dict>" and all(text.startswith("<dict>:") for text in pc.check(plate).warnings)
    assert "steps" in str(pc.check(plate)) and str(pc.check(plate).steps) in str(pc.check(plate))


def test_tensors_have_named_components(plate):
    plate["initial"] = [{"velocity": [{"expression": "10*x"}, {"expression": "-20*x"}]}]
    plate["output"] = {"fields": {"count": 1, "names": ["Stress", "Displacement"]}}
    folder = pc.run(plate, out="a")
    memory = pc.Deck.from_dict(plate).build().simulation(keep=["stress", "displacement"], count=1).run().result()
    for result in (folder, memory):
        assert result.components("stress") == ["xx", "yy", "xy"]
        assert result.components("displacement") == ["x", "y"] and result.components("damage") == []
        assert result["stress"].shape == (200, 3)
    assert np.array_equal(folder["stress"], memory["stress"])
    # The series also has the components as fields of their own.
    assert np.array_equal(folder["stress"][:, 2], folder["stress_xy"]) and np.abs(folder["stress_xy"]).max() > 0


def test_runs_in_memory_have_the_tables_of_files(plate):
    plate.update(
        constraint=[{"set": "left", "displacement": [0, 0]}, {"set": "right", "velocity": [5, "free"]}],
        crack=[{"segment": [["10 mm", "0 mm"], ["10 mm", "3 mm"]]}],
        probe=[{"name": "tip", "at": ["20 mm", "5 mm"]}],
        output={
            "history": {"every": 10}, "cracks": {"every": 20}, "fragments": {"every": 20},
            "quantity": [{"name": "pull", "unit": "N", "expression": "reaction.right.x - reaction.left.x"}],
        },
    )
    folder = pc.run(plate, out="a")
    simulation = pc.Deck.from_dict(plate).build().simulation()
    memory = simulation.run().result()
    assert memory.tables == folder.tables == ["cracks", "fragments", "history", "probes", "quantities", "reactions"]
    for name in memory.tables:
        a, b = memory.table(name), folder.table(name)
        assert list(a) == list(b) and a.units == b.units
        for column in a:
            assert np.array_equal(a[column], b[column], equal_nan=True), (name, column)
    assert memory.scalar("tip_u_x") == folder.scalar("tip_u_x") != 0
    with pytest.raises(pc.PericlesError, match="no table `x`; the run has: cracks"):
        memory.table("x")


def test_static_runs_in_memory_have_their_curve(plate):
    plate.update(
        constraint=[{"set": "left", "displacement": [0, 0]}, {"set": "right", "displacement": ["1 um", "free"]}],
        time={"scheme": "static", "load_steps": 4},
    )
    memory = pc.Deck.from_dict(plate).build().simulation().run().result()
    curve = memory.table("force_displacement")
    u, force = curve["right_displacement_x"], curve["right_force_x"]
    assert u == pytest.approx(np.linspace(0, 1e-6, len(u)))
    assert force[-1] > 0 and force == pytest.approx(force[-1] / u[-1] * u, rel=1e-3)


def test_tables_in_memory_go_on_from_a_checkpoint(plate):
    plate["probe"] = [{"name": "tip", "at": ["20 mm", "5 mm"]}]
    plate["initial"] = [{"set": "left", "velocity": [-5, 0]}]
    plate["output"] = {"history": {"every": 5}}
    model = pc.Deck.from_dict(plate).build()
    simulation = model.simulation()
    simulation.step(10)
    simulation.save("c.chk")
    whole = simulation.run().result()
    # Rows after the state that is loaded are computed again.
    simulation.load("c.chk")
    again = simulation.run().result()
    for name in ("history", "probes"):
        assert np.array_equal(again.table(name)["step"], whole.table(name)["step"])
        assert np.array_equal(again.table(name)["time"], whole.table(name)["time"])
    assert np.array_equal(again.table("probes")["tip_u_x"], whole.table("probes")["tip_u_x"])


def test_fields_are_exported(plate):
    plate["output"] = {"fields": {"count": 3}}
    result = pc.run(plate, out="a")
    with np.load(result.export("fields.npz")) as file:
        assert file["time"] == pytest.approx(result.times)
        assert np.array_equal(file["Displacement"][-1][:, :2], result["displacement"])
    assert result.export("fields.exo", every=2, fields=["damage"]).stat().st_size > 0
    assert "3 of 4" not in result.export("page.html").read_text()
    assert any(result.export("tables").glob("*.csv"))
    with pytest.raises(pc.OutputError, match="exists"):
        result.export("fields.npz")
    with pytest.raises(pc.PericlesError, match=r"the ending of x.png selects no format; allowed: exodus \(.exo\)"):
        result.export("x.png")
    with pytest.raises(pc.PericlesError, match='format = "pdf"'):
        result.export("x", format="pdf")


def test_plots_of_three_dimensional_bodies(plate, monkeypatch):
    pyplot = pytest.importorskip("matplotlib.pyplot")
    monkeypatch.setattr(pyplot, "show", lambda: None)
    block = {
        "body": {"shape": "block", "size": ["6 mm", "5 mm", "4 mm"], "spacing": "1 mm"},
        "material": plate["material"],
        "initial": [{"velocity": [{"expression": "100*y"}, 0, 0]}],
        "time": {"end": "1 us"},
    }
    result = pc.Deck.from_dict(block).build().simulation(keep=["displacement", "stress"], count=1).run().result()
    pyplot.figure()
    axes = result.plot("displacement", component="x", scale=0)
    [faces] = axes.collections
    # The outer faces of 6 × 5 × 4 cells, in mm.
    assert len(faces.get_array()) == 2 * (6 * 5 + 5 * 4 + 4 * 6)
    assert axes.get_xlim() == pytest.approx((0, 6)) and axes.get_zlim() == pytest.approx((0, 4))
    assert faces.get_array().max() == result["displacement"][:, 0].max()
    axes.figure.savefig("block.png")
    pyplot.figure()
    assert "xy" in result.plot("stress", component="xy").figure.axes[-1].get_ylabel()
    with pytest.raises(pc.PericlesError, match="allowed: xx, yy, zz, xy, yz, xz"):
        result.plot("stress", component="xw")
    pyplot.close("all")


def test_decks_with_steps(bar):
    pull = {"set": "right", "traction": ["1 MPa"]}
    bar.update(
        sets={"left": {"layer": {"side": "-x", "cells": 3}}, "right": {"layer": {"side": "+x", "cells": 3}}},
        constraint=[{"set": "left", "displacement": [0]}],
        output={"history": {"every": 1}},
        step=[
            {"name": "pull", "time": {"scheme": "static", "tolerance": 1e-8, "load_steps": 2}, "load": [pull]},
            {"name": "release", "time": {"end": "0.1 ms"}},
        ],
    )
    del bar["initial"], bar["time"]
    deck = pc.Deck.from_dict(bar)
    assert deck.steps == ["1-pull", "2-release"]
    result = pc.run(deck, out="a")
    assert [step.folder.name for step in result.steps] == deck.steps
    pulled, released = result.steps
    assert pulled.info.status == released.info.status == "finished" and pulled.steps == []
    # The stretched bar is released: its energy is that of the static state, part of which becomes kinetic.
    stored = pulled.history["elastic_energy"][-1]
    assert released.history["elastic_energy"][0] == pytest.approx(stored, rel=1e-9)
    assert released.history["kinetic_energy"].max() > 0.1 * stored
    rows = sum(len(step.history["time"]) for step in result.steps)
    assert rows - 1 <= len(pc.Result.open("a").history["time"]) <= rows
    with pytest.raises(pc.PericlesError, match="2 steps .*pericles.run"):
        deck.build()
    assert pc.run(deck).folder == Path("run")


def test_sweeps_go_on(bar):
    values = {"body.spacing": ["2 cm", "1 cm"], "material.horizon_ratio": [3, 4]}
    sweep = pc.sweep(bar, values, jobs=2, out="s")
    assert len(sweep) == 4 and "4 not run" in repr(sweep) and sweep.keys == list(values)
    points = list(sweep)
    assert [p.values["body.spacing"] for p in points] == ["2 cm", "2 cm", "1 cm", "1 cm"]
    assert [p.result.info.model.points for p in points] == [50, 50, 100, 100]
    written = [(p.result.folder / "run.json").stat().st_mtime_ns for p in points]
    again = list(pc.sweep(bar, values, out="s"))
    assert [(p.result.folder / "run.json").stat().st_mtime_ns for p in again] == written
    with pytest.raises(pc.DeckError):
        pc.sweep(bar, {"body.spacing": ["1 kg"]})
    for wrong in ({}, {"body.spacing": []}):
        with pytest.raises(pc.PericlesError, match="without values"):
            pc.sweep(bar, wrong)
    with pytest.raises(pc.PericlesError, match="jobs = 0"):
        pc.sweep(bar, values, jobs=0)
    # Further values: known runs are kept. Another deck: they are not.
    more = pc.sweep(bar, {**values, "body.spacing": ["1 cm", "5 mm"]}, out="s").run()
    assert (more[0].result.folder / "run.json").stat().st_mtime_ns == written[2]
    bar["material"]["density"] = 7000
    other = pc.sweep(bar, values, out="s").run()
    assert (other[3].result.folder / "run.json").stat().st_mtime_ns > written[3]
    Path("mine").mkdir()
    Path("mine/notes.txt").write_text("keep")
    with pytest.raises(pc.OutputError, match="mine"):
        pc.sweep(bar, values, out="mine")


def test_sweeps_are_tables(bar):
    pytest.importorskip("pandas")
    sweep = pc.sweep(bar, {"body.spacing": ["2 cm", "1 cm"], "time.scheme": ["rk4", "velocity-verlet"]}, out="s")
    frame = sweep.to_pandas()
    assert list(frame["body.spacing"]) == [0.02, 0.02, 0.01, 0.01] and list(frame["points"]) == [50, 50, 100, 100]
    assert list(frame["time.scheme"]) == ["rk4", "velocity-verlet"] * 2 and set(frame["status"]) == {"finished"}
    assert sweep.scalar("elastic_energy") == pytest.approx(frame["elastic_energy"])
    opened = pc.open("s")
    assert isinstance(opened, pc.Sweep) and [p.values for p in opened][1] == {"body.spacing": "2 cm", "time.scheme": "velocity-verlet"}
    assert opened.to_pandas().equals(frame)
    assert isinstance(pc.open("s/spacing=2_cm,scheme=rk4"), pc.Result)
    with pytest.raises(pc.OutputError, match="no sweep.json"):
        pc.Sweep.open("s/spacing=2_cm,scheme=rk4")


def test_sweeps_of_the_program_are_opened(bar):
    pc.Deck.from_dict(bar).write("bar.toml")
    command = [*program(), "run", "bar.toml", "--sweep", "material.horizon_ratio=3,4", "--out", "s", "--quiet"]
    assert subprocess.run(command, capture_output=True).returncode == 0
    points = list(pc.open("s"))
    assert [p.values for p in points] == [{"material.horizon_ratio": 3}, {"material.horizon_ratio": 4}]
    assert points[1].result.info.model.horizon == pytest.approx(0.04)
    # A sweep of the package is resumed by the program, which finds nothing to run.
    ours = pc.sweep(bar, {"material.horizon_ratio": [3, 4]}, out="ours").run()
    before = (ours[0].result.folder / "run.json").stat().st_mtime_ns
    assert subprocess.run([*program(), "resume", "ours", "--quiet"], capture_output=True).returncode == 0
    assert (ours[0].result.folder / "run.json").stat().st_mtime_ns == before


def test_a_failed_run_does_not_stop_a_sweep(bar):
    bar["time"] = {"end": "10 ms", "dt": "1 us", "allow_unstable": True}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        points = list(pc.sweep(bar, {"time.dt": ["5 us", "1 us"]}, out="s"))
    assert isinstance(points[0].error, pc.UnstableError) and points[0].error.step > 0
    assert points[1].error is None and points[1].result.info.status == "finished"


def test_leaving_a_sweep_stops_it(bar, capsys):
    bar["time"]["end"] = "50 ms"
    sweep = pc.sweep(bar, {"material.horizon_ratio": [2, 3, 4]}, jobs=1, out="s", progress=True)
    for point in sweep:
        assert point.values == {"material.horizon_ratio": 2}
        break
    states = [point.result.info.status if point.result else None for point in pc.open("s")]
    assert states[0] == "finished" and states[2] != "finished"
    assert [point.result.info.status for point in sweep] == ["finished"] * 3
    # The progress bar counts the runs.
    assert "3/3" in capsys.readouterr().err


def curve_of(deck):
    """Return the displacement of the end of a bar over time."""
    result = pc.Deck.from_dict(deck).build().simulation().run().result()
    return result.table("probes")["time"], result.table("probes")["end_u_x"]


def test_fits_find_known_values(bar):
    """A bar of 60 GPa and 3000 kg/m³ under a step load: stiffness and density follow from the oscillation of its end."""
    bar.update(
        material={"density": 2700, "youngs_modulus": "70 GPa", "horizon_ratio": 3},
        sets={"left": {"layer": {"side": "-x", "cells": 3}}, "right": {"layer": {"side": "+x", "cells": 3}}},
        constraint=[{"set": "left", "displacement": [0]}],
        load=[{"set": "right", "traction": ["1 MPa"]}],
        probe=[{"name": "end", "at": ["1 m"]}],
        time={"end": "0.5 ms"},
        output={"history": {"count": 100}},
    )
    del bar["initial"]
    bar["body"]["spacing"] = "5 cm"
    true = changed(bar, material={"density": 3000, "youngs_modulus": "60 GPa"})
    t, u = curve_of(true)
    keys = {"material.youngs_modulus": ("20 GPa", 200e9), "material.density": None}
    options = {"x": "time", "y": "end_u_x", "keys": keys, "tolerance": 1e-6}
    fit = pc.fit(bar, (t, u), **options, out="f")
    assert fit["material.youngs_modulus"].value == pytest.approx(60e9, rel=1e-4)
    assert fit["material.density"].value == pytest.approx(3000, rel=1e-4)
    low, high = fit["material.density"].interval
    assert low < 3000 < high and fit["material.density"].unit == "kg/m3" and fit["material.density"].start == 2700
    assert fit["material.youngs_modulus"].bounds == (20e9, 200e9)
    assert fit.converged and fit.misfit[1] < 1e-4 < fit.misfit[0] and fit.warnings == []
    assert fit.curve["fitted"] == pytest.approx(u, abs=1e-4 * np.abs(u).max()) and np.array_equal(fit.curve["measured"], u)
    assert fit.folder == Path("f") and (fit.folder / "fit.png").exists()
    assert "→ 60.0 GPa" in str(fit) and f"{fit.runs} runs" in str(fit)
    assert fit.result().scalar("end_u_x") == fit.curve["fitted"][-1]
    # The fitted deck, and curves in all forms.
    assert curve_of(fit.deck.to_dict())[1] == pytest.approx(u, abs=1e-4 * np.abs(u).max())
    table = pc.Deck.from_dict(true).build().simulation().run().result().table("probes")
    (Path("curve.csv")).write_text("time [s],end_u_x [m]\n" + "".join(f"{a!r},{b!r}\n" for a, b in zip(t.tolist(), u.tolist())))
    for curve in (table, table.to_pandas(), "curve.csv"):
        again = pc.fit(bar, curve, **options, jobs=2)
        assert again.changes == fit.changes
    assert list(fit.to_pandas().index) == list(fit) == list(keys)


def test_wrong_fits_are_rejected(bar):
    bar["probe"] = [{"name": "end", "at": ["1 m"]}]
    curve = ([0.0, 1e-4], [1.0, 2.0])
    with pytest.raises(pc.OutputError, match="folder of a fit"):
        Path("f").mkdir()
        Path("f/fit.json").write_text("{}")
        pc.open("f")
    for change, says in [
        ({"keys": []}, "at least one key"),
        ({"keys": ["material.colour"]}, "material.colour"),
        ({"keys": {"material.density": (1, 2)}}, "do not contain its value"),
        ({"curve": ([0.0], [1.0, 2.0])}, "equal length"),
        ({"curve": ([0.0, 1.0], ["a", "b"])}, "not numbers"),
        ({"curve": 3}, "curve is a int"),
        ({"curve": "none.csv"}, "none.csv"),
        ({"jobs": 0}, "jobs = 0"),
        ({"step": 2.0}, "step = 2.0"),
        ({"runs": 1}, "too few"),
        ({"x": "speed"}, "speed"),
    ]:
        arguments = {"curve": curve, "x": "time", "y": "end_u_x", "keys": ["material.density"], **change}
        with pytest.raises(pc.PericlesError, match=says):
            pc.fit(bar, arguments.pop("curve"), **arguments)
