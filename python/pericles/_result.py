"""Results of runs."""

from __future__ import annotations

import json
import os
import warnings
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _pericles
from ._errors import OutputError, PericlesError, PericlesWarning
from ._html import table_html

if TYPE_CHECKING:
    import numpy as np
    import pandas
    import polars
    import pyvista
    from matplotlib.axes import Axes
    from numpy.typing import NDArray
    from ._model import Model
else:
    from ._lazy import np


def optional(name: str, extra: str) -> Any:
    """Import an optional package, or say how to install it."""
    import importlib

    try:
        return importlib.import_module(name)
    except ImportError:
        raise PericlesError(f'this needs the package {name}: pip install {name}, or pip install "pericles[{extra}]"') from None


def seconds(time: float | str) -> float:
    """Return a time in seconds: a number, or a text with a unit as in decks."""
    if isinstance(time, str):
        found = _pericles.seconds(time)
    else:
        try:
            found = float(time)
        except (TypeError, ValueError):
            found = None
    if found is None:
        raise PericlesError(f'the time is {time!r}; allowed: a number in s, or a text with a unit, such as "3 us"')
    return found


class Table(Mapping[str, "NDArray[np.float64]"]):
    """A table of columns, such as a time history.

    Attributes
    ----------
    units : dict of str to str
        Units of the columns; empty for dimensionless values.
    """

    def __init__(self, columns: list[tuple[str, str, NDArray[np.float64]]]) -> None:
        self._columns = {name: values for name, _, values in columns}
        self.units = {name: unit for name, unit, _ in columns}
        for values in self._columns.values():
            values.flags.writeable = False

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        try:
            return self._columns[name]
        except KeyError:
            raise PericlesError(f"there is no column `{name}`; the table has: {', '.join(self._columns)}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    def __contains__(self, name: object) -> bool:
        return name in self._columns

    def to_pandas(self) -> pandas.DataFrame:
        """Return a pandas DataFrame that shares the columns."""
        package = optional("pandas", "pandas")
        columns = {name: package.Series(values, copy=False) for name, values in self._columns.items()}
        frame: pandas.DataFrame = package.DataFrame(columns, copy=False)
        return frame

    def to_polars(self) -> polars.DataFrame:
        """Return a polars DataFrame."""
        frame: polars.DataFrame = optional("polars", "polars").DataFrame(dict(self._columns))
        return frame

    def __repr__(self) -> str:
        rows = len(next(iter(self._columns.values()), ()))
        return f"<pericles.Table: {rows} rows of {', '.join(self._columns)}>"


class Record(Mapping[str, Any]):
    """A part of ``run.json``, whose entries are also attributes."""

    def __init__(self, entries: Mapping[str, Any]) -> None:
        self._entries = dict(entries)

    def __getitem__(self, name: str) -> Any:
        value = self._entries[name]
        return Record(value) if isinstance(value, dict) else value

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self[name]
        except KeyError:
            raise AttributeError(f"there is no entry `{name}`; there are: {', '.join(self._entries)}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._entries)

    def __len__(self) -> int:
        return len(self._entries)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._entries]

    def __repr__(self) -> str:
        return "\n".join(_lines(self._entries)) or "no entries"


def _lines(entries: Mapping[str, Any]) -> list[str]:
    """Return a line for each entry; those of a table are indented below its name."""
    lines = []
    widest = max((len(name) for name in entries), default=0)
    for name, value in entries.items():
        if isinstance(value, Mapping) and value:
            lines += [name, *(f"    {line}" for line in _lines(value))]
        elif isinstance(value, list) and any(isinstance(entry, Mapping) for entry in value):
            for number, entry in enumerate(value):
                lines += [f"{name}[{number}]", *(f"    {line}" for line in _lines(entry))]
        else:
            lines.append(f"{name:<{widest}}  {_shown(value)}")
    return lines


def _shown(value: Any) -> str:
    """Return a value in at most one line."""
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, (list, tuple)):
        entries = [_shown(entry) for entry in value[:8]]
        return f"[{', '.join([*entries, '…'] if len(value) > 8 else entries)}]"
    lines = str(value).splitlines() or [""]
    return lines[0] if len(lines) == 1 else f"{lines[0]} … ({len(lines)} lines)"


class Progress(Record):
    """How far a run came.

    Attributes
    ----------
    last_step : int
        The last completed step.
    t : float
        Its time, s.
    """

    last_step: int
    t: float


