"""Parameter sweeps."""

from __future__ import annotations

import contextlib
import itertools
import os
import queue
import sys
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from . import _pericles
from ._deck import _overrides, as_deck
from ._errors import OutputError, PericlesError, UnstableError
from ._problems import warn
from ._result import Result, optional

if TYPE_CHECKING:
    import numpy as np
    import pandas
    from numpy.typing import NDArray

    from ._types import DeckLike
else:
    from ._lazy import np


class SweepPoint(NamedTuple):
    """A run of a sweep.

    Attributes
    ----------
    values : dict
        The values of the keys.
    result : Result or None
        The results; None if the run has none.
    error : PericlesError or None
        The error of a failed run.
    """

    values: dict[str, Any]
    result: Result | None
    error: PericlesError | None = None


class Sweep:
    """A parameter sweep in its folder, made by :func:`sweep` or :func:`open`.

    Iterating over a sweep yields its runs in the order of the combinations. For a sweep made by :func:`sweep` it also runs
    them: several at once, and each is yielded when it and those before it have ended. Leaving the loop stops the runs in
    progress with a checkpoint; iterating again continues them.

    Examples
    --------
    >>> import pericles as pc
    >>> s = pc.sweep("a.toml", {"body.spacing": ["1 mm", "0.5 mm"]})  # doctest: +SKIP
    >>> for p in s:  # doctest: +SKIP
    ...     print(p.values, p.result.scalar("tip_u_x"))
    >>> s.to_pandas().plot("body.spacing", "elastic_energy")  # doctest: +SKIP
    """

    def __init__(self) -> None:
        raise TypeError("use pericles.sweep(deck, values) or pericles.open(folder)")

    @classmethod
    def _of(cls, core: _pericles.Sweep, folder: Path, values: list[dict[str, Any]], jobs: int | None, progress: bool, runs: bool) -> Sweep:
        made = cls.__new__(cls)
        made._core, made._folder, made._values = core, folder, values
        made._jobs, made._progress, made._runs = jobs, progress, runs
        made._errors = {}
        return made

    @classmethod
    def open(cls, folder: str | os.PathLike[str]) -> Sweep:
        """Open the folder of a sweep, also one of ``pericles run --sweep``; iterating then runs nothing."""
        found = opened(Path(folder))
        if found is None:
            raise OutputError(f"{os.fspath(folder)} is not the folder of a sweep: it has no sweep.json")
        return found

    _core: _pericles.Sweep
    _folder: Path
    _values: list[dict[str, Any]]
    _jobs: int | None
    _progress: bool
    #: Whether iterating runs what has not finished.
    _runs: bool
    _errors: dict[str, PericlesError]

    @property
    def folder(self) -> Path:
        """The folder of the sweep, with an output folder for each run."""
        return self._folder

    @property
    def keys(self) -> list[str]:
        """The keys of the deck whose values vary."""
        return list(self._core.keys())

    def __len__(self) -> int:
        return len(self._values)

    def __getitem__(self, number: int) -> SweepPoint:
        """Return a run, numbered from 0, as it is in its folder."""
        names = self._core.names()
        if not -len(names) <= number < len(names):
            raise IndexError(f"run {number} does not exist; there are {len(names)}")
        name = names[number]
        place = self._folder / name
        result = Result.open(place) if (place / "run.json").exists() else None
        return SweepPoint(self._values[number], result, self._errors.get(name))

    def __iter__(self) -> Iterator[SweepPoint]:
        if not self._runs:
            for number in range(len(self)):
                yield self[number]
            return
        places = {name: number for number, name in enumerate(self._core.names())}
        ends: queue.Queue[str | BaseException | None] = queue.Queue()

        def ended(name: str, error: PericlesError | None) -> None:
            if error is None:
                self._errors.pop(name, None)
            else:
                self._errors[name] = error
            ends.put(name)

        def drive() -> None:
            try:
                self._core.run(self._jobs, ended)
                ends.put(None)
            except BaseException as error:
                ends.put(error)

        thread = threading.Thread(target=drive, daemon=True)
        waiting: set[int] = set()
        first = 0
        with _bar(len(self), self._progress) as advance:
            thread.start()
            try:
                while first < len(self):
                    end = ends.get()
                    if isinstance(end, BaseException):
                        raise end
                    if end is None:
                        break
                    advance(end)
                    waiting.add(places[end])
                    while first in waiting:
                        point = self[first]
                        if isinstance(point.error, UnstableError):
                            point.error.result = point.result
                        if point.result is not None:
                            warn(point.result.warnings)
                        first += 1
                        yield point
            finally:
                # Repeated, because the thread may not have begun.
                while thread.is_alive():
                    self._core.stop()
                    thread.join(0.1)

    def run(self) -> Sweep:
        """Run all runs that have not finished; a failed run does not stop the others."""
        for _ in self:
            pass
        return self

    def scalar(self, name: str) -> NDArray[np.float64]:
        """Return a scalar of all runs as :meth:`Result.scalar` does; NaN for runs without results."""
        points = list(self)
        return np.array([np.nan if point.result is None else point.result.scalar(name) for point in points])

    def to_pandas(self) -> pandas.DataFrame:
        """Return a pandas DataFrame with a row for each run.

        Its columns are the name of the run, the values of the keys in SI units, the status, numbers of the run such as points
        and energies, and the last values of probes and quantities. Runs that have not finished are run before.
        """
        package = optional("pandas", "pandas")
        self.run()
        header, *rows = self._core.table()
        header = [name.split(" [")[0] for name in header]
        columns: dict[str, list[Any]] = {name: [row[place] for row in rows] for place, name in enumerate(header)}
        numbers = self._core.numbers()
        for place, name in enumerate(self.keys):
            values = [row[place] for row in numbers]
            if None not in values:
                columns[name] = values
        words = ("run", "status", *self.keys)
        for name, texts in columns.items():
            if name not in words:
                found = [_number(text) if text else float("nan") for text in texts]
                columns[name] = found if all(isinstance(value, int) for value in found) else [float(value) for value in found]
        frame: pandas.DataFrame = package.DataFrame(columns)
        return frame

    def __repr__(self) -> str:
        counts: dict[str, int] = {}
        for number in range(len(self)):
            result = self[number].result
            status = "not run" if result is None else result.info.status
            counts[status] = counts.get(status, 0) + 1
        states = ", ".join(f"{count} {status}" for status, count in counts.items())
        return f"<pericles.Sweep {self._folder}: {len(self)} runs over {', '.join(self.keys)}; {states}>"


