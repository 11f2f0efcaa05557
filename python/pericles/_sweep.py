"""Parameter sweeps."""

from __future__ import annotations

import itertools
import os
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from ._deck import as_deck
from ._errors import PericlesError
from ._functions import run
from ._result import Result


class SweepPoint(NamedTuple):
    """A run of a sweep.

    Attributes
    ----------
    values : dict
        The values of the keys.
    result : Result or None
        The results; None if the run failed.
    error : PericlesError or None
        The error of a failed run.
    """

    values: dict[str, Any]
    result: Result | None
    error: PericlesError | None = None


def sweep(
    deck: Any,
    values: Mapping[str, Sequence[Any]],
    *,
    jobs: int = 1,
    out: str | os.PathLike[str] | None = None,
) -> Iterator[SweepPoint]:
    """Run a deck with all combinations of values of its keys.

    All combinations are checked before the first run. A finished run in the folder is not repeated, so that a sweep that
    was interrupted goes on. A failed run does not stop the others.

    Parameters
    ----------
    deck : Deck, dict or path
        The deck.
    values : mapping of str to sequence
        Keys with their values, such as ``{"body.spacing": ["1 mm", "0.5 mm"]}``.
    jobs : int
        Runs at once; each uses all threads of the process, so that more than one pays for small bodies only.
    out : path, optional
        The folder of the sweep, with one output folder for each run; by default ``NAME-sweep`` in the current folder.

    Yields
    ------
    SweepPoint
        The runs in the order of the combinations.

    Examples
    --------
    >>> import pericles as pc
    >>> for p in pc.sweep("a.toml", {"body.spacing": ["1 mm", "0.5 mm"]}):  # doctest: +SKIP
    ...     print(p.values, p.result.scalar("tip_u_x"))
    """
    given = as_deck(deck)
    combinations = [dict(zip(values, chosen)) for chosen in itertools.product(*values.values())]
    for chosen in combinations:
        given.with_(chosen)._core()
    stem = "run" if given.name.startswith("<") else Path(given.name).stem
    folder = Path(f"{stem}-sweep") if out is None else Path(out)
    folder.mkdir(parents=True, exist_ok=True)
    names = [_name(chosen) for chosen in combinations]
    if len(set(names)) != len(names):
        names = [f"{name}-{number}" for number, name in enumerate(names, 1)]

    def one(chosen: dict[str, Any], name: str) -> SweepPoint:
        path = folder / name
        member = given.with_(chosen)
        try:
            found = Result.open(path)
            if found.info.get("status") == "finished" and _is_of(found, member):
                return SweepPoint(chosen, found)
        except PericlesError:
            pass
        try:
            return SweepPoint(chosen, run(member, out=path, force=path.exists()))
        except PericlesError as error:
            return SweepPoint(chosen, None, error)

    if jobs < 1:
        raise PericlesError(f"jobs = {jobs}; allowed: at least 1")
    if jobs == 1:
        for chosen, name in zip(combinations, names):
            yield one(chosen, name)
        return
    from concurrent.futures import ThreadPoolExecutor

    with ThreadPoolExecutor(jobs) as pool:
        futures = [pool.submit(one, *pair) for pair in zip(combinations, names)]
        try:
            for future in futures:
                yield future.result()
        finally:
            for future in futures:
                future.cancel()


def _is_of(found: Result, deck: Any) -> bool:
    """Return whether results belong to a deck."""
    kept = found.info.get("deck") or {}
    text = deck._text if deck._text is not None else deck.to_toml()
    return kept.get("source") == text and list(kept.get("overrides") or []) == deck._overrides


def _name(chosen: Mapping[str, Any]) -> str:
    parts = ",".join(f"{key.split('.')[-1]}={value}" for key, value in chosen.items())
    # File systems allow 255 bytes for a name.
    return re.sub(r"[^\w+\-.=,]", "_", parts)[:100]
