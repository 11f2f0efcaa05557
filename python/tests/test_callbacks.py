"""Callbacks."""

import numpy as np
import pytest
from conftest import PLATE, changed

import pericles as pc


@pytest.fixture
def model():
    model = pc.Deck.from_dict(changed(PLATE, time={"end": "4 us", "dt": "40 ns"})).build()
    model.set_initial(velocity=lambda x: np.c_[4e4 * (x[:, 0] - 0.01), 0 * x[:, 0]])
    return model


@pytest.mark.parametrize("out", [None, "a"])
def test_schedules(model, out):
    simulation = model.simulation(out=out)
    seen = {"steps": [], "time": [], "count": []}
    simulation.every(steps=30)(lambda s: seen["steps"].append(s.step))
    simulation.every(time=1e-6)(lambda s: seen["time"].append(s.step))
    simulation.every(count=4)(lambda s: seen["count"].append(s.step))
    simulation.run()
    assert seen == {"steps": [0, 30, 60, 90, 100], "time": [0, 25, 50, 75, 100], "count": [0, 25, 50, 75, 100]}
    for wrong in ({}, {"steps": 1, "time": 1.0}, {"steps": 0}, {"time": -1.0}):
        with pytest.raises(pc.PericlesError):
            simulation.every(**wrong)(print)


def test_snapshots(model):
    simulation = model.simulation(keep=["velocity"], every=1)
    seen = []

    @simulation.every(steps=50)
    def look(s):
        v = s.field("velocity")
        # A copy: writing it changes nothing.
        kept = v.copy()
        v[:] = 0
        kinetic = 0.5 * 2440 * (model.volumes[:, None] * kept**2).sum()
        assert s.energies["kinetic_energy"] == pytest.approx(kinetic, rel=1e-12)
        assert s.time == pytest.approx(s.step * simulation.dt)
        seen.append((s, kept))

    result = simulation.run().result()
    for snapshot, v in seen:
        assert np.array_equal(v, result.field("velocity", output=snapshot.step))
        assert "step" in repr(snapshot)
        with pytest.raises(pc.PericlesError, match="ends with its callback"):
            snapshot.field("velocity")
    assert look.__name__ == "look"


@pytest.mark.parametrize("out", [None, "a"])
def test_stop_at_first_breakage(model, out):
    simulation = model.simulation(out=out)

    @simulation.every(steps=1)
    def first(s):
        if s.broken_bonds:
            return pc.STOP

    simulation.run()
    step = simulation.steps_done
    assert 0 < step < simulation.steps and simulation.broken_bonds > 0
    assert simulation.result().info.status == "stopped"
    assert simulation.stop_reason.startswith("a callback returned STOP at t = ")
    # The same object goes on.
    simulation.step(1)
    assert simulation.steps_done == step + 1


def test_conditions_of_the_deck_stop_a_run_in_memory(model):
    deck = model.deck.with_({"time.stop_when.0": {"condition": "broken_bonds > 0"}})
    stopped = deck.build()
    stopped.set_initial(velocity=lambda x: np.c_[4e4 * (x[:, 0] - 0.01), 0 * x[:, 0]])
    simulation = stopped.simulation().run()
    info = simulation.result().info
    assert info.status == "finished" and simulation.steps_done < simulation.steps
    assert "broken_bonds" in info.stop_reason and info.stop_reason == simulation.stop_reason


def test_errors_keep_their_type_and_the_simulation(model):
    simulation = model.simulation()
    calls = []

    class Mine(Exception):
        pass

    @simulation.every(steps=10)
    def fail(s):
        calls.append(s.step)
        if s.step == 20 and len(calls) == 3:
            raise Mine(s.step)

    with pytest.raises(Mine) as caught:
        simulation.run()
    assert caught.value.args == (20,)
    assert any(entry.name == "fail" for entry in caught.traceback)
    simulation.run()
    assert simulation.steps_done == 100
    whole = model.simulation(keep=["velocity"]).run()
    assert np.array_equal(simulation.field("velocity"), whole.field("velocity"))


def test_callbacks_and_other_runs(model):
    simulation, other = model.simulation(), model.simulation()

    @simulation.every(count=1)
    def nested(s):
        with pytest.raises(pc.PericlesError, match="running"):
            simulation.step(1)
        other.run()

    simulation.run()
    assert other.steps_done == simulation.steps_done == 100


def test_steps_and_runs_agree(model):
    a, b = model.simulation(), model.simulation()
    a.run()
    while b.steps_done < b.steps:
        b.step(7)
    assert np.array_equal(a.field("displacement"), b.field("displacement"))
