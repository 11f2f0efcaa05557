"""Models: points, bonds, conditions and the time step of a deck."""

from __future__ import annotations

import contextlib
import json
import math
import os
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _pericles, _toml
from ._arrays import as_numbers, as_vectors, finite
from ._errors import DeckError, PericlesError
from ._html import table_html
from ._problems import located, warn
from ._simulation import Simulation, schedule

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    from ._deck import Deck
    from ._types import Field, Function, Points, Vector
else:
    from ._lazy import np

_AXES = "xyz"
_SECTIONS = {1: "area", 2: "thickness"}
_SECTION_UNITS = {1: "m2", 2: "m"}


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
        points: ArrayLike | None = None,
        volumes: ArrayLike | None = None,
        blocks: ArrayLike | None = None,
        sets: Mapping[str, ArrayLike] | None = None,
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
        self._built: _pericles.Model | None = self._build()
        #: The body, which later changes of conditions do not change.
        self._body: _pericles.Model = self._core

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
        spacing = body.get("spacing")
        if spacing is not None:
            spacing = _in_unit(spacing, "m", "body.spacing")
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
        return 1.0 if given is None else _in_unit(given, _SECTION_UNITS[dimension], f"body.{key}")

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

    def _parsed(self) -> _pericles.Deck:
        """Read the deck, which finds its problems, without building points and bonds."""
        with self._locating():
            return self.deck._core(list(self._sets))

    def _build(self) -> _pericles.Model:
        sets = [(name, numbers.tolist()) for name, numbers in self._sets.items()]
        x, v, b = self._cloud or (None, None, None)
        with self._locating():
            core = _pericles.Model(self._deck, x, v, b, sets)
        self._facts_of_built: dict[str, Any] = json.loads(core.facts())
        for method, arguments in self._changes:
            getattr(core, method)(*arguments)
        return core

    @property
    def _core(self) -> _pericles.Model:
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
        step: float | None = self._facts["stable_step"]
        return step

    @property
    def sets(self) -> list[str]:
        """Names of the sets of points, "all" first."""
        return [*self._body.sets(), *(name for name in self._sets if name not in self._body.sets())]

    def __len__(self) -> int:
        return int(self._facts_of_built["points"])

    def numbers(self, of: Points = "all") -> NDArray[np.uint32]:
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

    def set_initial(self, *, displacement: ArrayLike | Field | None = None, velocity: ArrayLike | Field | None = None) -> None:
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

    def load(
        self,
        on: Points = "all",
        *,
        body_force: ArrayLike | Function | Vector | None = None,
        traction: ArrayLike | Function | Vector | None = None,
        area: float | str | None = None,
    ) -> None:
        """Add a load on points: a body force or a traction.

        Parameters
        ----------
        on : str, mask or point numbers
            The points.
        body_force : list, array or function
            Force density, N/m³. A list has one entry per axis as in a deck: a number, a text with a unit, or an expression of
            x, y, z (m) and t (s), such as ``["1 GN/m3", "-1e9 * sin(2e6 * t)"]``. An array has the shape (k, dimension). A
            function ``f(t, x)`` of the time (s) and the positions of the k points (m) returns such an array or one vector,
            and is called once for each time that the scheme evaluates.
        traction : list, array or function
            Force per area, N/m², in the same forms. It is distributed over the points as the body force traction · area / volume
            with the volume of the points.
        area : float or str, optional
            The loaded area of a traction, m². By default that of the face of the body, which lists need not give.
        """
        given: dict[str, Any] = {"body_force": body_force, "traction": traction}
        given = {key: value for key, value in given.items() if value is not None}
        if len(given) != 1:
            raise PericlesError("give body_force or traction, one of them")
        [(key, value)] = given.items()
        if area is not None and key == "body_force":
            raise PericlesError("the area belongs to a traction; a body force acts on the volume of the points")
        what = key.replace("_", " ")
        is_text = _is_vector(value) and any(isinstance(entry, str) for entry in value)
        if is_text or (_is_vector(value) and key == "traction"):
            entries = [0.0 if entry is None else entry for entry in self._per_axis(value, what)]
            entry: dict[str, Any] = {key: _expressions(entries)}
            self._deck_entry("load", on, entry if area is None else {**entry, "area": area})
            return
        numbers = self.numbers(on)
        factor = 1.0
        if key == "traction":
            factor = self._loaded_area(on, area) / float(self.volumes[numbers].sum())
        if callable(value):
            function = value
            as_vectors(function(0.0, self.points[numbers]), len(numbers), self.dimension, f"the {what}")

            def density(t: float, x: NDArray[np.float64]) -> NDArray[np.float64]:
                return factor * as_vectors(function(t, x), len(x), self.dimension, f"the {what}")

            self._change("add_load", numbers.tolist(), None, function if key == "body_force" else density)
        else:
            values = finite(as_vectors(value, len(numbers), self.dimension, f"the {what}"), f"the {what}")
            self._change("add_load", numbers.tolist(), factor * values, None)
        self._amended.append(f"a load on {_named(on)}")

    def _loaded_area(self, on: Points, area: float | str | None) -> float:
        """Return the loaded area of a traction by an array or a function, m²."""
        if area is None:
            raise PericlesError(
                "a traction by an array or function needs the loaded area, such as area=\"50 mm2\"; tractions by lists find the area of a face"
            )
        found = _in_unit(area, "m2", "area")
        if not 0 < found < math.inf:
            raise PericlesError(f"area = {area!r}; allowed: a positive area")
        return found

    def prescribe(
        self,
        on: Points,
        *,
        displacement: ArrayLike | Function | Vector | float | str | None = None,
        velocity: ArrayLike | Function | Vector | float | str | None = None,
        axes: str | None = None,
    ) -> None:
        """Prescribe the displacement or velocity of points.

        Parameters
        ----------
        on : str, mask or point numbers
            The points.
        displacement : list, number, text, array or function
            Displacement, m. A list has one entry per axis as in a deck: a number, a text with a unit, an expression of x, y, z
            (m) and t (s), or None for a free axis, such as ``["1 um", None]`` or ``["1e-6 * sin(1e6 * t)", 0]``. One number or
            text is for all prescribed axes. An array of shape (k, dimension) is constant. A function ``f(t, x)`` of the time
            (s) and the positions of the k points (m) returns such an array or one vector.
        velocity : list, number, text, array or function
            Velocity, m/s, in the same forms, except that lists have no expressions. Points start from their initial
            displacement; a function is integrated by Simpson's rule over the time steps. With a function as displacement: the
            function that is its time derivative. Derivatives that are not given are differences over one time step.
        axes : str, optional
            The prescribed axes, such as ``"x"``; by default all.
        """
        known = _AXES[: self.dimension]
        wanted = known if axes is None else axes
        if not wanted or any(axis not in known for axis in wanted):
            raise PericlesError(f'axes = "{axes}"; allowed: some of {", ".join(known)}, such as "x"')
        if displacement is None and velocity is None:
            raise PericlesError("give displacement, velocity or both")
        if displacement is not None and velocity is not None and not (callable(displacement) and callable(velocity)):
            raise PericlesError("velocity together with displacement is for functions only: derivatives of expressions are exact")
        are_rates = displacement is None
        given: Any
        given, quantity = (velocity, "velocity") if are_rates else (displacement, "displacement")
        if isinstance(given, (str, int, float)):
            if axes is None and self.dimension > 1:
                raise PericlesError(f'the {quantity} is one value for {self.dimension} axes; give axes, such as axes="x", or a list')
            given = [given] * self.dimension
        if _is_vector(given):
            entries = _expressions(self._per_axis(given, quantity))
            chosen = ["free" if entry is None or axis not in wanted else entry for axis, entry in zip(known, entries)]
            self._deck_entry("constraint", on, {quantity: chosen})
            return
        numbers = self.numbers(on)
        name = on if isinstance(on, str) else f"motion_{len(self._changes) + 1}"
        along = [axis in wanted for axis in known]
        if callable(given):
            functions = [given] if are_rates or velocity is None else [given, velocity]
            for function, what in zip(functions, (quantity, "velocity")):
                as_vectors(function(0.0, self.points[numbers]), len(numbers), self.dimension, f"the prescribed {what}")
            self._change("add_motion", name, numbers.tolist(), along, functions, are_rates)
        else:
            values = finite(as_vectors(given, len(numbers), self.dimension, f"the {quantity}"), f"the {quantity}")
            self._change("add_constant_motion", name, numbers.tolist(), along, values, are_rates)
        self._amended.append(f"a prescribed motion of {_named(on)}")

    def _per_axis(self, given: Any, what: str) -> list[Any]:
        """Return a list with one entry per axis."""
        if len(given) != self.dimension:
            raise PericlesError(
                f"the {what} has {len(given)} entries; allowed: a list with one entry per axis, {self.dimension} numbers, texts or None"
            )
        return [entry.item() if hasattr(entry, "item") else entry for entry in given]

    def no_fail(self, on: Points) -> None:
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
        out: str | os.PathLike[str] | None = None,
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
            The fields that a simulation in memory keeps in addition to its tables.
        every, time, count : int or float, optional
            When they are kept: every given number of steps, each given time (s), or the given number of times. By default
            100 times.

        Returns
        -------
        Simulation
        """
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


def _is_vector(given: Any) -> bool:
    """Return whether a value has one entry per axis, as in a deck."""
    if isinstance(given, (list, tuple)):
        return all(entry is None or isinstance(entry, (str, int, float)) or hasattr(entry, "item") for entry in given)
    return getattr(given, "ndim", None) == 1


def _expressions(given: list[Any]) -> list[Any]:
    """Return texts without a unit as expressions."""
    is_expression = [isinstance(entry, str) and entry != "free" and not _pericles.is_quantity(entry) for entry in given]
    return [{"expression": entry} if marked else entry for entry, marked in zip(given, is_expression)]


def _named(on: Any) -> str:
    return f"`{on}`" if isinstance(on, str) else "points of an array"


def _in_unit(given: Any, unit: str, key: str) -> float:
    """Return a number, or a text with a unit as in decks, in an SI unit."""
    value = _pericles.in_unit(given, unit) if isinstance(given, str) else float(given)
    if value is None:
        raise PericlesError(f'{key} = "{given}"; allowed: a number in {unit}, or a text with a unit, such as "2 {unit}"')
    return value
