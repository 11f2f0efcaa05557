"""Models: points, bonds, conditions and the time step of a deck."""

from __future__ import annotations

import contextlib
import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _pericles, _toml
from ._arrays import as_numbers, as_vectors, finite
from ._deck import Deck, located, warn
from ._errors import DeckError, PericlesError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray
    from ._simulation import Simulation
else:
    from ._lazy import np

_AXES = "xyz"
_SECTIONS = {1: "area", 2: "thickness"}


class Model:
    """A body with its conditions, ready to run.

    Made by :meth:`Deck.build`. Arrays have one row for each point in the user's order: the order of the array or file of the
    points, or of the grid.

    Attributes
    ----------
    deck : Deck
        The deck.
    """

    def __init__(
        self,
        deck: Deck,
        *,
        points: Any = None,
        volumes: Any = None,
        blocks: Any = None,
        sets: Mapping[str, Any] | None = None,
    ) -> None:
        self.deck = deck.copy()
        self._amended: list[str] = []
        self._changes: list[tuple[str, tuple[Any, ...]]] = []
        self._cloud = None
        if points is not None:
            self._cloud = self._own_cloud(points, volumes, blocks)
            self._amended.append("points")
        elif volumes is not None or blocks is not None:
            raise PericlesError("volumes and blocks need points")
        count = None if self._cloud is None else len(self._cloud[0])
        self._sets: dict[str, NDArray[np.uint32]] = {}
        for name, given in (sets or {}).items():
            self._add_set(name, as_numbers(given, count, f"of the set `{name}`"))
        self._deck = self._parsed()
        self._built: Any = self._build()
        #: The body, which later changes of conditions do not change.
        self._body = self._built

    def _own_cloud(self, points: Any, volumes: Any, blocks: Any) -> tuple[Any, Any, Any]:
        x = np.asarray(points, dtype=float)
        if x.ndim == 1:
            x = x.reshape(-1, 1)
        if x.ndim != 2 or not 1 <= x.shape[1] <= 3 or len(x) == 0:
            raise PericlesError(f"points have shape {x.shape}; needed: (n, dimension) with n ≥ 1 and 1 to 3 dimensions")
        x = finite(np.ascontiguousarray(x), "points")
        n, dimension = x.shape
        body = dict(self.deck.get("body") or {})
        for key in ("shape", "file", "dimension"):
            if key in body and not (key == "shape" and body[key] == "points"):
                raise PericlesError(f"the body has points from an array; remove `{key}` from [body]")
        section = self._section(body, dimension)
        spacing = _length(body.get("spacing"))
        if volumes is None:
            if spacing is None:
                raise PericlesError("give volumes (m³) of the points, or `spacing` in [body] for those of cells with these sides")
            v = np.full(n, spacing**dimension * section)
        else:
            v = np.broadcast_to(np.asarray(volumes, dtype=float), (n,)) if np.ndim(volumes) == 0 else np.asarray(volumes, dtype=float)
            if v.shape != (n,):
                raise PericlesError(f"volumes have shape {v.shape}; needed: ({n},), one for each point")
            v = finite(np.ascontiguousarray(v), "volumes")
        if spacing is None:
            spacing = float((v.mean() / section) ** (1 / dimension))
        if blocks is None:
            b = np.ones(n, np.uint32)
        else:
            b = np.asarray(blocks)
            if b.shape != (n,) or b.dtype.kind not in "iub" or (b.size and b.min() < 0):
                raise PericlesError(f"blocks have shape {b.shape} and type {b.dtype}; needed: ({n},) whole numbers of at least 0")
            b = np.ascontiguousarray(b.astype(np.uint32))
        body.update(shape="points", file="<array>", dimension=dimension)
        body.setdefault("spacing", spacing)
        self.deck["body"] = body
        return x, v, b

    def _section(self, body: Mapping[str, Any], dimension: int) -> float:
        key = _SECTIONS.get(dimension)
        given = body.get(key) if key else None
        if given is None:
            return 1.0
        if isinstance(given, str):
            probe = {1: "bar", 2: "plate"}[dimension]
            size: dict[str, Any] = {"length": 1} if dimension == 1 else {"size": [1, 1], "plane": "stress"}
            tables = {
                "body": {"shape": probe, **size, "spacing": 0.1, str(key): given},
                "material": {"density": 1, "youngs_modulus": 1, "horizon_ratio": 3},
                "time": {"end": 1},
            }
            return float(Deck.from_dict(tables).values()["body"][str(key)])
        return float(given)

    def _add_set(self, name: str, numbers: NDArray[np.uint32]) -> None:
        if name in (self.deck.get("sets") or {}) or name in self._sets or name == "all":
            raise PericlesError(f"there is a set `{name}` already; choose another name")
        if len(numbers) == 0:
            raise PericlesError(f"the set `{name}` has no points")
        self._sets[name] = numbers
        self._amended.append(f"the set `{name}`")

    @contextlib.contextmanager
    def _locating(self) -> Iterator[None]:
        """Add their keys to the problems of a deck."""
        try:
            yield
        except DeckError as error:
            text = self.deck._text or _toml.dumps(self.deck._tables or {})
            located(error, text, self.deck.name)
            raise

    def _parsed(self) -> Any:
        """Read the deck, which finds its problems, without building points and bonds."""
        with self._locating():
            return self.deck._core(list(self._sets))

    def _build(self) -> Any:
        sets = [(name, numbers.tolist()) for name, numbers in self._sets.items()]
        x, v, b = self._cloud or (None, None, None)
        with self._locating():
            core = _pericles.Model(self._deck, x, v, b, sets)
        self._facts_of_built = json.loads(core.facts())
        for method, arguments in self._changes:
            getattr(core, method)(*arguments)
        return core

    @property
    def _core(self) -> Any:
        """The model of the present deck, which is built when it is needed."""
        if self._built is None:
            self._built = self._build()
        return self._built

    @property
    def _facts(self) -> dict[str, Any]:
        assert self._core is not None
        return self._facts_of_built

    def _deck_changed(self) -> None:
        self._deck = self._parsed()
        self._built = None

    def _change(self, method: str, *arguments: Any) -> None:
        if self._built is not None:
            getattr(self._built, method)(*arguments)
        self._changes.append((method, arguments))

    @property
    def facts(self) -> dict[str, Any]:
        """Properties before the first step in SI units: bonds, horizon, stable step, memory, warnings about the deck …"""
        return dict(self._facts)

    @property
    def points(self) -> NDArray[np.float64]:
        """Positions of the points, m; shape (n, dimension)."""
        return self._body.positions()

    @property
    def volumes(self) -> NDArray[np.float64]:
        """Volumes of the points, m³; shape (n,)."""
        return self._body.volumes()

    @property
    def dimension(self) -> int:
        """Dimension of the body."""
        return int(self._facts_of_built["dimension"])

    @property
    def dt(self) -> float:
        """Time step, s."""
        return float(self._facts["dt"])

    @property
    def stable_step(self) -> float | None:
        """Largest stable time step, s; None for schemes that are stable for any step."""
        return self._facts["stable_step"]

    @property
    def sets(self) -> list[str]:
        """Names of the sets of points, "all" first."""
        return [*self._body.sets(), *(name for name in self._sets if name not in self._body.sets())]

    def __len__(self) -> int:
        return int(self._facts_of_built["points"])

    def numbers(self, of: Any = "all") -> NDArray[np.uint32]:
        """Return the numbers of the points of a set, a mask or a list of numbers, in ascending order."""
        if isinstance(of, str):
            found = self._sets[of] if of in self._sets else self._body.numbers(of)
            if found is None:
                raise PericlesError(f"there is no set `{of}`; the model has: {', '.join(self.sets)}")
            return found
        return np.unique(as_numbers(of, len(self), "of points"))

    def _field(self, given: Any, what: str) -> NDArray[np.float64] | None:
        if given is None:
            return None
        if callable(given):
            given = given(self.points)
        return finite(as_vectors(given, len(self), self.dimension, what), what)

    def set_initial(self, *, displacement: Any = None, velocity: Any = None) -> None:
        """Replace the initial state of the whole body.

        Parameters
        ----------
        displacement, velocity : array of shape (n, dimension) or function, optional
            Displacements (m) and velocities (m/s), or functions of the positions that return them. What is not given stays
            as in the deck.
        """
        u = self._field(displacement, "initial displacements")
        v = self._field(velocity, "initial velocities")
        if u is None and v is None:
            raise PericlesError("give displacement, velocity or both")
        self._change("set_initial", u, v)
        self._amended.append("the initial state")

    def load(self, on: Any = "all", *, body_force: Any) -> None:
        """Add a body force on points.

        Parameters
        ----------
        on : str, mask or point numbers
            The points.
        body_force : array, function or deck expressions
            Force density, N/m³: an array of shape (k, dimension) or one vector; a function ``f(t, x)`` of the time (s) and
            the positions of the k points (m) that returns such an array; or a list of texts, each an expression of x, y, z
            (m) and t (s) in SI units as in a deck. A function is called once for each time that the scheme evaluates.
        """
        if _is_expressions(body_force):
            self._deck_entry("load", on, {"body_force": _expressions(body_force)})
            return
        numbers = self.numbers(on)
        if callable(body_force):
            as_vectors(body_force(0.0, self.points[numbers]), len(numbers), self.dimension, "the body force")
            self._change("add_load", numbers.tolist(), None, body_force)
        else:
            values = finite(as_vectors(body_force, len(numbers), self.dimension, "the body force"), "the body force")
            self._change("add_load", numbers.tolist(), values, None)
        self._amended.append(f"a load on {_named(on)}")

    def prescribe(self, on: Any, *, displacement: Any = None, velocity: Any = None, axes: str | None = None) -> None:
        """Prescribe the displacement or velocity of points.

        Parameters
        ----------
        on : str, mask or point numbers
            The points.
        displacement : list, function or array
            One entry per axis as in a deck: a number (m), a text, which is an expression of x, y, z (m) and t (s), or None
            for a free axis; such as ``[0, None]`` or ``["1e-6 * sin(1e6 * t)", 0]``. Or a function ``f(t, x)`` of the time
            (s) and the positions of the k points (m) that returns displacements (m) of shape (k, dimension) or one vector;
            or a constant array of shape (k, dimension).
        velocity : list or function, optional
            With a function as displacement: its time derivative, m/s. Derivatives that are not given are differences over one
            time step. Alone: a list of constant velocities (m/s), such as ``[2.0, None]``.
        axes : str, optional
            The prescribed axes, such as ``"x"``; by default all.
        """
        known = _AXES[: self.dimension]
        wanted = known if axes is None else axes
        if not wanted or any(axis not in known for axis in wanted):
            raise PericlesError(f'axes = "{axes}"; allowed: some of {", ".join(known)}, such as "x"')
        if displacement is None and velocity is None:
            raise PericlesError("give displacement, velocity or both")
        if displacement is None or _is_vector(displacement):
            if displacement is not None and velocity is not None:
                raise PericlesError("a velocity besides a displacement is for functions; expressions have exact derivatives")
            given, quantity = (velocity, "velocity") if displacement is None else (displacement, "displacement")
            if not _is_vector(given) or len(given) != self.dimension:
                raise PericlesError(f"the {quantity} alone is a list with one entry per axis: {self.dimension} numbers, texts or None")
            entries = [entry if axis in wanted else None for axis, entry in zip(known, _expressions(given))]
            self._deck_entry("constraint", on, {quantity: ["free" if entry is None else entry for entry in entries]})
            return
        numbers = self.numbers(on)
        if not callable(displacement):
            values = finite(as_vectors(displacement, len(numbers), self.dimension, "the displacement"), "the displacement")
            displacement, velocity = (lambda t, x: values), (lambda t, x: np.zeros_like(values))
        functions = [displacement] if velocity is None else [displacement, velocity]
        for function, what in zip(functions, ("displacement", "velocity")):
            as_vectors(function(0.0, self.points[numbers]), len(numbers), self.dimension, f"the prescribed {what}")
        name = on if isinstance(on, str) else f"motion_{len(self._changes) + 1}"
        self._change("add_motion", name, numbers.tolist(), [axis in wanted for axis in known], functions)
        self._amended.append(f"a prescribed motion of {_named(on)}")

    def no_fail(self, on: Any) -> None:
        """Exclude the bonds of points from failure.

        Parameters
        ----------
        on : str, mask or point numbers
            The points.
        """
        name = self._set_of(on, "no_fail")
        material = dict(self.deck.get("material") or {})
        known = material.get("no_fail", [])
        material["no_fail"] = [*([known] if isinstance(known, str) else known), name]
        self.deck["material"] = material
        self._deck_changed()

    def _set_of(self, on: Any, stem: str) -> str:
        if isinstance(on, str):
            self.numbers(on)
            return on
        number = 1
        while f"{stem}_{number}" in self.sets:
            number += 1
        name = f"{stem}_{number}"
        self._add_set(name, as_numbers(on, len(self), "of points"))
        return name

    def _deck_entry(self, table: str, on: Any, entry: dict[str, Any]) -> None:
        """Add an entry with expressions to the deck."""
        name = self._set_of(on, table)
        before = self.deck.get(table)
        self.deck[table] = [*(before or []), {"set": name, **entry}]
        try:
            self._deck_changed()
        except DeckError:
            # The model stays as it was.
            if before is None:
                del self.deck[table]
            else:
                self.deck[table] = before
            raise

    def simulation(
        self,
        *,
        out: Any = None,
        force: bool = False,
        keep: Sequence[str] = ("displacement", "velocity", "damage"),
        every: int | None = None,
        time: float | None = None,
        count: int | None = None,
    ) -> Simulation:
        """Make a simulation.

        Parameters
        ----------
        out : path, optional
            The output folder, which receives what the deck requests under ``[output]``; by default results stay in memory.
        force : bool
            Replace results in the folder.
        keep : sequence of str
            The fields that a simulation in memory keeps.
        every, time, count : int or float, optional
            When they are kept: every given number of steps, each given time (s), or the given number of times. By default
            100 times.

        Returns
        -------
        Simulation
        """
        from ._simulation import Simulation, schedule

        keep = [keep] if isinstance(keep, str) else list(keep)
        kind, value = schedule(every, time, count) or ("count", 100)
        if out is not None:
            keep, kind, value = [], "never", 0.0
        core = self._core.simulation(
            None if out is None else Path(out), None, force, keep, (kind, float(value)), self._amended
        )
        warn(core.warnings)
        return Simulation(core, self)

    def __repr__(self) -> str:
        facts = self._facts
        return (
            f"<pericles.Model: {facts['points']} points in {facts['dimension']}D, {facts['bonds']} bonds, "
            f"horizon {facts['horizon']:.4g} m, dt {facts['dt']:.4g} s, {facts['steps']} steps>"
        )

    def _repr_html_(self) -> str:
        return table_html("Model", self._facts)