def sweep(
    deck: DeckLike,
    values: Mapping[str, Sequence[Any]],
    *,
    jobs: int | None = None,
    out: str | os.PathLike[str] | None = None,
    progress: bool = False,
) -> Sweep:
    """Run a deck with all combinations of values of its keys.

    All combinations are checked at once; the runs begin when the sweep is iterated. A finished run in the folder is not
    repeated, so that a sweep that was interrupted continues. A failed run does not stop the others. The folder is that of
    ``pericles run --sweep``: :func:`open` and ``pericles resume`` accept it.

    Parameters
    ----------
    deck : Deck, dict or path
        The deck.
    values : mapping of str to sequence
        Keys with their values, such as ``{"body.spacing": ["1 mm", "0.5 mm"]}``.
    jobs : int, optional
        Runs at once at most, which share the cores. By default one per core, each on one thread.
    out : path, optional
        The folder of the sweep, with one output folder for each run; by default ``NAME-sweep`` in the current folder.
    progress : bool
        Show a progress bar (package tqdm), or a line for each run.

    Returns
    -------
    Sweep
        The sweep, which yields a :class:`SweepPoint` for each run.

    Examples
    --------
    >>> import pericles as pc
    >>> for p in pc.sweep("a.toml", {"body.spacing": ["1 mm", "0.5 mm"]}):  # doctest: +SKIP
    ...     print(p.values, p.result.scalar("tip_u_x"))
    """
    given = as_deck(deck)
    if jobs is not None and jobs < 1:
        raise PericlesError(f"jobs = {jobs}; allowed: at least 1")
    if not values or not all(len(of_key) for of_key in values.values()):
        raise PericlesError('values have no key or a key without values; give a list for each key, such as {"body.spacing": ["1 mm", "2 mm"]}')
    combinations = [dict(zip(values, chosen)) for chosen in itertools.product(*values.values())]
    for chosen in combinations:
        # Errors name the key of the dict.
        given.with_(chosen)._core()
    axes = [(key, [_overrides({key: value})[0].split("=", 1)[1] for value in of_key]) for key, of_key in values.items()]
    folder = Path(f"{given.stem}-sweep") if out is None else Path(out)
    core = _pericles.Sweep.begin(given._core(), axes, folder)
    return Sweep._of(core, folder, combinations, jobs, progress, True)


def opened(folder: Path) -> Sweep | None:
    """Open the sweep in a folder; None if the folder has no sweep."""
    core = _pericles.Sweep.open(folder)
    if core is None:
        return None
    keys = core.keys()
    values = [dict(zip(keys, map(_number, of_run))) for of_run in core.values()]
    return Sweep._of(core, folder, values, None, False, False)


def _number(text: str) -> int | float | str:
    for kind in (int, float):
        with contextlib.suppress(ValueError):
            return kind(text)
    return text


@contextlib.contextmanager
def _bar(count: int | None, progress: bool) -> Iterator[Callable[[str], object]]:
    """Return a function that shows that one more run has ended; ``count`` is the number of runs, if it is known."""
    if not progress:
        yield lambda _: None
        return
    try:
        from tqdm.auto import tqdm
    except ImportError:
        numbers = itertools.count(1)
        of = "" if count is None else f" of {count}"
        yield lambda name: print(f"run {next(numbers)}{of}: {name}".rstrip(": "), file=sys.stderr)
        return
    with tqdm(total=count, unit="run") as bar:
        yield lambda _: bar.update(1)
