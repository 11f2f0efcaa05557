"""Loads and prescribed motions by arrays, expressions and functions."""

import numpy as np
import pytest
from conftest import PLATE, changed

import pericles as pc

SCHEMES = ["velocity-verlet", "rk4", "implicit-midpoint"]


def relative(a, b):
    return np.abs(a - b).max() / np.abs(b).max()


def run(deck, act):
    model = pc.Deck.from_dict(deck).build()
    act(model)
    return model.simulation(keep=["displacement"], count=2).run().result().field("displacement")


@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_function_equals_the_same_expression(scheme):
    deck = changed(PLATE, time={"scheme": scheme, "end": "2 us", "dt": "40 ns"})
    calls = []

    def force(t, x):
        calls.append(t)
        return np.c_[1e10 * np.sin(2e6 * t) * x[:, 1] / 0.01, -3e9 * np.cos(1e6 * t) + 0 * x[:, 0]]

    expected = run(deck, lambda m: m.load("right", body_force=["1e10 * sin(2e6 * t) * y / 0.01", "-3e9 * cos(1e6 * t)"]))
    found = run(deck, lambda m: m.load("right", body_force=force))
    assert np.abs(expected).max() > 1e-8
    assert relative(found, expected) < 1e-14
    # One call for each time that the scheme evaluates: steps, and stages between them.
    steps = 50
    stages = 2
    assert len(set(calls)) <= stages * steps + 4
    assert len(calls) <= len(set(calls)) + 4


def test_an_array_equals_the_same_vector():
    deck = changed(PLATE, load=[{"set": "right", "body_force": [1e9, 0]}])
    expected = pc.Deck.from_dict(deck).build().simulation().run().result().field("displacement")
    found = run(PLATE, lambda m: m.load("right", body_force=[1e9, 0]))
    assert relative(found, expected) < 1e-14
    mask = run(PLATE, lambda m: m.load(m.points[:, 0] > 0.019, body_force=np.tile([1e9, 0.0], (10, 1))))
    assert relative(mask, expected) < 1e-14


def test_loads_follow_the_order_of_the_points():
    """Listed points have another order inside; values belong to the rows of the array."""
    rng = np.random.default_rng(3)
    x = np.array([(a, b) for b in np.arange(10) for a in np.arange(20)]) * 1e-3
    x = x[rng.permutation(len(x))]
    deck = changed(PLATE)
    deck["body"] = {"spacing": "1 mm", "plane": "stress"}
    del deck["sets"]
    push = np.c_[1e10 * x[:, 0], -2e10 * x[:, 1]]
    chosen = x[:, 0] > 5e-3

    def displacement(act):
        model = pc.Deck.from_dict(deck).build(points=x)
        act(model)
        return model.simulation(keep=["displacement"]).run().result().field("displacement")

    a = displacement(lambda m: m.load(chosen, body_force=push[chosen]))
    b = displacement(lambda m: m.load(chosen, body_force=lambda t, p: np.c_[1e10 * p[:, 0], -2e10 * p[:, 1]]))
    c = displacement(lambda m: m.load(chosen, body_force=["1e10 * x", "-2e10 * y"]))
    assert relative(a, b) < 1e-13 and relative(a, c) < 1e-13 and np.abs(a).max() > 1e-9


def test_prescribed_motion_by_functions_and_expressions():
    deck = changed(PLATE, time={"end": "4 us", "dt": "20 ns"})
    a, w = 1e-6, 1e6

    def u(t, x):
        return [a * (1 - np.cos(w * t)), 0]

    def v(t, x):
        return [a * w * np.sin(w * t), 0]

    expected = run(deck, lambda m: m.prescribe("left", displacement=["1e-6 * (1 - cos(1e6 * t))", "0"]))
    exact = run(deck, lambda m: m.prescribe("left", displacement=u, velocity=v))
    differences = run(deck, lambda m: m.prescribe("left", displacement=u))
    assert relative(exact, expected) < 1e-4 and relative(differences, expected) < 1e-3
    model = pc.Deck.from_dict(deck).build()
    model.prescribe("left", displacement=u, axes="x")
    result = model.simulation(keep=["displacement"]).run().result()
    left = model.numbers("left")
    assert result.field("displacement")[left, 0] == pytest.approx(a * (1 - np.cos(w * 4e-6)), rel=1e-12)
    with pytest.raises(pc.PericlesError, match="axes"):
        model.prescribe("left", displacement=u, axes="z")
    with pytest.raises(pc.DeckError):
        model.prescribe("left", displacement=u)
        model.simulation()


def test_errors_of_functions_end_the_run():
    def fails(t, x):
        if t > 1e-6:
            raise KeyError("mine")
        return [1e9, 0]

    model = pc.Deck.from_dict(PLATE).build()
    model.load("right", body_force=fails)
    simulation = model.simulation()
    with pytest.raises(KeyError, match="mine"):
        simulation.run()
    with pytest.raises(pc.PericlesError, match="state is not valid"):
        simulation.run()
    model = pc.Deck.from_dict(PLATE).build()
    with pytest.raises(pc.PericlesError, match="needed"):
        model.load("right", body_force=lambda t, x: np.zeros((3, 3)))
    model.load("right", body_force=lambda t, x: [np.nan if t > 0 else 0, 0])
    with pytest.raises(pc.PericlesError, match="NaN"):
        model.simulation().run()


def test_runs_with_functions_are_not_resumed_by_the_program(tmp_path):
    import subprocess

    from conftest import program

    model = pc.Deck.from_dict(PLATE).build()
    model.load("right", body_force=lambda t, x: [1e9, 0])
    with model.simulation(out="a") as simulation:
        simulation.step(20)
        u = simulation.field("displacement")
        simulation.save("c.chk")
    done = subprocess.run([*program(), "resume", "a"], capture_output=True, text=True)
    assert done.returncode != 0 and "a load on `right`" in done.stderr
    # The same model goes on from the checkpoint, bit for bit.
    whole = model.simulation(keep=["displacement"]).run().result().field("displacement")
    resumed = model.simulation(keep=["displacement"])
    resumed.load("c.chk")
    assert resumed.steps_done == 20 and np.array_equal(resumed.field("displacement"), u)
    assert np.array_equal(resumed.run().result().field("displacement"), whole)