def table_html(title: str, facts: Mapping[str, Any]) -> str:
    """Return facts as a table, with warnings in colour."""
    import html

    rows = []
    for key, value in facts.items():
        if value is None or isinstance(value, (list, dict)):
            continue
        shown = f"{value:.6g}" if isinstance(value, float) else str(value)
        rows.append(f"<tr><td>{html.escape(key.replace('_', ' '))}</td><td>{html.escape(shown)}</td></tr>")
    warnings = "".join(
        f'<p style="color:#b36b00">warning: {html.escape(text)}</p>' for text in facts.get("warnings") or []
    )
    return f"<b>{html.escape(title)}</b><table>{''.join(rows)}</table>{warnings}"


def _is_expressions(given: Any) -> bool:
    return isinstance(given, (list, tuple)) and any(isinstance(entry, str) for entry in given)


def _is_vector(given: Any) -> bool:
    """Return whether a value has one entry per axis, as in a deck."""
    return isinstance(given, (list, tuple)) or getattr(given, "ndim", None) == 1


def _expressions(given: Any) -> list[Any]:
    return [{"expression": entry} if isinstance(entry, str) and entry != "free" else entry for entry in given]


def _named(on: Any) -> str:
    return f"`{on}`" if isinstance(on, str) else "points of an array"


def _length(given: Any) -> float | None:
    """Return a length of a deck in m."""
    if given is None or isinstance(given, (int, float)):
        return None if given is None else float(given)
    tables = {
        "body": {"shape": "bar", "length": given, "spacing": given},
        "material": {"density": 1, "youngs_modulus": 1, "horizon_ratio": 3},
        "time": {"end": 1},
    }
    return float(Deck.from_dict(tables).values()["body"]["spacing"])
