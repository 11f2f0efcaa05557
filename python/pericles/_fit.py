"""Fits of decks to measured curves."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from . import _pericles, _toml
from ._deck import Deck, _overrides, as_deck
from ._errors import PericlesError
from ._problems import warn
from ._result import Result, Table
from ._sweep import _bar

if TYPE_CHECKING:
    import numpy as np
    import pandas
    from numpy.typing import ArrayLike

    from ._types import DeckLike
else:
    from ._lazy import np


class FittedValue(NamedTuple):
    """The fitted value of a key, in SI units.

    Attributes
    ----------
    value : float
        The fitted value.
    standard_error : float
        Its standard error; NaN if the curve does not determine the value.
    interval : pair of float
        The 95 % confidence interval.
    start : float
        The value of the deck, from which the fit started.
    bounds : pair of float
        The bounds.
    unit : str
        The SI unit; empty for dimensionless values.
    """

    value: float
    standard_error: float
    interval: tuple[float, float]
    start: float
    bounds: tuple[float, float]
    unit: str


class Fit(Mapping[str, FittedValue]):
    """The result of :func:`fit`: a mapping from the keys to their fitted values.

    Attributes
    ----------
    deck : Deck
        The deck with the fitted values.
    curve : Table
        The measured curve, that of the deck as given and the fitted one: the columns ``x``, ``measured``, ``start`` and
        ``fitted``.
    misfit : pair of float
        Root mean square of the differences before and after the fit, divided by the largest measured value.
    converged : bool
        Whether the values no longer change by more than the tolerance.
    runs : int
        Number of runs.
    warnings : list of str
        What limits the result: values at their bounds, keys that the curve does not determine, points beyond the run.
    folder : Path
        The folder with ``fit.csv``, ``curve.csv``, ``fit.png`` and the runs.
    """

    deck: Deck
    curve: Table
    misfit: tuple[float, float]
    converged: bool
    runs: int
    warnings: list[str]
    folder: Path

    def __init__(self, deck: Deck, found: Mapping[str, Any]) -> None:
        self._values = {
            key: FittedValue(value, error, (value - half, value + half), start, (low, high), unit)
            for key, unit, (start, value, error, half, low, high) in found["rows"]
        }
        self.deck = deck.with_(self.changes)
        self.folder = found["folder"]
        columns = _pericles.read_table(self.folder / "curve.csv")
        names = ("x", "measured", "start", "fitted")
        self.curve = Table([(name, unit, column) for name, (_, unit, column) in zip(names, columns)])
        self.misfit = (found["misfits"][0], found["misfits"][1])
        self.converged = found["converged"]
        self.runs = found["runs"]
        self.warnings = found["warnings"]
        self._lines = found["lines"]

    def __getitem__(self, key: str) -> FittedValue:
        try:
            return self._values[key]
        except KeyError:
            raise PericlesError(f"`{key}` was not fitted; fitted keys: {', '.join(self._values)}") from None

    def __contains__(self, key: object) -> bool:
        return key in self._values

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    @property
    def changes(self) -> dict[str, float]:
        """The fitted values as changes of a deck, such as for ``set`` of :func:`run`."""
        return {key: found.value for key, found in self._values.items()}

    def result(self) -> Result:
        """Return the results of the run whose values are the fitted ones."""
        wanted = _overrides(self.changes)
        for path in sorted(self.folder.glob("run-*")):
            if (path / "run.json").exists():
                found = Result.open(path)
                overrides = list((found.info.get("deck") or {}).get("overrides") or [])
                if _numbers(overrides[-len(wanted) :]) == _numbers(wanted):
                    return found
        raise PericlesError(f"{self.folder} has no run with the fitted values")

    def to_pandas(self) -> pandas.DataFrame:
        """Return a pandas DataFrame with a row for each key."""
        from ._result import optional

        package = optional("pandas", "pandas")
        rows = [{"key": key, **found._asdict()} for key, found in self._values.items()]
        frame: pandas.DataFrame = package.DataFrame(rows).set_index("key")
        return frame

    def __repr__(self) -> str:
        return "\n".join([*self._lines, *(f"warning: {text}" for text in self.warnings)])


def fit(
    deck: DeckLike,
    curve: str | os.PathLike[str] | Table | pandas.DataFrame | tuple[ArrayLike, ArrayLike],
    *,
    x: str,
    y: str,
    keys: Iterable[str] | Mapping[str, tuple[float | str, float | str] | None],
    set: Mapping[str, Any] | None = None,
    out: str | os.PathLike[str] | None = None,
    jobs: int | None = None,
    step: float = 0.01,
    tolerance: float = 0.001,
    runs: int = 60,
    progress: bool = False,
) -> Fit:
    """Fit keys of a deck to a measured curve by least squares, as ``pericles fit`` does.

    Parameters
    ----------
    deck : Deck, dict or path
        The deck. Its values are those from which the fit starts.
    curve : path, Table, DataFrame or pair of arrays
        The measured curve: a CSV table, a table with the columns ``x`` and ``y`` or with two columns, or the arrays (x, y).
        Files and tables may have units; other values are in SI units.
    x, y : str
        Columns of the tables of a run, such as ``"tip_u_x"`` and ``"grip_x"``.
    keys : sequence of str, or mapping of str to pair
        The keys, with optional lower and upper bounds in SI units or as texts with a unit, such as
        ``{"material.youngs_modulus": ("20 GPa", "40 GPa")}``. By default a tenth of the value of the deck and ten times it.
    set : mapping, optional
        Values of keys that replace those in the deck.
    out : path, optional
        The folder of the fit; by default ``NAME-fit`` in the current folder, with a number if it exists.
    jobs : int, optional
        Runs at once at most, which share the cores. By default one per core.
    step : float
        Relative change of a value for derivatives.
    tolerance : float
        The fit ends when no value changes by more than this fraction.
    runs : int
        The largest number of runs.
    progress : bool
        Show the number of runs so far.

    Returns
    -------
    Fit
    """
    given = as_deck(deck, set)
    if isinstance(keys, str):
        keys = [keys]
    bounds = keys if isinstance(keys, Mapping) else dict.fromkeys(keys)
    if not bounds:
        raise PericlesError('keys is empty; give at least one key, such as ["material.youngs_modulus"]')
    texts = [key if pair is None else f"{key}={_bound(pair[0], key)}:{_bound(pair[1], key)}" for key, pair in bounds.items()]
    if jobs is not None and jobs < 1:
        raise PericlesError(f"jobs = {jobs}; allowed: at least 1")
    for name, value in (("step", step), ("tolerance", tolerance)):
        if not 0 < value < 1:
            raise PericlesError(f"{name} = {value}; allowed: a number between 0 and 1")
    with tempfile.TemporaryDirectory(prefix="pericles-") as place, _bar(None, progress) as advance:
        path = _curve_file(curve, (x, y), Path(place))
        options = {
            "curve": path, "x": x, "y": y, "keys": texts,
            "step": float(step), "tolerance": float(tolerance), "runs": int(runs), "jobs": jobs,
        }
        stem = Path(f"{given.stem}-fit")
        found = _pericles.fit(given._core(), options, None if out is None else Path(out), stem, lambda: advance(""))
    made = Fit(given, found)
    warn(made.warnings)
    return made


def _bound(given: float | str, key: str) -> str:
    return _toml.text(given, key)


def _numbers(overrides: list[str]) -> list[tuple[str, float]]:
    pairs = (text.split("=", 1) for text in overrides)
    try:
        return [(key, float(value)) for key, value in pairs]
    except ValueError:
        return []


def _curve_file(curve: Any, names: tuple[str, str], folder: Path) -> Path:
    """Return the file of a curve; tables and arrays are written to one."""
    if isinstance(curve, (str, os.PathLike)):
        return Path(curve)
    units = ("", "")
    if isinstance(curve, tuple):
        if len(curve) != 2:
            raise PericlesError(f"the curve is a tuple of {len(curve)} entries; allowed: the pair (x, y)")
        columns = curve
    elif hasattr(curve, "columns") or isinstance(curve, Mapping):
        known = list(curve.columns) if hasattr(curve, "columns") else list(curve)
        chosen = names if all(name in known for name in names) else tuple(known)
        if len(chosen) != 2:
            raise PericlesError(f"the curve has no columns {names[0]} and {names[1]}; it has: {', '.join(map(str, known))}")
        columns = (curve[chosen[0]], curve[chosen[1]])
        if isinstance(curve, Table):
            units = (curve.units.get(chosen[0], ""), curve.units.get(chosen[1], ""))
    else:
        raise PericlesError(f"the curve is a {type(curve).__name__}; allowed: a path, a Table, a DataFrame, or a pair of arrays (x, y)")
    try:
        x, y = (np.asarray(column, dtype=float) for column in columns)
    except (TypeError, ValueError) as error:
        raise PericlesError(f"the values of the curve are not numbers: {error}") from None
    if x.ndim != 1 or x.shape != y.shape:
        raise PericlesError(f"the arrays of the curve have the shapes {x.shape} and {y.shape}; allowed: two lists of equal length")
    path = folder / "curve.csv"
    header = ",".join(f"{name} [{unit}]" if unit else name for name, unit in zip(names, units))
    rows = (f"{float(a)!r},{float(b)!r}" for a, b in zip(x, y))
    path.write_text("\n".join([header, *rows]) + "\n", encoding="utf-8")
    return path