class Audit(Record):
    """Balance of energy and momentum at the end of a run; energies in J, per metre for plates without a thickness.

    :class:`Record` has further entries.

    Attributes
    ----------
    kinetic_energy, elastic_energy, dissipated_energy, external_work, initial_energy, scheme_correction, balance : float
        The energies, and the sum that is zero if energy is conserved.
    broken_bonds : int
        Number of broken bonds, each counted once.
    """

    kinetic_energy: float
    elastic_energy: float
    dissipated_energy: float
    external_work: float
    initial_energy: float
    scheme_correction: float
    balance: float
    broken_bonds: int


class Info(Record):
    """The content of ``run.json``; :class:`Record` has further entries.

    Attributes
    ----------
    status : str
        ``"finished"``, ``"stopped"`` or ``"failed"``.
    stop_reason : str or None
        What ended the run before its last step.
    title : str or None
        The title of the deck.
    """

    status: str
    stop_reason: str | None
    title: str | None


class Result:
    """The results of a run, in a folder or in memory.

    Arrays have one row for each point in the user's order and are read-only views; copy them to change them.
    """

    _folder: Path | None
    _report: dict[str, Any]
    _files: list[tuple[float, Path]] | None
    _recording: _pericles.Recording | None
    _positions: NDArray[np.float64]
    _sides: NDArray[np.float64] | None
    _cache: dict[int, _pericles.OutputFile]

    def __init__(self) -> None:
        raise TypeError("use pericles.open(folder), pericles.run(deck) or Simulation.result()")

    @classmethod
    def open(cls, folder: str | os.PathLike[str]) -> Result:
        """Open the output folder of a run."""
        result = cls.__new__(cls)
        result._folder = Path(folder)
        path = result._folder / "run.json"
        try:
            result._report = json.loads(path.read_text(encoding="utf-8"))
        except FileNotFoundError:
            if (result._folder / "fit.json").exists():
                found = f"{folder} is the folder of a fit: its results are fit.csv and curve.csv; open one of its runs, such as run-0001"
            else:
                found = f"{folder} is not the output folder of a run: it has no run.json"
            raise OutputError(found) from None
        except (OSError, ValueError) as error:
            raise OutputError(f"{path} cannot be used: {error}") from None
        result._files = None
        result._recording = None
        result._cache = {}
        return result

    @classmethod
    def of_simulation(cls, core: _pericles.Simulation, model: Model) -> Result:
        """Return the results that a simulation keeps in memory."""
        result = cls.__new__(cls)
        result._folder, result._files, result._cache = None, None, {}
        result._recording = core.recording()
        result._positions = model.points
        result._sides = model._body.cell_sides()
        try:
            energies, broken = core.energies, core.broken_bonds
        except PericlesError:
            energies, broken = {}, None
        reason = core.stop_reason
        result._report = {
            "status": "finished" if core.step == core.steps or core.is_finished else "stopped",
            "stop_reason": reason,
            "title": (model.deck.get("title")),
            "model": model.facts,
            "progress": {"last_step": core.step, "t": core.time},
            "audit": {**energies, "broken_bonds": broken},
        }
        return result

    @property
    def folder(self) -> Path | None:
        """The output folder; None for results in memory."""
        return self._folder

    @property
    def info(self) -> Info:
        """The content of ``run.json``: status, model, progress, energy balance, deck."""
        return Info(self._report)

    @property
    def steps(self) -> list[Result]:
        """The results of the steps of a deck with ``[[step]]``; empty for other runs."""
        record = None if self._folder is None else self._folder / "steps.json"
        if self._folder is None or record is None or not record.exists():
            return []
        try:
            names = json.loads(record.read_text(encoding="utf-8"))["steps"]
        except (OSError, ValueError, KeyError) as error:
            raise OutputError(f"{record} cannot be used: {error}") from None
        return [Result.open(self._folder / name) for name in names if (self._folder / name / "run.json").exists()]

    @property
    def audit(self) -> Audit:
        """Balance of energy and momentum at the end."""
        return Audit(self._report.get("audit") or {})

    @property
    def warnings(self) -> list[str]:
        """Warnings about the model and the run."""
        model = (self._report.get("model") or {}).get("warnings") or []
        return [*model, *((self._report.get("audit") or {}).get("warnings") or [])]

    @property
    def history(self) -> Table:
        """Time histories of energies, momentum and broken bonds; further columns as requested by the deck."""
        return self.table("history")

    @property
    def tables(self) -> list[str]:
        """Names of the tables, such as "history", "probes", "reactions", "cracks" and "quantities"."""
        if self._recording is not None:
            return sorted(self._recording.tables())
        assert self._folder is not None
        return sorted(path.stem for path in self._folder.glob("*.csv"))

    def table(self, name: str) -> Table:
        """Return a table by its name, such as ``"probes"``.

        Runs in memory have the same tables as runs with a folder, except profiles.
        """
        found = None
        if self._recording is not None:
            found = self._recording.table(name)
        elif self._folder is not None and (self._folder / f"{name}.csv").exists():
            found = _pericles.read_table(self._folder / f"{name}.csv")
        if found is None:
            raise PericlesError(f"there is no table `{name}`; the run has: {', '.join(self.tables) or 'none'}")
        return Table(found)

    def scalar(self, name: str) -> float:
        """Return the last value of a column of any table, such as ``"tip_u_x"``, or a number of run.json, such as ``"audit.balance"``."""
        if "." in name:
            value: Any = self._report
            for key in name.split("."):
                value = value.get(key) if isinstance(value, Mapping) else None
            if isinstance(value, (int, float)):
                return float(value)
            raise PericlesError(f"run.json has no number `{name}`")
        known = []
        for table in self.tables:
            columns = self.table(table)
            if name in columns:
                return float(columns[name][-1])
            known += [column for column in columns if column not in ("step", "time")]
        raise PericlesError(f"there is no column `{name}`; the tables have: {', '.join(known)}")

    def _series(self) -> list[tuple[float, Path]]:
        if self._files is None:
            assert self._folder is not None
            import xml.etree.ElementTree as xml

            path = self._folder / "fields.pvd"
            if not path.exists():
                self._files = []
                return []
            try:
                sets = xml.parse(path).getroot().iter("DataSet")
                self._files = [(float(entry.attrib["timestep"]), self._folder / entry.attrib["file"]) for entry in sets]
            except (OSError, xml.ParseError, KeyError, ValueError) as error:
                raise OutputError(f"{path} is damaged: {error}") from None
        return self._files

    @property
    def times(self) -> NDArray[np.float64]:
        """Times of the outputs of fields, s."""
        if self._recording is not None:
            return np.array(self._recording.times())
        return np.array([time for time, _ in self._series()])

    def _output(self, time: float | str | None, output: int | None) -> int:
        times = self.times
        if time is not None and output is not None:
            raise PericlesError("give time or output, not both")
        if len(times) == 0:
            raise PericlesError("the run has no outputs of fields; request them under [output] of the deck, or by `keep`")
        if time is not None:
            return int(np.argmin(np.abs(times - seconds(time))))
        index = -1 if output is None else int(output)
        if not -len(times) <= index < len(times):
            raise PericlesError(f"output {index} does not exist; there are {len(times)}, from 0 to {len(times) - 1}")
        return index % len(times)

    def _file(self, output: int) -> _pericles.OutputFile:
        if output not in self._cache:
            self._cache.clear()
            self._cache[output] = _pericles.OutputFile(self._series()[output][1])
        return self._cache[output]

    @property
    def fields(self) -> list[str]:
        """Names of the fields."""
        if self._recording is not None:
            return self._recording.names()
        if not self._series():
            return []
        return [name.lower() for name in self._file(self._output(None, None)).names()[1:]]

    @property
    def points(self) -> NDArray[np.float64]:
        """Reference positions of the points, m; shape (n, dimension)."""
        if self._recording is not None:
            return self._positions
        places = self._file(self._output(None, None)).field("Points")
        assert places is not None, "the first field of every file"
        return places[:, : self._dimension]

    @property
    def _dimension(self) -> int:
        return int((self._report.get("model") or {}).get("dimension") or 3)

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        """Return a field of the last output."""
        return self.field(name)

    def __contains__(self, name: object) -> bool:
        return name in self.fields

    def __iter__(self) -> Iterator[str]:
        return iter(self.fields)

    def components(self, name: str) -> list[str]:
        """Return the names of the components of a field, such as ``["xx", "yy", "xy"]`` of a plane stress; empty for scalars."""
        return _pericles.field_components(name, self._dimension)

    def field(self, name: str, *, time: float | str | None = None, output: int | None = None) -> NDArray[np.float64]:
        """Return a field of an output.

        Parameters
        ----------
        name : str
            Name in lower case, such as ``"displacement"`` or ``"strain_energy_density"``.
        time : float or str, optional
            The output nearest to this time: a number in s, or a text with a unit, such as ``"3 us"``.
        output : int, optional
            The number of the output; by default the last one, -1.

        Returns
        -------
        array
            Shape (n, components), or (n,) for scalars; read-only. Vectors have the components of the dimension of the body,
            tensors those of :meth:`components`.
        """
        index = self._output(time, output)
        if self._recording is not None:
            found = self._recording.field(name, index)
            if found is None:
                raise PericlesError(f"the field `{name}` was not kept; kept: {', '.join(self.fields)}")
            return found
        file = self._file(index)
        names = {known.lower(): known for known in file.names()}
        values = None if name.lower() == "points" else file.field(names.get(name.lower(), ""))
        if values is None:
            raise PericlesError(f"there is no field `{name}`; the run wrote: {', '.join(sorted(set(names) - {'points'}))}")
        if values.shape[1] == 1:
            return values.reshape(-1)
        known, wanted = _pericles.field_components(name, 3), self.components(name)
        if len(known) == values.shape[1]:
            columns = [known.index(component) for component in wanted]
            first = columns == list(range(len(columns)))
            return values[:, : len(columns)] if first else values[:, columns]
        return values[:, : self._dimension] if values.shape[1] == 3 else values

    def to_pyvista(self, *, time: float | str | None = None, output: int | None = None, cells: bool = True) -> pyvista.DataSet:
        """Return all fields of an output as a PyVista data set.

        Parameters
        ----------
        time, output : float or int, optional
            The output; by default the last.
        cells : bool
            For results in memory: fields on the cells of the points, as lines, squares or cubes, or on the points alone.
            Results in a folder are returned as the run wrote them: on cells for grids and meshes.
        """
        package = optional("pyvista", "pyvista")
        index = self._output(time, output)
        if self._recording is None:
            read: pyvista.DataSet = package.read(self._series()[index][1])
            return read
        if cells and self._sides is not None:
            dimension = self._dimension
            signs = np.array(_SIGNS[: 2**dimension])[:, :dimension]
            corners = self.points[:, None, :] + self._sides[:, None, :] / 2 * signs
            numbers = np.arange(corners.shape[0] * len(signs)).reshape(-1, len(signs))
            kind = {1: package.CellType.LINE, 2: package.CellType.QUAD, 3: package.CellType.HEXAHEDRON}[dimension]
            mesh: Any = package.UnstructuredGrid({kind: numbers}, _padded(corners.reshape(-1, dimension)))
            data = mesh.cell_data
        else:
            mesh = package.PolyData(_padded(self.points))
            data = mesh.point_data
        for name in self.fields:
            values = self.field(name, output=index)
            shown = "_".join(word.capitalize() for word in name.split("_"))
            data[shown] = values if values.ndim == 1 or values.shape[1] > 3 else _padded(values)
        made: pyvista.DataSet = mesh
        return made

    def to_meshio(self, *, time: float | str | None = None, output: int | None = None) -> Any:
        """Return the points with all fields of an output as a meshio mesh of vertices; meshio has no types."""
        package = optional("meshio", "all")
        index = self._output(time, output)
        points = self.points
        data = {}
        for name in self.fields:
            values = np.array(self.field(name, output=index))
            data[name] = values if values.ndim == 1 or values.shape[1] > 3 else _padded(values)
        cells = [("vertex", np.arange(len(points)).reshape(-1, 1))]
        return package.Mesh(_padded(points), cells, point_data=data)

    def plot(
        self,
        field: str = "damage",
        *,
        component: int | str | None = None,
        time: float | str | None = None,
        output: int | None = None,
        scale: float = 1.0,
        range: tuple[float, float] | None = None,
        cmap: str | None = None,
        ax: Axes | None = None,
    ) -> Axes:
        """Draw a field with Matplotlib; return the axes.

        A bar is drawn as a curve, the points of a plane body as squares with the sides of their cells, and of a
        three-dimensional body the outer faces of the cells. Bodies with more than 100 000 outer faces are drawn faster by
        :meth:`to_pyvista`.

        Parameters
        ----------
        field : str
            The field.
        component : int or str, optional
            The component of a vector or tensor, by its number or by its name in :meth:`components`, such as ``"x"`` or
            ``"xy"``; by default the magnitude.
        time, output : float or int, optional
            The output; by default the last.
        scale : float
            Factor of the displacements by which the points are moved, if they are there; 0 draws the undeformed body.
        range : pair of float, optional
            Values at the ends of the colours; by default the least and the largest value, 0 and 1 for damage.
        cmap : str, optional
            The colour map of Matplotlib.
        ax : matplotlib.axes.Axes, optional
            The axes to draw in; by default the current ones. Those of a three-dimensional body have the projection ``"3d"``.
        """
        pyplot = optional("matplotlib.pyplot", "all")
        values, label = self._component(self.field(field, time=time, output=output), field, component)
        x = np.array(self.points)
        reference = x
        if scale and "displacement" in self.fields:
            x = x + scale * np.asarray(self.field("displacement", time=time, output=output)).reshape(x.shape)
        dimension = x.shape[1]
        axes: Any = ax
        if axes is None:
            axes = pyplot.gca() if dimension < 3 else pyplot.gcf().add_subplot(projection="3d")
        drawn_in: Axes = axes
        factor, unit = _length_unit(x)
        unit_of_values = _pericles.field_unit(field)
        label = f"{label} ({unit_of_values})" if unit_of_values else label
        at = self.times[self._output(time, output)]
        axes.set_title(f"t = {_engineering(at, 's')}", fontsize="medium")
        axes.set_xlabel(f"x ({unit})")
        if dimension == 1:
            order = np.argsort(x[:, 0])
            axes.plot(factor * x[order, 0], values[order], ".-", markersize=3, linewidth=0.8)
            axes.set_ylabel(label)
            return drawn_in
        axes.set_ylabel(f"y ({unit})")
        sides = self._cell_sides()
        colours = {"cmap": cmap, "clim": range or ((0.0, 1.0) if field == "damage" else (float(values.min()), float(values.max())))}
        draw = _draw_squares if dimension == 2 else _draw_faces
        drawn = draw(axes, (reference, x, sides), factor, values, colours)
        if dimension == 3:
            axes.set_zlabel(f"z ({unit})")
            axes.get_figure().colorbar(drawn, ax=axes, label=label, shrink=0.7, pad=0.12)
            return drawn_in
        # As high as the axes, whose height follows from the height of the body.
        beside = axes.inset_axes((1.03, 0.0, 0.03, 1.0))
        axes.get_figure().colorbar(drawn, cax=beside, label=label)
        return drawn_in

    def _component(self, values: Any, field: str, component: int | str | None) -> tuple[Any, str]:
        """Return a component, or the magnitude, of a field with its name."""
        name = field.replace("_", " ")
        if values.ndim == 1:
            if component is not None:
                raise PericlesError(f"the field `{field}` is a scalar; it has no component {component!r}")
            return values, name
        if component is None:
            return (values[:, 0], name) if values.shape[1] == 1 else (np.linalg.norm(values, axis=1), f"{name}, magnitude")
        names = self.components(field)
        number = names.index(component) if component in names else component
        if not isinstance(number, int) or not 0 <= number < values.shape[1]:
            raise PericlesError(
                f"the field `{field}` has no component {component!r}; allowed: {', '.join(names)}, or a number from 0 to {values.shape[1] - 1}"
            )
        return values[:, number], f"{name}, {names[number] if number < len(names) else number}"

    def _cell_sides(self) -> NDArray[np.float64]:
        """The sides of the cells of the points, m."""
        if self._recording is not None and self._sides is not None:
            return self._sides
        shape = (len(self.points), self._dimension)
        spacing = float((self._report.get("model") or {}).get("spacing") or 0.0)
        if "radius" in self.fields:
            return np.broadcast_to(2 * np.asarray(self.field("radius"))[:, None], shape)
        return np.full(shape, spacing)

    def export(
        self,
        path: str | os.PathLike[str],
        *,
        format: str | None = None,
        every: int | None = None,
        fields: Iterable[str] = (),
    ) -> Path:
        """Write the fields to a new file of another format.

        Parameters
        ----------
        path : path
            The file, or the folder of CSV tables.
        format : str, optional
            ``"exodus"``, ``"vtkhdf"``, ``"csv"``, ``"npz"`` or ``"html"``; by default that of the ending of the file: ``.exo``,
            ``.vtkhdf``, ``.npz``, ``.html``, or ``csv`` for a folder without ending.
        every : int, optional
            Use every n-th output, and the last one; by default all.
        fields : iterable of str
            The fields, such as ``"damage"``, or ``"stress"`` for all its components; by default all.

        Returns
        -------
        Path
            The file. A warning reports outputs that were left out of a page because of its size.
        """
        path = Path(path)
        known = dict(_pericles.export_formats())
        endings = {Path(name).suffix: word for word, name in known.items()}
        word = endings.get(path.suffix) if format is None else format
        if word not in known:
            allowed = ", ".join(f"{word} ({Path(name).suffix or 'a folder'})" for word, name in known.items())
            what = f"the ending of {path}" if format is None else f'format = "{format}"'
            raise PericlesError(f"{what} selects no format; allowed: {allowed}")
        if path.exists():
            raise OutputError(f"{path} exists; give another file")
        notes = self._exported(word, path, every, fields, "exported")
        if every is None:
            for note in notes:
                warnings.warn(note, PericlesWarning, stacklevel=2)
        return path

    def _exported(self, format: str, path: Path, every: int | None, fields: Iterable[str], what: str) -> list[str]:
        """Write fields in a format; return what was left out."""
        if self._folder is None:
            raise PericlesError(f"results in memory cannot be {what}; give an output folder, such as run(deck, out=\"results\")")
        if not any((self._folder / name).exists() for name in ("fields.pvd", "fields.exo", "fields.vtkhdf")):
            raise PericlesError("the run has no outputs of fields; request them under [output] of the deck")
        if every is not None and every < 1:
            raise PericlesError(f"every is {every}; allowed: an integer of at least 1")
        return _pericles.export_fields(self._folder, format, path, every, list(fields))

    def view(
        self,
        *,
        path: str | os.PathLike[str] | None = None,
        every: int | None = None,
        fields: Iterable[str] = (),
        height: int = 650,
    ) -> View:
        """Show the fields over time in the browser, or in the notebook.

        The page is one file, ``fields.html`` in the output folder, which needs no other files and no network. Values are
        rounded to 16 bits.

        Parameters
        ----------
        path : path, optional
            The file to write.
        every : int, optional
            Use every n-th output, and the last one; by default all, of series larger than 200 MB fewer.
        fields : iterable of str
            The fields; by default all.
        height : int
            Height in the notebook, in pixels.
        """
        target = Path(path) if path is not None else (self._folder or Path()) / "fields.html"
        notes = self._exported("html", target, every, fields, "viewed")
        view = View(target, notes, height)
        if not _in_notebook():
            view.open()
        return view

    def __reduce__(self) -> Any:
        if self._folder is None:
            raise PericlesError("results in memory cannot be pickled; give an output folder, whose results are pickled by path")
        return (Result.open, (os.fspath(self._folder.absolute()),))

    def __repr__(self) -> str:
        where = str(self._folder) if self._folder is not None else "in memory"
        count = len(self.times)
        return f"<pericles.Result {where}: {self._report.get('status')}, {count} outputs of {', '.join(self.fields) or 'no fields'}>"

    def _repr_html_(self) -> str:
        title = f"Result {self._folder or 'in memory'}: {self._report.get('status')}"
        audit = {**(self._report.get("audit") or {}), "warnings": self.warnings}
        return table_html(title, audit)


