"""Decks: dicts, texts, problems."""

import ast
import pickle
import re

import numpy as np
import pytest
from conftest import ROOT

import pericles as pc
from pericles import _toml

EXAMPLES = [path for path in sorted((ROOT / "examples").rglob("*.toml")) if path.name != "expected.toml"]


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_examples_survive_the_way_through_a_dict(path):
    tables = _toml.loads(path.read_text(encoding="utf-8"))
    assert _toml.loads(_toml.dumps(tables)) == tables
    deck = pc.Deck.read(path)
    again = pc.Deck(deck.to_dict(), name=deck.name)
    assert again.values() == deck.values()


def table_of_wrong_decks():
    """Return the tables of wrong decks of the deck crate: a text, a location, and words of the message."""
    tests = ROOT / "crates/pericles-deck/tests"
    text = (tests / "wrong.rs").read_text(encoding="utf-8")
    common = (tests / "common/mod.rs").read_text(encoding="utf-8")
    body = ast.literal_eval(re.search(r'const BODY: &str =\s*("(?:[^"\\]|\\.)*");', text).group(1))
    literal = r'("(?:[^"\\]|\\.)*"|BODY)'
    rows = re.compile(rf"^    wrong\({literal}, {literal}, \((\d+), (\d+)\), {literal}, &\[(.*?)\]\),$", re.M)
    for table, source, name in (("WRONG", text, "RIGHT"), ("WRONG_SURFACES", common, "SURFACE")):
        right = re.search(rf'const {name}: &str = r#"(.*?)"#;', source, re.S).group(1)
        inner = re.search(rf"const {table}: &\[Wrong\] = &\[\n(.*?)^\];", text, re.S | re.M).group(1)
        for number, row in enumerate(rows.finditer(inner)):
            old, new, excerpt = (body if part == "BODY" else ast.literal_eval(part) for part in row.group(1, 2, 5))
            words = [ast.literal_eval(word) for word in re.findall(r'"(?:[^"\\]|\\.)*"', row.group(6))]
            assert right.count(old) == 1
            place = (int(row.group(3)), int(row.group(4)))
            yield pytest.param(right.replace(old, new), place, excerpt, words, id=f"{table.lower()}-{number}")


TABLE = list(table_of_wrong_decks())


def test_the_table_of_wrong_decks_is_found():
    assert len(TABLE) > 250


@pytest.mark.parametrize("text, place, excerpt, words", TABLE)
def test_wrong_decks_have_the_messages_of_the_program(text, place, excerpt, words):
    with pytest.raises(pc.DeckError) as caught:
        pc.Deck.from_toml(text, name="deck.toml")._core()
    problems = caught.value.problems
    # As the table of the deck crate is read: one of the problems is at the place, and the messages contain the words.
    assert any((problem.line, problem.column) == place and problem.excerpt.startswith(excerpt) for problem in problems)
    for word in words:
        assert word in str(caught.value)
    try:
        tables = _toml.plain(_toml.loads(text))
    except (ValueError, pc.PericlesError):  # errors of syntax, and dates, which dicts do not have
        return
    with pytest.raises(pc.DeckError) as of_dict:
        pc.Deck.from_dict(tables)._core()
    # The generated text has other lines, and may quote values in another way.
    assert {problem.message for problem in of_dict.value.problems} == {problem.message for problem in problems}


WRONG = [
    ({"body": {"spacing": "0 mm"}}, "body.spacing"),
    ({"body": {"spacing": "1 kg"}}, "body.spacing"),
    ({"body": {"spcing": "1 mm"}}, "body.spcing"),
    ({"material": {"youngs_modulus": -1}}, "material.youngs_modulus"),
    ({"time": {"end": "1 m"}}, "time.end"),
    ({"load": [{"set": "nowhere", "body_force": [1]}]}, "load.0.set"),
    ({"load": [{"set": "all", "body_force": [{"expression": "sin("}]}]}, "load.0.body_force"),
    ({"initial": [{"velocity": [1, 2, 3, 4]}]}, "initial.0.velocity"),
]


@pytest.mark.parametrize("change, key", WRONG, ids=[key for _, key in WRONG])
def test_problems_are_located(bar, change, key):
    for table, entries in change.items():
        if isinstance(entries, dict):
            bar[table].update(entries)
        else:
            bar[table] = entries
    text = _toml.dumps(bar)
    with pytest.raises(pc.DeckError) as of_dict:
        pc.Deck.from_dict(bar).check()
    with pytest.raises(ValueError) as of_text:
        pc.Deck.from_toml(text, name="<dict>").check()
    assert str(of_dict.value) == str(of_text.value)
    problem = of_dict.value.problems[0]
    assert problem.path.startswith(key) and problem.file == "<dict>"
    assert text.splitlines()[problem.line - 1].strip()
    # Nobody has seen the generated text: the message names the key too.
    assert problem.text.startswith(f"<dict>:{problem.line}:{problem.column}: {problem.path}: ")
    assert problem.text in str(of_dict.value)
    assert pickle.loads(pickle.dumps(of_dict.value)).problems == of_dict.value.problems


