"""Arrays in: points, sets, initial fields."""

import gc

import numpy as np
import pytest
from conftest import PLATE, changed

import pericles as pc


def cells(shape=(20, 10), spacing=1e-3):
    """Return the centres of the cells of the plate, in the order of its grid: x fastest."""
    x, y = (spacing * (np.arange(n) + 0.5) for n in shape)
    return np.array([(a, b) for b in y for a in x])


def own_deck(**tables):
    deck = changed(PLATE, **tables)
    deck["body"] = {"spacing": "1 mm", "plane": "stress"}
    del deck["sets"]
    return deck


@pytest.fixture
def stretched():
    return changed(PLATE, initial=[{"velocity": [{"expression": "1e3*x"}, 0]}])


def test_own_points_equal_those_of_a_grid():
    """The same points, listed: forces differ by the order of sums only. The critical stretch of a lattice follows from its crack
    planes, so that bonds must not break."""
    x = cells()
    rng = np.random.default_rng(1)
    order = rng.permutation(len(x))
    v0 = np.c_[np.sin(200 * x[:, 0]), 0 * x[:, 0]]
    grid = pc.Deck.from_dict(changed(PLATE, material={"bonds": "list"}, time={"dt": "40 ns"})).build()
    # The order of a grid is its own; match the points by position.
    place = {tuple(np.round(p * 1e6).astype(int)): i for i, p in enumerate(grid.points)}
    match = np.array([place[tuple(np.round(p * 1e6).astype(int))] for p in x])
    velocity = np.empty_like(v0)
    velocity[match] = v0
    grid.set_initial(velocity=velocity)
    own = pc.Deck.from_dict(own_deck(time={"dt": "40 ns"})).build(points=x[order], volumes=np.full(len(x), 1e-6))
    own.set_initial(velocity=v0[order])
    assert np.array_equal(own.points, x[order])
    assert own.facts["bonds"] == grid.facts["bonds"]
    runs = [model.simulation().run() for model in (grid, own)]
    a, b = (run.result().field("displacement") for run in runs)
    assert [run.broken_bonds for run in runs] == [0, 0]
    assert np.abs(a[match][order] - b).max() < 1e-9 * np.abs(a).max()
    assert np.abs(a).max() > 1e-7


def test_volumes_have_a_default():
    deck = own_deck()
    deck["body"]["thickness"] = "2 mm"
    model = pc.Deck.from_dict(deck).build(points=cells())
    assert model.volumes == pytest.approx(np.full(200, 1e-6 * 2e-3))
    del deck["body"]["spacing"]
    with pytest.raises(pc.PericlesError, match="volumes"):
        pc.Deck.from_dict(deck).build(points=cells())


def test_sets_blocks_and_materials():
    x = cells()
    inside = np.hypot(x[:, 0] - 0.01, x[:, 1] - 0.005) < 0.003
    deck = own_deck(
        materials={"hard": {"density": 4000, "youngs_modulus": "400 GPa", "fracture_energy": "20 J/m2"}},
        assign=[{"set": "inclusion", "material": "hard"}],
        sets={"second": {"block": 2}},
    )
    deck["sets"] = {"second": {"block": 2}}
    model = pc.Deck.from_dict(deck).build(points=x, blocks=np.where(x[:, 1] > 0.005, 2, 1), sets={"inclusion": inside, "ends": [0, 199]})
    assert model.sets == ["all", "second", "inclusion", "ends"]
    assert np.array_equal(model.numbers("inclusion"), np.flatnonzero(inside))
    assert np.array_equal(model.numbers("second"), np.flatnonzero(x[:, 1] > 0.005))
    assert model.numbers("ends").tolist() == [0, 199]
    with pytest.raises(pc.PericlesError, match="has no points"):
        pc.Deck.from_dict(deck).build(points=x, sets={"inclusion": np.zeros(200, bool)})
    with pytest.raises(pc.PericlesError, match="shape"):
        pc.Deck.from_dict(deck).build(points=x, sets={"inclusion": np.zeros(7, bool)})
    with pytest.raises(pc.PericlesError, match="already"):
        pc.Deck.from_dict(deck).build(points=x, sets={"second": [1], "inclusion": inside})
    with pytest.raises(pc.DeckError, match="inclusion"):
        pc.Deck.from_dict(deck).build(points=x)


@pytest.mark.parametrize(
    "given",
    [
        lambda v: v.tolist(),
        lambda v: v.astype(np.float32).astype(float),
        lambda v: np.asfortranarray(v),
        lambda v: np.repeat(v, 2, axis=0)[::2],
        lambda v: v.T.copy().T,
    ],
    ids=["list", "float32", "fortran", "strided", "transposed"],
)
def test_arrays_of_any_kind(given):
    deck = pc.Deck.from_dict(PLATE)
    model = deck.build()
    v = np.round(np.c_[model.points[:, 1], -model.points[:, 0]] * 2**20) / 2**10
    model.set_initial(velocity=given(v))
    result = model.simulation(keep=["velocity"]).run().result()
    assert np.array_equal(result.field("velocity", output=0), v)


def test_wrong_arrays_show_the_shape_needed():
    model = pc.Deck.from_dict(PLATE).build()
    cases = [
        (np.zeros((3, 2)), r"\(3, 2\); needed: \(200, 2\)"),
        (np.zeros((200, 3)), r"\(200, 3\); needed: \(200, 2\)"),
        (np.zeros((0, 2)), "needed"),
        (np.full((200, 2), np.nan), "NaN"),
        ("fast", "not numbers"),
    ]
    for array, says in cases:
        with pytest.raises(pc.PericlesError, match=says):
            model.set_initial(velocity=array)
    for points in (np.zeros((0, 2)), np.zeros((4, 4)), [[0, np.inf]]):
        with pytest.raises(pc.PericlesError):
            pc.Deck.from_dict(own_deck()).build(points=points)


def test_results_are_views_that_keep_their_owner(stretched):
    simulation = pc.Deck.from_dict(stretched).build().simulation(keep=["displacement", "damage"], count=2)
    u = simulation.run().result().field("displacement")
    again = simulation.result().field("displacement")
    assert u.__array_interface__["data"] == again.__array_interface__["data"]
    assert not u.flags.writeable and not u.flags.owndata
    before = u.copy()
    del simulation, again
    gc.collect()
    np.zeros(10**6)
    assert np.array_equal(u, before)
    with pytest.raises(ValueError):
        u[0] = 1


def test_initial_functions_and_no_fail():
    deck = changed(PLATE, time={"end": "2 us"})
    a, b = pc.Deck.from_dict(deck).build(), pc.Deck.from_dict(deck).build()
    a.set_initial(velocity=lambda x: np.c_[4e4 * (x[:, 0] - 0.01), 0 * x[:, 0]])
    b.set_initial(velocity=np.c_[4e4 * (b.points[:, 0] - 0.01), 0 * b.points[:, 0]])
    broken = a.simulation().run().broken_bonds
    assert broken > 0
    b.no_fail("all")
    assert b.simulation().run().broken_bonds == 0
    # A part excluded from failure stays whole.
    part = a.points[:, 0] < 0.012
    a.no_fail(part)
    damage = a.simulation().run().result().field("damage")
    assert damage[a.points[:, 0] < 0.01].max() == 0 and damage.max() > 0
    assert a.simulation().run().broken_bonds > 0