class View:
    """A page that shows the fields of a run.

    Attributes
    ----------
    path : Path
        The file.
    notes : list of str
        What was left out of the page.
    """

    #: Larger pages are not copied into notebooks, bytes.
    _LARGEST = 100_000_000

    def __init__(self, path: Path, notes: list[str], height: int) -> None:
        self.path = path
        self.notes = notes
        self._height = height

    def open(self) -> bool:
        """Open the page in the browser; return whether there is one."""
        import webbrowser

        return webbrowser.open(self.path.absolute().as_uri())

    def _repr_html_(self) -> str:
        import html

        size = self.path.stat().st_size
        if size > self._LARGEST:
            return f"<p>{html.escape(str(self.path))} has {size / 1e6:.0f} MB: too large for a notebook. Open it in a browser.</p>"
        page = html.escape(self.path.read_text(encoding="utf-8"), quote=True)
        style = f"width: 100%; height: {self._height}px; border: 1px solid #ccc"
        return f'<iframe sandbox="allow-scripts allow-downloads" style="{style}" srcdoc="{page}"></iframe>'

    def __repr__(self) -> str:
        return f"<pericles.View {self.path}>"


def _in_notebook() -> bool:
    """Return whether a notebook shows the value of a cell."""
    import sys

    module = sys.modules.get("IPython")
    shell = module.get_ipython() if module is not None else None
    return getattr(shell, "kernel", None) is not None


