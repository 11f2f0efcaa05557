"""A script of a user that covers the surface of the package: it passes `mypy --strict`, and runs in an empty folder.

`assert_type` compares the types that mypy infers; `test_documents.py` checks that no public name is missing here.
"""

from __future__ import annotations

import webbrowser
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from typing_extensions import assert_type

import pericles as pc

Floats = NDArray[np.float64]


def deck_of_a_plate() -> pc.Deck:
    deck = pc.Deck.from_dict({
        "title": "Plate",
        "body": {"shape": "plate", "size": ["20 mm", "10 mm"], "spacing": "1 mm", "plane": "stress"},
        "material": {"density": 2440, "youngs_modulus": "72 GPa", "fracture_energy": "3.8 J/m2", "horizon_ratio": 3},
        "sets": {"left": {"layer": {"side": "-x", "cells": 1}}, "right": {"layer": {"side": "+x", "cells": 1}}},
        "probe": [{"name": "tip", "at": ["20 mm", "5 mm"]}],
        "output": {"fields": {"count": 2}, "history": {"count": 20}},
        "time": {"end": "2 us"},
    })
    deck["time"]["end"] = "1 us"
    assert_type(deck.copy(), pc.Deck)
    assert_type(deck.with_({"body.spacing": "2 mm"}), pc.Deck)
    assert_type(deck.name, str)
    assert_type(deck.stem, str)
    assert_type(deck.steps, list[str])
    assert_type(deck.to_toml(), str)
    deck.write("plate.toml")
    assert pc.Deck.read("plate.toml", set={"time.end": "1 us"}).to_dict() == deck.to_dict()
    assert pc.Deck.from_toml(str(deck)).values()["body"]["spacing"] == 1e-3
    check = deck.check()
    assert_type(check, pc.Check)
    assert_type(check.points, int)
    assert_type(check.dt, float)
    assert_type(pc.check("plate.toml"), pc.Check)
    return deck


def force(t: float, x: Floats) -> Floats:
    pulled: Floats = np.zeros_like(x)
    pulled[:, 0] = 1e9 * t / 1e-6
    return pulled


def model_of(deck: pc.Deck) -> pc.Model:
    model = deck.build(sets={"corner": [0, 1, 2]})
    assert_type(model, pc.Model)
    assert_type(model.points, Floats)
    assert_type(model.volumes, Floats)
    assert_type(model.dimension, int)
    assert_type(model.dt, float)
    assert_type(model.stable_step, "float | None")
    assert_type(model.sets, list[str])
    assert len(model.numbers("left")) == 10 and len(model) == model.facts["points"]
    assert isinstance(model.deck, pc.Deck)
    model.set_initial(velocity=lambda x: np.c_[10 * x[:, 0], 0 * x[:, 0]])
    model.set_initial(displacement=np.zeros((200, 2)))
    model.load("right", body_force=force)
    model.load("right", body_force=["1 GN/m3", "-1e9 * t"])
    model.load("right", traction=["1 MPa", None])
    model.load(model.points[:, 0] > 0.019, traction=lambda t, x: [1e6, 0], area=1e-2)
    model.prescribe("left", displacement=[0, None])
    model.prescribe("corner", velocity=0.0, axes="y")
    model.no_fail("all")
    return model


def simulate(model: pc.Model) -> pc.Result:
    with model.simulation(keep=["displacement", "damage", "stress"], count=4) as simulation:
        assert_type(simulation, pc.Simulation)

        @simulation.every(steps=2)
        def look(s: pc.Snapshot) -> object:
            assert_type(s.field("damage"), Floats)
            assert_type(s.energies, dict[str, float])
            return pc.STOP if s.broken_bonds > 10**6 or s.time > 1 or s.step > 10**6 else None

        simulation.step(2).save("state.chk")
        simulation.load("state.chk")
        simulation.run(progress=False)
        simulation.stop()
        assert_type(simulation.stop_reason, "str | None")
        assert_type(simulation.steps_done, int)
        assert_type(simulation.steps, int)
        assert_type(simulation.time, float)
        assert_type(simulation.dt, float)
        assert_type(simulation.broken_bonds, int)
        assert_type(simulation.energies, dict[str, float])
        assert_type(simulation.warnings, list[str])
        assert_type(simulation.field("displacement"), Floats)
        result = simulation.result()
        simulation.close()
    return result


