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
    # One call for each time that the scheme evaluates, from 0: velocity Verlet the ends of 50 steps, the others also their
    # middles. One more call checks the shape.
    assert len(set(calls)) == (51 if scheme == "velocity-verlet" else 101)
    assert len(calls) == len(set(calls)) + 1


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
    # No function is called at a negative time.
    earliest = []
    model = pc.Deck.from_dict(deck).build()
    model.prescribe("left", displacement=lambda t, x: earliest.append(t) or u(t, x), axes="x")
    model.simulation().step(3)
    assert min(earliest) == 0
    model = pc.Deck.from_dict(deck).build()
    model.prescribe("left", displacement=u, axes="x")
    # Numbers, expressions and free axes, as in a deck.
    fixed = pc.Deck.from_dict(deck).build()
    fixed.prescribe("left", displacement=[0, None])
    fixed.prescribe("right", velocity=[2.0, "free"])
    fixed.prescribe(np.array([105, 106]), displacement=np.array([[0.0, 0.0], [0.0, 1e-9]]), axes="y")
    moved = fixed.simulation(keep=["displacement"]).run().result().field("displacement")
    assert (moved[fixed.numbers("left"), 0] == 0).all() and moved[fixed.numbers("left"), 1].any()
    assert moved[fixed.numbers("right"), 0] == pytest.approx(2.0 * 4e-6, rel=1e-12)
    assert moved[[105, 106], 1].tolist() == [0.0, 1e-9] and moved[105, 0] != 0
    for wrong in ({}, {"displacement": [0]}, {"velocity": 2.0}, {"displacement": [0, 0], "velocity": u}):
        with pytest.raises(pc.PericlesError):
            fixed.prescribe("all", **wrong)
    with pytest.raises(pc.PericlesError, match="axes"):
        model.prescribe("left", displacement=u, axes="z")
    with pytest.raises(pc.DeckError):
        model.prescribe("left", displacement=u)
        model.simulation()


def test_prescribed_velocities_of_all_forms_agree():
    """A function, an array, a list and a text of the same velocity; the points start from their initial displacement."""
    deck = changed(PLATE, time={"end": "2 us", "dt": "20 ns"}, initial=[{"displacement": ["1 nm", 0]}])
    values = np.tile([5.0, 0.0], (10, 1))
    forms = {
        "list": lambda m: m.prescribe("left", velocity=["5 m/s", None]),
        "text": lambda m: m.prescribe("left", velocity="5 m/s", axes="x"),
        "number": lambda m: m.prescribe("left", velocity=5, axes="x"),
        "array": lambda m: m.prescribe("left", velocity=values, axes="x"),
        "function": lambda m: m.prescribe("left", velocity=lambda t, x: values, axes="x"),
    }
    moved = {name: run(deck, act) for name, act in forms.items()}
    left = pc.Deck.from_dict(deck).build().numbers("left")
    for name, u in moved.items():
        assert u[left, 0] == pytest.approx(1e-9 + 5 * 2e-6, rel=1e-12), name
        assert relative(u, moved["list"]) < 1e-12, name
    with pytest.raises(pc.PericlesError, match="give axes"):
        pc.Deck.from_dict(deck).build().prescribe("left", velocity="5 m/s")


@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_velocity_function_equals_the_integral(scheme):
    deck = changed(PLATE, time={"scheme": scheme, "end": "4 us", "dt": "40 ns"})
    a, w = 1e-6, 1e6
    expected = run(deck, lambda m: m.prescribe("left", displacement=[f"{a} * (1 - cos({w} * t))", "0"]))
    found = run(deck, lambda m: m.prescribe("left", velocity=lambda t, x: [a * w * np.sin(w * t), 0]))
    # Simpson's rule over 40 ns has the relative error (w dt)^4 / 2880, 1e-9; accelerations are differences of second order.
    assert relative(found, expected) < (1e-8 if scheme == "velocity-verlet" else 1e-3)
    # A cubic is integrated without an error.
    cubic = run(deck, lambda m: m.prescribe("left", velocity=lambda t, x: [t**3 * 1e18, 0]))
    left = pc.Deck.from_dict(deck).build().numbers("left")
    assert cubic[left, 0] == pytest.approx(1e18 * (4e-6) ** 4 / 4, rel=1e-12)