#: Signs of the corners of a line (2), square (4) or cube (8), in the order of VTK.
_SIGNS = ((-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1))


def _draw_squares(ax: Any, cells: tuple[Any, Any, Any], factor: float, values: Any, colours: dict[str, Any]) -> Any:
    """Draw the cells of a plane body; return the collection."""
    from matplotlib.collections import PolyCollection

    _, x, sides = cells
    x, half = factor * x, factor * sides / 2
    squares = x[:, None, :] + half[:, None, :] * np.array(_SIGNS[:4])[:, :2]
    # Edges close the gaps of rounding between deformed squares. Rasterised: a PDF of 100 000 squares is slow to show.
    drawn = PolyCollection(list(squares), array=values, cmap=colours["cmap"], rasterized=True)
    drawn.set(clim=colours["clim"], edgecolor="face", linewidth=0.5)
    ax.add_collection(drawn, autolim=False)
    margin = half.max() + 0.02 * np.ptp(x, axis=0).max()
    ax.set_xlim(x[:, 0].min() - margin, x[:, 0].max() + margin)
    ax.set_ylim(x[:, 1].min() - margin, x[:, 1].max() + margin)
    ax.set_aspect("equal")
    return drawn


def _draw_faces(ax: Any, cells: tuple[Any, Any, Any], factor: float, values: Any, colours: dict[str, Any]) -> Any:
    """Draw the outer faces of the cells of a three-dimensional body; return the collection."""
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    reference, x, sides = cells
    points, corners = outer_faces(reference, sides)
    polygons = factor * (x[points][:, None, :] + sides[points][:, None, :] / 2 * corners)
    drawn = Poly3DCollection(list(polygons), cmap=colours["cmap"], rasterized=True)
    drawn.set_array(values[points])
    ax.add_collection3d(drawn)
    drawn.set(clim=colours["clim"], edgecolor="face", linewidth=0.2)
    low, high = polygons.min(axis=(0, 1)), polygons.max(axis=(0, 1))
    ax.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    ax.locator_params(nbins=5)
    ax.set_box_aspect(np.maximum(high - low, 1e-3 * (high - low).max()))
    return drawn


