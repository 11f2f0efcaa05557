"""Checks of decks by the program."""

from __future__ import annotations

import contextlib
import os
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _toml
from ._cli import call
from ._html import table_html
from ._result import Record

if TYPE_CHECKING:
    import numpy as np

    from ._deck import Deck
else:
    from ._lazy import np


class Report(Record):
    """Results of a command of the program; entries are also attributes, lists of numbers are arrays."""

    def __getitem__(self, name: str) -> Any:
        value = super().__getitem__(name)
        if isinstance(value, list) and value and all(isinstance(entry, (int, float)) for entry in value):
            return np.array(value)
        if isinstance(value, list):
            return [Record(entry) if isinstance(entry, dict) else entry for entry in value]
        return value

    def _repr_html_(self) -> str:
        return table_html(type(self).__name__, self._entries)


class Check(Report):
    """What a run of a deck needs: size, memory, time step, estimated run time, and warnings. :class:`Report` has further
    entries.

    Attributes
    ----------
    points, bonds, steps, dimension : int
        Size of the body and of the run.
    dt, stable_step, end : float
        The time step, its bound, and the end of the run, s.
    horizon, spacing : float
        Horizon and spacing, m.
    memory_estimate : float
        Memory of the run, bytes.
    run_seconds : float
        Estimated run time, s.
    warnings : list of str
        Warnings about the model.
    """

    points: int
    bonds: int
    steps: int
    dimension: int
    dt: float
    stable_step: float | None
    end: float
    horizon: float
    spacing: float
    memory_estimate: float
    run_seconds: float
    warnings: list[str]


def temporary() -> tempfile.TemporaryDirectory[str]:
    """Return a temporary folder."""
    return tempfile.TemporaryDirectory(prefix="pericles-")


@contextlib.contextmanager
def file_of(deck: Deck) -> Iterator[list[str]]:
    """Return the arguments that give a deck to the program: its file, or a copy with absolute paths."""
    if deck._text is not None and os.path.exists(deck.name):
        yield [deck.name, *(word for override in deck._overrides for word in ("--set", override))]
        return
    tables = deck.to_dict()
    folder = Path(deck.name).parent if deck._text is not None or os.path.exists(deck.name) else Path()
    _absolute(tables, folder)
    with temporary() as place:
        path = Path(place) / "deck.toml"
        path.write_text(_toml.dumps(tables), encoding="utf-8")
        yield [str(path)]


def _absolute(tables: Any, folder: Path) -> None:
    for key, value in tables.items() if isinstance(tables, dict) else enumerate(tables):
        if isinstance(value, (dict, list)):
            _absolute(value, folder)
        elif key == "file" and isinstance(value, str) and (folder / value).exists():
            tables[key] = str((folder / value).absolute())


def checked(deck: Deck) -> Check:
    """Check a deck and return what its run needs."""
    deck._core()
    with file_of(deck) as arguments:
        found = call("check", *arguments)
        return Check(renamed(found, arguments[0], deck.name))


def renamed(value: Any, file: str, name: str) -> Any:
    """Return results in which the name of a deck replaces its temporary file."""
    if isinstance(value, dict):
        return {key: renamed(entry, file, name) for key, entry in value.items()}
    if isinstance(value, list):
        return [renamed(entry, file, name) for entry in value]
    return value.replace(file, name) if isinstance(value, str) else value
