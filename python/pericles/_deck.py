"""Decks."""

from __future__ import annotations

import copy
import json
import os
from collections.abc import Iterator, Mapping, MutableMapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _pericles, _toml
from ._check import Check, checked
from ._errors import DeckError, OutputError, PericlesError
from ._model import Model
from ._problems import located

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ._types import DeckLike


def _overrides(changes: Mapping[str, Any] | None) -> list[str]:
    """Return changes as the program takes them, ``key=value``."""
    out = []
    for key, value in (changes or {}).items():
        out.append(f"{key}={_toml.text(value, key)}")
    return out


class Deck(MutableMapping[str, Any]):
    """A deck: the description of a body, its material, its conditions and the run.

    A deck is a dict of tables with the keys of the deck reference. Numbers are in SI units, texts have units. It is
    checked when it is built, run, or by :meth:`check`.

    Examples
    --------
    >>> import pericles as pc
    >>> deck = pc.Deck.from_dict({
    ...     "body": {"shape": "bar", "length": "1 m", "spacing": "1 cm"},
    ...     "material": {"density": 7850, "youngs_modulus": "210 GPa", "horizon_ratio": 3},
    ...     "initial": [{"velocity": {"expression": "sin(pi*x)"}}],
    ...     "time": {"end": "1 ms"},
    ... })
    >>> deck["time"]["end"]
    '1 ms'
    >>> deck["body"]["spacing"] = 0.02
    >>> print(deck.to_toml().splitlines()[0])
    [body]
    """

    def __init__(self, tables: Mapping[str, Any], *, name: str = "<dict>") -> None:
        self._tables: dict[str, Any] | None = _toml.plain(tables)
        self._text: str | None = None
        self._name = name
        self._overrides: list[str] = []

    @classmethod
    def from_dict(cls, tables: Mapping[str, Any]) -> Deck:
        """Make a deck from a dict of tables.

        Parameters
        ----------
        tables : mapping
            The tables and keys of the deck; relative paths of files start at the current folder.
        """
        return cls(tables)

    @classmethod
    def from_toml(cls, text: str, *, name: str = "<text>") -> Deck:
        """Make a deck from TOML text; ``name`` is the file that messages name."""
        deck = cls.__new__(cls)
        deck._tables, deck._text, deck._name, deck._overrides = None, text, name, []
        return deck

    @classmethod
    def read(cls, path: str | os.PathLike[str], *, set: Mapping[str, Any] | None = None) -> Deck:
        """Read a deck from a file.

        Parameters
        ----------
        path : path
            The file.
        set : mapping, optional
            Values of keys that replace those in the file, such as ``{"time.end": "30 us"}``.
        """
        try:
            text = Path(path).read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise OutputError(f"cannot read the deck {os.fspath(path)}: {error}") from None
        deck = cls.from_toml(text, name=os.fspath(path))
        deck._overrides = _overrides(set)
        return deck

    @property
    def name(self) -> str:
        """The file of the deck, which messages name."""
        return self._name

    @property
    def stem(self) -> str:
        """The name of the file without folder and ending, from which names of output folders are made; ``run`` without a file."""
        return "run" if self._name.startswith("<") else Path(self._name).stem

    @property
    def steps(self) -> list[str]:
        """Names of the steps of a deck with ``[[step]]``; empty for other decks."""
        return list(self._core().steps())

    def _all(self) -> dict[str, Any]:
        """The tables; a text becomes a dict when it is first changed or looked into."""
        if self._tables is None:
            self._core()  # errors of syntax with their location
            self._tables = _toml.loads(self._text or "")
            for override in self._overrides:
                _apply(self._tables, override)
            self._source, self._text, self._overrides = self._text, None, []
        return self._tables

    def __getitem__(self, key: str) -> Any:
        return self._all()[key]

    def __setitem__(self, key: str, value: Any) -> None:
        self._all()[key] = _toml.plain(value, key)

    def __delitem__(self, key: str) -> None:
        del self._all()[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._all())

    def __len__(self) -> int:
        return len(self._all())

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Deck) and self.to_toml() == other.to_toml() and self._overrides == other._overrides

    __hash__ = None  # type: ignore[assignment]

    def copy(self) -> Deck:
        """Return a copy that can be changed independently."""
        return copy.deepcopy(self)

    def with_(self, changes: Mapping[str, Any]) -> Deck:
        """Return a copy with other values of keys, such as ``{"body.spacing": "0.5 mm"}``; ``"unset"`` removes a key."""
        deck = self.copy()
        overrides = _overrides(changes)
        if deck._tables is None:
            deck._overrides = deck._overrides + overrides
        else:
            for override in overrides:
                _apply(deck._tables, override)
        return deck

    def to_dict(self) -> dict[str, Any]:
        """Return a copy of the tables."""
        return copy.deepcopy(self._all())

    def to_toml(self) -> str:
        """Return the deck as TOML text, as :meth:`read` reads it."""
        if self._text is not None and not self._overrides:
            return self._text
        if self._text is not None:
            return _toml.dumps(self.copy()._all())
        return _toml.dumps(self._all())

    def write(self, path: str | os.PathLike[str]) -> None:
        """Write the deck to a file, which the program reads too."""
        Path(path).write_text(self.to_toml(), encoding="utf-8")

    def _core(self, sets: list[str] | None = None) -> _pericles.Deck:
        text = self._text if self._text is not None else _toml.dumps(self._tables or {})
        return parsed(text, self._name, self._overrides, sets or [])

    def values(self) -> dict[str, Any]:  # type: ignore[override]
        """Return all values in SI units, defaults included, as a dict of tables.

        Unlike the method of a dict it returns a dict: the deck as the reader understands it.
        """
        values: dict[str, Any] = json.loads(self._core().values())
        return values

    def check(self) -> Check:
        """Check the deck and report size, memory, time step and warnings, without running it.

        Raises
        ------
        DeckError
            The deck is invalid.
        """
        return checked(self)

    def build(
        self,
        *,
        points: ArrayLike | None = None,
        volumes: ArrayLike | None = None,
        blocks: ArrayLike | None = None,
        sets: Mapping[str, ArrayLike] | None = None,
    ) -> Model:
        """Build points, bonds and the time step.

        Warnings are issued when the model becomes a simulation, with all its conditions.

        Parameters
        ----------
        points : array of shape (n, dimension), optional
            Positions of the points, m; the deck's ``[body]`` then has no shape.
        volumes : array of shape (n,) or float, optional
            Volumes of the points, m³; by default the volumes of cells with the sides ``spacing``.
        blocks : array of int of shape (n,), optional
            Block numbers of the points, which sets of the deck may select (``block = 2``); by default 1.
        sets : mapping of str to mask or point numbers, optional
            Sets of points, in addition to those of the deck, which may refer to them.

        Returns
        -------
        Model
        """
        return Model(self, points=points, volumes=volumes, blocks=blocks, sets=sets)

    def __deepcopy__(self, memo: Any) -> Deck:
        deck = type(self).__new__(type(self))
        deck._tables = copy.deepcopy(self._tables, memo)
        deck._text, deck._name, deck._overrides = self._text, self._name, list(self._overrides)
        return deck

    def __str__(self) -> str:
        return self.to_toml()

    def __repr__(self) -> str:
        tables = ", ".join(self._all()) if self._tables is not None else f"{len((self._text or '').splitlines())} lines"
        return f"<pericles.Deck {self._name}: {tables}>"

    def _repr_html_(self) -> str:
        import html

        try:
            return self.check()._repr_html_()
        except DeckError as error:
            rows = "".join(f"<li>{html.escape(problem.text)}</li>" for problem in error.problems)
            return f'<b>{html.escape(self._name)}</b><ul style="color:#b00020">{rows}</ul>'