def outer_faces(points: Any, sides: Any) -> tuple[Any, Any]:
    """Return the faces of cells that no other cell shares: their points, and the signs of their four corners."""
    signs = np.array(_SIGNS)
    numbers, corners, centres = [], [], []
    # Centres of shared faces differ by rounding only.
    grain = 1e-3 * sides.min()
    for axis in range(3):
        for side in (-1, 1):
            face = signs[signs[:, axis] == side]
            # In the order of a circuit.
            others = [other for other in range(3) if other != axis]
            face = face[np.argsort(np.arctan2(face[:, others[1]], face[:, others[0]]))]
            normal = np.zeros(3)
            normal[axis] = side
            centres.append(np.round((points + sides / 2 * normal) / grain).astype(np.int64))
            numbers.append(np.arange(len(points)))
            corners.append(np.broadcast_to(face, (len(points), 4, 3)))
    _, place, count = np.unique(np.concatenate(centres), axis=0, return_inverse=True, return_counts=True)
    single = count[place.reshape(-1)] == 1
    return np.concatenate(numbers)[single], np.concatenate(corners)[single]


def _length_unit(x: Any) -> tuple[float, str]:
    """Return factor and unit in which a body has a size between 1 and 1000."""
    size = float(np.ptp(x, axis=0).max())
    for factor, unit in ((1.0, "m"), (1e3, "mm"), (1e6, "µm"), (1e9, "nm")):
        if size * factor >= 1.0:
            return factor, unit
    return 1.0, "m"


def _engineering(value: float, unit: str) -> str:
    """Return a number with a prefix of its unit."""
    for factor, prefix in ((1.0, ""), (1e3, "m"), (1e6, "µ"), (1e9, "n")):
        if abs(value) * factor >= 1.0:
            return f"{value * factor:.4g} {prefix}{unit}"
    return f"{value:.4g} {unit}"


def _padded(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return vectors with three components."""
    out = np.zeros((len(vectors), 3))
    out[:, : vectors.shape[1]] = vectors
    return out
