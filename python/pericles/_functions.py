"""What the program offers besides runs."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _pericles
from ._check import Check, Report, checked, file_of, renamed, temporary
from ._cli import call, execute
from ._deck import Deck, as_deck
from ._errors import PericlesError
from ._model import Model
from ._problems import warn
from ._result import Record, Result, Table
from ._simulation import Simulation
from ._sweep import Sweep, opened

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ._types import Changes, DeckLike
else:
    from ._lazy import np


class Dispersion(Report):
    """Numerical dispersion and stability of a lattice.

    Attributes
    ----------
    curves : Table
        Frequencies along the contour of wave vectors.
    polar : Table or None
        Wave speeds in the long-wave limit by direction.
    """

    curves: Table
    polar: Table | None


class Modes(Report):
    """Natural modes.

    Attributes
    ----------
    frequencies : array of shape (m,)
        Frequencies of the modes, Hz, ascending.
    shapes : array of shape (m, n, dimension)
        Mode shapes with the largest displacement 1.
    points : array of shape (n, dimension)
        Positions of the points, m.
    """

    frequencies: NDArray[np.float64]
    shapes: NDArray[np.float64]
    points: NDArray[np.float64]


class Reproduction(Report):
    """A reproduced study; ``passed`` says whether all judged rows pass."""

    @property
    def passed(self) -> bool:
        """Whether all judged rows pass."""
        return bool(self["pass"])


class Difference(Report):
    """The comparison of two results.

    Attributes
    ----------
    equal : bool
        Whether all values agree within the tolerance and nothing is missing.
    rows : list of Record
        The differences of fields and columns.
    """

    equal: bool
    rows: list[Record]

    def __bool__(self) -> bool:
        raise PericlesError("use `.equal` (within the tolerance) or `.identical` (bitwise)")

    @property
    def identical(self) -> bool:
        """Whether all compared values are bitwise equal and nothing is missing."""
        return bool(self.equal) and all(row["different"] == 0 for row in self._entries["rows"])


def check(deck: DeckLike, *, set: Changes | None = None) -> Check:
    """Check a deck and report what its run needs, without running it.

    Parameters
    ----------
    deck : Deck, dict or path
        The deck.
    set : mapping, optional
        Values of keys that replace those in the deck.

    Raises
    ------
    DeckError
        The deck is invalid.
    """
    return checked(as_deck(deck, set))


def modes(deck: DeckLike, *, count: int = 12, prestress: bool = False, set: Changes | None = None) -> Modes:
    """Compute the lowest natural frequencies and mode shapes of a body.

    Parameters
    ----------
    deck : Deck, dict or path
        The deck.
    count : int
        Number of modes.
    prestress : bool
        About the last static state of the deck instead of the undeformed body.
    set : mapping, optional
        Values of keys that replace those in the deck.
    """
    deck = as_deck(deck, set)
    dimension = _dimension(deck)
    with file_of(deck) as arguments, temporary() as place:
        out = Path(place) / "modes"
        flags = ["--prestress"] if prestress else []
        found = Modes(call("modes", *arguments, "--count", str(count), "--out", out, "--quiet", *flags))
        files = [_pericles.OutputFile(path) for path in sorted((out / "modes").glob("mode_*.vtu"))]
        def of(file: Any, name: str) -> Any:
            return file.field(name)[:, :dimension]

        found.shapes = np.array([of(file, "Mode_Shape") for file in files])
        found.points = of(files[0], "Points") if files else np.zeros((0, dimension))
        found.frequencies = _pericles_column(out / "modes.csv", "frequency")
    return found


def _pericles_column(path: Path, stem: str) -> NDArray[np.float64]:
    columns = _pericles.read_table(path)
    return next(values for name, _, values in columns if name.startswith(stem))


def _dimension(deck: Deck) -> int:
    body = deck.values()["body"]
    if "dimension" in body:
        return int(body["dimension"])
    if "size" in body:
        return len(body["size"])
    return {"bar": 1, "plate": 2, "disc": 2, "ring": 2, "outline": 2}.get(body.get("shape"), 3)


def dispersion(
    deck: DeckLike,
    *,
    direction: Sequence[float] | None = None,
    measure: bool = False,
    set: Changes | None = None,
) -> Dispersion:
    """Analyse numerical dispersion and stability of the grid and kernel of a deck.

    Parameters
    ----------
    deck : Deck, dict or path
        The deck.
    direction : sequence of float, optional
        Direction of the wave vectors; by default the contour of the irreducible zone.
    measure : bool
        Also measure the spectrum in a run.
    set : mapping, optional
        Values of keys that replace those in the deck.
    """
    deck = as_deck(deck, set)
    deck._core()
    with file_of(deck) as arguments, temporary() as place:
        out = Path(place) / "dispersion"
        flags = [] if direction is None else [f"--direction={','.join(map(repr, map(float, direction)))}"]
        flags += ["--measure"] if measure else []
        execute("dispersion", *arguments, "--out", str(out), "--quiet", *flags)
        found = Dispersion(json.loads((out / "dispersion.json").read_text(encoding="utf-8")))
        found.curves = Table(_pericles.read_table(out / "curves.csv"))
        polar = out / "polar.csv"
        found.polar = Table(_pericles.read_table(polar)) if polar.exists() else None
    return found


def geodesics(
    surface: str | os.PathLike[str],
    horizon: float | str,
    *,
    methods: Sequence[str] | None = None,
    between: Sequence[tuple[int, int]] = (),
    open: bool = False,
) -> Report:
    """Compare accuracy and cost of methods for geodesic distances on a surface.

    Parameters
    ----------
    surface : path or str
        A file, or a shape such as ``"icosphere(4)"``.
    horizon : float or str
        The horizon, m, or a text with unit.
    methods : sequence of str, optional
        The methods; by default all.
    between : sequence of pairs of int
        Vertices whose distances are computed too.
    open : bool
        Accept a surface with a boundary.
    """
    words = [os.fspath(surface), "--horizon", horizon if isinstance(horizon, str) else f"{float(horizon)!r} m"]
    words += ["--methods", ",".join(methods)] if methods else []
    words += [word for i, j in between for word in ("--between", f"{i},{j}")]
    words += ["--open"] if open else []
    return Report(call("geodesics", *words))


def mesh(file: str | os.PathLike[str], *, unit: str = "m", blocks: Sequence[str] = ()) -> Report:
    """Report the contents of a mesh or surface file: elements, points, volume, sets, problems.

    Parameters
    ----------
    file : path
        The file.
    unit : str
        The length unit of the file.
    blocks : sequence of str
        Names of the element groups that are used; by default all.
    """
    words = [os.fspath(file), "--unit", unit]
    words += ["--blocks", ",".join(blocks)] if blocks else []
    return Report(call("mesh", *words))


def reproduce(study: str, *, full: bool = False) -> Reproduction:
    """Recompute published results and compare.

    Parameters
    ----------
    study : str
        The study, such as ``"nonlocal-wave/..."``; ``pericles reproduce --list`` lists all.
    full : bool
        Include the rows that take long.
    """
    with temporary() as place:
        flags = ["--full"] if full else []
        return Reproduction(call("reproduce", study, "--out", os.path.join(place, "out"), "--quiet", *flags))


def diff(a: Result | str | os.PathLike[str], b: Result | str | os.PathLike[str], *, tolerance: float = 0.0) -> Difference:
    """Compare two results field by field and column by column.

    Parameters
    ----------
    a, b : Result or path
        Results in folders.
    tolerance : float
        The largest relative difference that counts as equal.

    Returns
    -------
    Difference
        ``equal``, ``identical``, and ``rows`` with the differences of fields and columns.
    """
    paths = []
    for given in (a, b):
        folder = given.folder if isinstance(given, Result) else Path(given)
        if folder is None:
            raise PericlesError("results in memory cannot be compared by diff; give an output folder, or compare arrays")
        paths.append(folder)
    return Difference(json.loads(_pericles.compare(paths[0], paths[1], float(tolerance))))


def run(
    deck: DeckLike,
    *,
    set: Changes | None = None,
    out: str | os.PathLike[str] | None = None,
    force: bool = False,
    progress: bool = False,
    device: str | None = None,
) -> Result:
    """Run a deck as the program does: with its output folder.

    Parameters
    ----------
    deck : Deck, dict or path
        The deck.
    set : mapping, optional
        Values of keys that replace those in the deck, such as ``{"time.end": "30 us"}``.
    out : path, optional
        The output folder; by default the name of the deck in the current folder, with a number if it exists.
    force : bool
        Replace results in the folder.
    progress : bool
        Show progress; not available for decks with ``[[step]]``.
    device : str, optional
        Processor of the steps: ``"cpu"``, ``"gpu"``, or ``"gpu:1"`` for a graphics processor of ``pericles devices``; needs a
        package with the feature ``gpu``. By default that of the deck.

    Returns
    -------
    Result
        For a deck with ``[[step]]`` all steps on one time line; :attr:`Result.steps` has the results of each.

    Raises
    ------
    DeckError
        The deck is invalid; ``problems`` lists all problems.
    UnstableError
        The run became unstable; ``result`` has the results before.
    """
    deck = as_deck(deck, {**(set or {}), **_device(device)})
    stem = Path(".") / deck.stem if out is None else None
    if deck.steps:
        made = _pericles.run_steps(deck._core(), None if out is None else Path(out), stem or Path(), force)
        result = Result.open(made)
        warn(result.warnings)
        return result
    model = Model(deck)
    core = model._core.simulation(None if out is None else Path(out), stem, force, [], ("never", 0.0), [])
    warn(core.warnings)
    with Simulation(core, model) as simulation:
        simulation.run(progress=progress)
        folder = core.folder
    assert folder is not None, "given above"
    return Result.open(folder)


def _device(device: str | None) -> dict[str, Any]:
    """Return the keys of a deck that choose a processor."""
    if device is None:
        return {}
    kind, colon, number = device.partition(":")
    if colon and not number.isdigit():
        raise PericlesError(f'device="{device}"; allowed: "cpu", "gpu" or "gpu:N" with the number of a graphics processor')
    return {"run.device": kind, **({"run.adapter": int(number)} if colon else {})}


def open_(folder: str | os.PathLike[str]) -> Result | Sweep:
    """Open the results of a run or of a sweep.

    Parameters
    ----------
    folder : path
        The output folder of the program, of :func:`run` or of :func:`sweep`.

    Returns
    -------
    Result or Sweep
        A sweep for the folder of a sweep, otherwise a result. :meth:`Result.open` and :meth:`Sweep.open` open one kind only.
    """
    found = opened(Path(folder))
    return Result.open(folder) if found is None else found