def _apply(tables: Any, override: str) -> None:
    """Apply an override, ``key=value``, to tables."""
    key, text = override.split("=", 1)
    path = key.strip().split(".")
    try:
        value = _toml.loads(f"x = {text}")["x"]
    except Exception:
        value = text.strip()
    unset = text.strip() == "unset"
    try:
        for step, following in zip(path[:-1], path[1:]):
            if isinstance(tables, list):
                tables = tables[int(step)]
            elif unset:
                tables = tables[step]
            else:
                tables = tables.setdefault(step, [] if following.isdigit() else {})
        last = path[-1]
        if unset:
            del tables[int(last) if isinstance(tables, list) else last]
        elif isinstance(tables, list) and int(last) == len(tables):
            tables.append(value)
        else:
            tables[int(last) if isinstance(tables, list) else last] = value
    except (AttributeError, IndexError, KeyError, TypeError, ValueError):
        raise PericlesError(f"the deck has no place for the key `{key.strip()}`") from None


def parsed(text: str, name: str, overrides: list[str], sets: list[str]) -> _pericles.Deck:
    """Parse a deck; problems name the keys of their lines."""
    try:
        return _pericles.Deck.parse(text, name, overrides, sets)
    except DeckError as error:
        located(error, text, name)
        raise


def as_deck(given: DeckLike, changes: Mapping[str, Any] | None = None) -> Deck:
    """Return a deck from a deck, a dict or a path."""
    if isinstance(given, Deck):
        return given.with_(changes) if changes else given
    if isinstance(given, Mapping):
        deck = Deck.from_dict(given)
        return deck.with_(changes) if changes else deck
    if not isinstance(given, (str, os.PathLike)):
        raise PericlesError(f"the deck is a {type(given).__name__}; allowed: a Deck, a dict of tables, or the path of a file")
    return Deck.read(given, set=changes)