def test_all_problems_are_reported(bar):
    bar["body"]["spacing"], bar["time"]["end"] = 0, "no"
    with pytest.raises(pc.DeckError) as caught:
        pc.Deck.from_dict(bar).build()
    assert [problem.path for problem in caught.value.problems] == ["body.spacing", "time.end"]


def test_overrides_name_their_key():
    path = next(path for path in EXAMPLES if "fracture" in str(path))
    with pytest.raises(pc.DeckError) as caught:
        pc.Deck.read(path, set={"time.end": "1 kg"}).check()
    assert caught.value.problems[0].path == "time.end"


def test_numpy_values_and_copies(bar):
    bar["body"]["spacing"] = np.float32(0.125)
    bar["material"]["density"] = np.int64(7850)
    bar["initial"] = [{"velocity": np.array([1.5])}]
    # The text of a `numpy.float64` is not that of a number.
    bar["material"]["youngs_modulus"] = np.float64(2.1e11)
    deck = pc.Deck.from_dict(bar)
    assert deck.values()["body"]["spacing"] == 0.125
    assert deck.values()["material"]["youngs_modulus"] == 2.1e11
    assert deck.with_({"time.end": np.float64(1e-4)}).values()["time"]["end"] == 1e-4
    assert "np." not in deck.with_({"load.0": {"set": "all", "body_force": [np.float64(1)]}}).to_toml()
    copy = deck.copy()
    copy["body"]["spacing"] = "1 cm"
    assert deck["body"]["spacing"] == 0.125
    finer = deck.with_({"body.spacing": "1 cm", "load.0": {"set": "all", "body_force": [1]}})
    assert finer["body"]["spacing"] == "1 cm" and finer.values()["body"]["spacing"] == 0.01
    assert pc.Deck.from_toml(finer.to_toml()).values()["load"] == finer.values()["load"] != []
    with pytest.raises(pc.PericlesError, match="load.7.set"):
        deck.with_({"load.7.set": "all"})
    assert "initial" not in finer.with_({"initial": "unset", "load.0": "unset"})
    with pytest.raises(pc.PericlesError, match="time.ratio"):
        deck.with_({"time.ratio": "unset"})
    assert pc.modes(finer, count=1).points.shape == (100, 1)
    assert pickle.loads(pickle.dumps(deck)) == deck
    with pytest.raises(pc.PericlesError, match="is a function"):
        pc.Deck.from_dict({"load": [{"body_force": lambda t: 1}]})
    with pytest.raises(pc.PericlesError, match="array with 2000 values"):
        pc.Deck.from_dict({"load": [{"body_force": np.zeros(2000)}]})


def test_warnings_are_python_warnings(bar):
    bar["material"]["horizon_ratio"] = 1.5
    model = pc.Deck.from_dict(bar).build()
    with pytest.warns(pc.PericlesWarning) as caught:
        simulation = model.simulation()
    assert [str(warning.message) for warning in caught] == simulation.warnings
    assert caught[0].filename == __file__
    with pytest.warns(pc.PericlesWarning) as caught:
        pc.run(bar)
    assert [str(warning.message) for warning in caught] == simulation.warnings
    assert caught[0].filename == __file__


def test_conditions_of_a_program_count_in_warnings(bar):
    del bar["initial"]
    model = pc.Deck.from_dict(bar).build()
    with pytest.warns(pc.PericlesWarning, match="nothing acts on the body"):
        model.simulation()
    model.load("all", body_force=lambda t, x: [1.0])
    assert model.simulation().warnings == []


def test_checks_and_shows(bar):
    deck = pc.Deck.from_dict(bar)
    found = deck.check()
    assert found.points == 100 and found.dt > 0
    assert "points" in deck._repr_html_() and "<pericles.Deck" in repr(deck)
    bar["body"]["spacing"] = 0
    assert "spacing" in pc.Deck.from_dict(bar)._repr_html_()


def test_decks_are_printed_as_toml(bar):
    deck = pc.Deck.from_dict(bar)
    assert str(deck) == deck.to_toml() and pc.Deck.from_toml(str(deck)).values() == deck.values()
    assert repr(deck).startswith("<pericles.Deck")


def test_errors_have_one_prefix(bar):
    """Neither the class nor the program puts `error:` in front of a message."""
    bar["body"]["spacing"] = "1 kg"
    wrong = pc.Deck.from_dict(bar)
    wrong.write("wrong.toml")
    calls = [
        wrong.build, wrong.check, lambda: pc.modes("wrong.toml"), lambda: pc.mesh("no.msh"), lambda: pc.reproduce("none"),
        lambda: pc.open("nowhere"), lambda: pc.Deck.read("no.toml"), lambda: pc.geodesics("cube(0)", 1.0),
        lambda: pc.check({**bar, "body": {"shape": "bar"}}),
    ]
    for call in calls:
        with pytest.raises(pc.PericlesError) as caught:
            call()
        message = str(caught.value)
        assert "error:" not in message.lower() and message.strip() == message and message, message
        assert type(caught.value).__module__ == "pericles"