def look_at(result: pc.Result) -> None:
    assert_type(result.field("displacement", time="1 us"), Floats)
    assert_type(result["damage"], Floats)
    assert_type(result.components("displacement"), list[str])
    assert_type(result.fields, list[str])
    assert_type(result.times, Floats)
    assert_type(result.points, Floats)
    assert_type(result.folder, "Path | None")
    assert_type(result.warnings, list[str])
    assert_type(result.steps, list[pc.Result])
    assert_type(result.info, pc.Info)
    assert_type(result.info.status, str)
    assert_type(result.audit, pc.Audit)
    assert_type(result.audit.balance, float)
    progress = pc.Progress(result.info["progress"])
    assert_type(progress.last_step, int)
    assert isinstance(result.info.model, pc.Record)
    assert_type(result.tables, list[str])
    assert_type(result.history, pc.Table)
    assert_type(result.table("probes")["tip_u_x"], Floats)
    assert_type(result.history.units, dict[str, str])
    assert_type(result.scalar("tip_u_x"), float)
    assert result.plot("damage", range=(0.0, 1.0)).get_xlabel() == "x (mm)"


def convert(result: pc.Result) -> None:
    assert len(result.history.to_pandas()) == len(result.history.to_polars())
    assert result.to_pyvista().n_cells == 200
    assert len(result.to_meshio().points) == 200
    assert_type(result.export("fields.npz"), Path)
    view = result.view(fields=["damage"])
    assert_type(view, pc.View)
    assert_type(view.path, Path)
    assert_type(view.notes, list[str])
    assert_type(view.open(), bool)


def study(deck: pc.Deck) -> None:
    sweep = pc.sweep(deck, {"body.spacing": ["2 mm", "1 mm"]}, jobs=1, out="sweep", progress=False)
    assert_type(sweep, pc.Sweep)
    for point in sweep:
        assert_type(point, pc.SweepPoint)
        assert_type(point.result, "pc.Result | None")
        assert_type(point.error, "pc.PericlesError | None")
    assert_type(sweep.run().scalar("kinetic_energy"), Floats)
    assert_type(sweep.folder, Path)
    assert_type(sweep.keys, list[str])
    assert len(sweep.to_pandas()) == len(sweep) == len(pc.Sweep.open("sweep"))
    bar: dict[str, object] = {
        "body": {"shape": "bar", "length": "1 m", "spacing": "10 cm"},
        "material": {"density": 2700, "youngs_modulus": "70 GPa", "horizon_ratio": 3},
        "initial": [{"velocity": {"expression": "cos(pi*x)"}}],
        "probe": [{"name": "end", "at": ["1 m"]}],
        "time": {"end": "0.2 ms"},
    }
    probes = pc.run(bar, set={"material.density": 3000}, out="bar").table("probes")
    fit = pc.fit(bar, probes, x="time", y="end_u_x", keys=["material.density"], out="fit")
    assert_type(fit, pc.Fit)
    assert_type(fit["material.density"], pc.FittedValue)
    assert_type(fit["material.density"].interval, tuple[float, float])
    assert_type(fit.changes, dict[str, float])
    assert_type(fit.deck, pc.Deck)
    assert_type(fit.curve, pc.Table)
    assert_type(fit.converged, bool)
    assert_type(fit.result(), pc.Result)
    assert len(fit.to_pandas()) == 1
    modes = pc.modes(bar, count=2)
    assert_type(modes, pc.Modes)
    assert_type(modes.frequencies, Floats)
    dispersion = pc.dispersion(bar)
    assert_type(dispersion, pc.Dispersion)
    assert_type(dispersion.curves, pc.Table)


def compare(deck: pc.Deck) -> None:
    first = pc.run(deck, out="a")
    second = pc.open("a")
    assert isinstance(second, pc.Result) and pc.Result.open("a").info.title == "Plate"
    difference = pc.diff(first, second, tolerance=1e-9)
    assert_type(difference, pc.Difference)
    assert_type(difference.identical, bool)
    assert_type(difference.equal, bool)
    assert_type(difference.rows, list[pc.Record])
    assert_type(pc.geodesics("icosphere(1)", 1.5), pc.Report)
    look_at(first)
    convert(first)


def passes(study: pc.Reproduction) -> bool:
    return study.passed


def fail(deck: pc.Deck) -> None:
    try:
        deck.with_({"time.end": "1 kg"}).check()
    except pc.DeckError as error:
        problem = error.problems[0]
        assert_type(problem, pc.Problem)
        assert_type(problem.path, "str | None")
    try:
        pc.mesh("none.msh")
    except (pc.UnstableError, pc.TooLargeError) as error:
        raise AssertionError from error
    except (pc.OutputError, pc.PericlesError) as error:
        assert str(error)
    assert issubclass(pc.PericlesWarning, UserWarning)


def main() -> None:
    setattr(webbrowser, "open", lambda address: True)
    pc.set_threads(1)
    deck = deck_of_a_plate()
    look_at(simulate(model_of(deck)))
    compare(deck)
    study(deck)
    fail(deck)
    print(pc.__version__, pc.reproduce.__name__, passes.__name__)


if __name__ == "__main__":
    main()