def test_a_velocity_function_goes_on_from_a_checkpoint():
    model = pc.Deck.from_dict(changed(PLATE, time={"dt": "40 ns"})).build()
    model.prescribe("left", velocity=lambda t, x: [np.cos(1e6 * t), 0])
    whole = model.simulation(keep=[]).run().field("displacement")
    first = model.simulation(keep=[])
    first.step(37)
    first.save("c.chk")
    second = model.simulation(keep=[])
    second.load("c.chk")
    assert np.array_equal(second.run().field("displacement"), whole)


def test_tractions_of_all_forms_agree():
    """A traction of 1 MPa on the right edge of a plate of 10 mm with the thickness 1 m in 10 cells of 1 mm: 1 GN/m³."""
    expected = run(PLATE, lambda m: m.load("right", body_force=[1e9, 0]))
    forms = [
        {"traction": ["1 MPa", 0]},
        {"traction": [1e6, None]},
        {"traction": ["1e6 + 0 * t", "0"]},
        {"traction": np.tile([1e6, 0.0], (10, 1)), "area": 0.01},
        {"traction": lambda t, x: [1e6, 0], "area": "100 cm2"},
        {"traction": ["0.5 MPa", 0], "area": 0.02},
    ]
    for form in forms:
        assert relative(run(PLATE, lambda m: m.load("right", **form)), expected) < 1e-12, form
    model = pc.Deck.from_dict(PLATE).build()
    for wrong, says in [
        ({}, "body_force or traction"),
        ({"traction": [1, 0], "body_force": [1, 0]}, "one of them"),
        ({"traction": lambda t, x: [1e6, 0]}, "needs the loaded area"),
        ({"body_force": [1, 0], "area": 1}, "belongs to a traction"),
        ({"traction": ["1 kg", 0]}, "traction"),
        ({"traction": np.ones((10, 2)), "area": "1 m"}, "area"),
    ]:
        with pytest.raises(pc.PericlesError, match=says):
            model.load("right", **wrong)


class Fragile:
    """A load that fails once, at the first time after a given one."""

    def __init__(self, after):
        self.after, self.error = after, KeyError("mine")

    def __call__(self, t, x):
        if t > self.after and self.error:
            raise self.error
        return [1e9, 0]


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("out", [None, "a"])
def test_a_step_with_an_error_of_a_function_is_undone(scheme, out):
    deck = changed(PLATE, time={"scheme": scheme, "end": "2 us", "dt": "40 ns"})
    whole = pc.Deck.from_dict(deck).build()
    whole.load("right", body_force=lambda t, x: [1e9, 0])
    expected = whole.simulation().run()
    model, force = pc.Deck.from_dict(deck).build(), Fragile(19.2 * 40e-9)
    model.load("right", body_force=force)
    simulation = model.simulation(out=out)
    for _ in range(2):
        with pytest.raises(KeyError, match="mine"):
            simulation.run()
        assert simulation.steps_done == 19
    # The state before the step is valid and can be used, and the run goes on from it when the function works.
    assert np.isfinite(simulation.field("displacement")).all()
    assert np.isfinite(simulation.energies["balance"])
    force.error = None
    simulation.run()
    assert simulation.steps_done == 50
    assert np.array_equal(simulation.field("displacement"), expected.field("displacement"))
    assert simulation.energies == expected.energies


def test_an_error_of_a_function_ends_its_own_run_only():
    model, force = pc.Deck.from_dict(changed(PLATE, time={"dt": "40 ns"})).build(), Fragile(1e-6)
    model.load("right", body_force=force)
    first, second = model.simulation(), model.simulation()
    with pytest.raises(KeyError):
        first.run()
    second.step(20)
    assert second.steps_done == 20
    # Those of the initial state, of wrong shapes and of values that are not numbers.
    model = pc.Deck.from_dict(PLATE).build()
    with pytest.raises(pc.PericlesError, match="needed"):
        model.load("right", body_force=lambda t, x: np.zeros((3, 3)))
    model.load("right", body_force=lambda t, x: [np.nan if t > 0 else 0, 0])
    simulation = model.simulation()
    with pytest.raises(pc.PericlesError, match="NaN"):
        simulation.run()
    assert simulation.steps_done == 0


def test_runs_with_functions_are_not_resumed_by_the_program(tmp_path):
    import subprocess

    from conftest import program

    model = pc.Deck.from_dict(changed(PLATE, time={"dt": "40 ns"})).build()
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
