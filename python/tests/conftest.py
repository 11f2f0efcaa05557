"""Decks and helpers of the tests."""

from __future__ import annotations

import copy
import os
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]

BAR = {
    "body": {"shape": "bar", "length": "1 m", "spacing": "1 cm"},
    "material": {"density": 7850, "youngs_modulus": "210 GPa", "horizon_ratio": 3},
    "time": {"end": "0.2 ms"},
}

PLATE = {
    "body": {"shape": "plate", "size": ["20 mm", "10 mm"], "spacing": "1 mm", "plane": "stress"},
    "material": {"density": 2440, "youngs_modulus": "72 GPa", "fracture_energy": "3.8 J/m2", "horizon_ratio": 3},
    "sets": {"left": {"layer": {"side": "-x", "cells": 1}}, "right": {"layer": {"side": "+x", "cells": 1}}},
    "time": {"end": "4 us"},
}


def changed(deck, **tables):
    """Return a copy of a deck with other tables."""
    deck = copy.deepcopy(deck)
    for name, table in tables.items():
        if isinstance(table, dict):
            deck.setdefault(name, {}).update(table)
        else:
            deck[name] = table
    return deck


@pytest.fixture
def bar():
    return changed(BAR, initial=[{"velocity": {"expression": "cos(pi*x)"}}])


@pytest.fixture
def plate():
    return changed(PLATE)


@pytest.fixture(autouse=True)
def _own_folder(tmp_path, monkeypatch):
    """Every test runs in a folder of its own."""
    monkeypatch.chdir(tmp_path)


def program():
    """The program as a command: given by the environment, or the one in the wheel."""
    given = os.environ.get("PERICLES_PROGRAM")
    return [given] if given else [sys.executable, "-m", "pericles"]
