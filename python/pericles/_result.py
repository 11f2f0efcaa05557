"""Results of runs."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _pericles
from ._errors import OutputError, PericlesError

if TYPE_CHECKING:
    import numpy as np
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


_SECONDS = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "\u00b5s": 1e-6, "\u03bcs": 1e-6, "ns": 1e-9, "ps": 1e-12, "min": 60.0, "h": 3600.0}


def seconds(time: float | str) -> float:
    """Return a time in seconds: a number, or a text with a unit as in decks."""
    if isinstance(time, str):
        number = re.fullmatch(r"\s*([-+0-9.eE]+)\s*(\S*)\s*", time)
        unit = _SECONDS.get(number.group(2) or "s") if number else None
        try:
            if number and unit is not None:
                return float(number.group(1)) * unit
        except ValueError:
            pass
    else:
        try:
            return float(time)
        except (TypeError, ValueError):
            pass
    units = ", ".join(name for name in _SECONDS if name.isascii())
    raise PericlesError(f"the time is {time!r}; allowed: a number in s, or a text with one of the units {units}, such as \"3 us\"")


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

    def to_pandas(self) -> Any:
        """Return a pandas DataFrame that shares the columns."""
        pandas = optional("pandas", "pandas")
        columns = {name: pandas.Series(values, copy=False) for name, values in self._columns.items()}
        return pandas.DataFrame(columns, copy=False)

    def to_polars(self) -> Any:
        """Return a polars DataFrame."""
        return optional("polars", "polars").DataFrame(dict(self._columns))

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
        return f"<pericles.Record: {', '.join(self._entries)}>"


class Result:
    """The results of a run, in a folder or in memory.

    Arrays have one row for each point in the user's order and are read-only views; copy them to change them.
    """

    _folder: Path | None
    _report: dict[str, Any]
    _files: list[tuple[float, Path]] | None
    _recording: Any
    _positions: Any
    _sides: Any
    _cache: dict[int, Any]

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
            raise OutputError(f"{folder} is not the output folder of a run: it has no run.json") from None
        except (OSError, ValueError) as error:
            raise OutputError(f"{path} cannot be used: {error}") from None
        result._files = None
        result._recording = None
        result._cache = {}
        return result

    @classmethod
    def of_simulation(cls, core: Any, model: Model) -> Result:
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
        result._report = {
            "status": "finished" if core.step == core.steps else "stopped",
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
    def info(self) -> Record:
        """The content of ``run.json``: status, model, progress, energy balance, deck."""
        return Record(self._report)

    @property
    def audit(self) -> Record:
        """Balance of energy and momentum at the end."""
        return Record(self._report.get("audit") or {})

    @property
    def warnings(self) -> list[str]:
        """Warnings about the model and the run."""
        model = (self._report.get("model") or {}).get("warnings") or []
        return [*model, *((self._report.get("audit") or {}).get("warnings") or [])]

    @property
    def history(self) -> Table:
        """Time histories of energies, momentum and broken bonds; further columns as requested by the deck."""
        if self._recording is not None:
            return Table(self._recording.history())
        return self.table("history")

    @property
    def tables(self) -> list[str]:
        """Names of the tables, such as "history", "probes" and "reactions"."""
        if self._folder is None:
            return ["history"]
        return sorted(path.stem for path in self._folder.glob("*.csv"))

    def table(self, name: str) -> Table:
        """Return a table by its name, such as ``"probes"``."""
        if self._folder is None:
            if name == "history":
                return self.history
            raise PericlesError(f"there is no table `{name}`; results in memory have: history")
        path = self._folder / f"{name}.csv"
        if not path.exists():
            raise PericlesError(f"there is no table `{name}`; the run wrote: {', '.join(self.tables) or 'none'}")
        return Table(_pericles.read_table(path))

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

    def _file(self, output: int) -> Any:
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
        return self._file(self._output(None, None)).field("Points")[:, : self._dimension]

    @property
    def _dimension(self) -> int:
        return int((self._report.get("model") or {}).get("dimension") or 3)

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
            Shape (n, components), or (n,) for scalars; read-only, without a copy.
        """
        index = self._output(time, output)
        if self._recording is not None:
            found = self._recording.field(name, index)
            if found is None:
                raise PericlesError(f"the field `{name}` was not kept; kept: {', '.join(self.fields)}")
            return found
        file = self._file(index)
        names = {known.lower(): known for known in file.names()}
        if name.lower() not in names or name.lower() == "points":
            raise PericlesError(f"there is no field `{name}`; the run wrote: {', '.join(sorted(set(names) - {'points'}))}")
        values = file.field(names[name.lower()])
        if values.shape[1] == 1:
            return values.reshape(-1)
        return values[:, : self._dimension] if values.shape[1] == 3 else values

    def to_pyvista(self, *, time: float | str | None = None, output: int | None = None, cells: bool = True) -> Any:
        """Return all fields of an output as a PyVista data set.

        Parameters
        ----------
        time, output : float or int, optional
            The output; by default the last.
        cells : bool
            For results in memory: fields on the cells of the points, as lines, squares or cubes, or on the points alone.
            Results in a folder are returned as the run wrote them: on cells for grids and meshes.
        """
        pyvista = optional("pyvista", "pyvista")
        index = self._output(time, output)
        if self._recording is None:
            return pyvista.read(self._series()[index][1])
        if cells and self._sides is not None:
            dimension = self._dimension
            signs = np.array(_SIGNS[: 2**dimension])[:, :dimension]
            corners = self.points[:, None, :] + self._sides[:, None, :] / 2 * signs
            numbers = np.arange(corners.shape[0] * len(signs)).reshape(-1, len(signs))
            kind = {1: pyvista.CellType.LINE, 2: pyvista.CellType.QUAD, 3: pyvista.CellType.HEXAHEDRON}[dimension]
            mesh = pyvista.UnstructuredGrid({kind: numbers}, _padded(corners.reshape(-1, dimension)))
            data = mesh.cell_data
        else:
            mesh = pyvista.PolyData(_padded(self.points))
            data = mesh.point_data
        for name in self.fields:
            values = self.field(name, output=index)
            shown = "_".join(word.capitalize() for word in name.split("_"))
            data[shown] = values if values.ndim == 1 or values.shape[1] > 3 else _padded(values)
        return mesh

    def to_meshio(self, *, time: float | str | None = None, output: int | None = None) -> Any:
        """Return the points with all fields of an output as a meshio mesh of vertices."""
        meshio = optional("meshio", "all")
        index = self._output(time, output)
        points = self.points
        data = {}
        for name in self.fields:
            values = np.array(self.field(name, output=index))
            data[name] = values if values.ndim == 1 or values.shape[1] > 3 else _padded(values)
        cells = [("vertex", np.arange(len(points)).reshape(-1, 1))]
        return meshio.Mesh(_padded(points), cells, point_data=data)

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
        ax: Any = None,
    ) -> Any:
        """Draw a field of a bar or plane body with Matplotlib; return the axes.

        The points of a plane body are drawn as squares with the sides of their cells.

        Parameters
        ----------
        field : str
            The field.
        component : int or str, optional
            The component of a vector or tensor, such as ``0`` or ``"x"``; by default the magnitude.
        time, output : float or int, optional
            The output; by default the last.
        scale : float
            Factor of the displacements by which the points are moved, if they are there; 0 draws the undeformed body.
        range : pair of float, optional
            Values at the ends of the colours; by default the least and the largest value, 0 and 1 for damage.
        cmap : str, optional
            The colour map of Matplotlib.
        ax : matplotlib.axes.Axes, optional
            The axes to draw in; by default the current ones.
        """
        pyplot = optional("matplotlib.pyplot", "all")
        values, label = _component(self.field(field, time=time, output=output), field, component)
        x = np.array(self.points)
        if x.shape[1] == 3:
            raise PericlesError("plot draws bars and plane bodies; draw three-dimensional bodies with to_pyvista()")
        if scale and "displacement" in self.fields:
            x = x + scale * np.asarray(self.field("displacement", time=time, output=output)).reshape(x.shape)
        ax = ax or pyplot.gca()
        factor, unit = _length_unit(x)
        x = factor * x
        unit_of_values = _pericles.field_unit(field)
        label = f"{label} ({unit_of_values})" if unit_of_values else label
        at = self.times[self._output(time, output)]
        ax.set_title(f"t = {_engineering(at, 's')}", fontsize="medium")
        ax.set_xlabel(f"x ({unit})")
        if x.shape[1] == 1:
            order = np.argsort(x[:, 0])
            ax.plot(x[order, 0], values[order], ".-", markersize=3, linewidth=0.8)
            ax.set_ylabel(label)
            return ax
        from matplotlib.collections import PolyCollection

        half = factor * self._cell_sides() / 2
        squares = x[:, None, :] + half[:, None, :] * np.array(_SIGNS[:4])[:, :2]
        low, high = range or ((0.0, 1.0) if field == "damage" else (float(values.min()), float(values.max())))
        # Edges close the gaps of rounding between deformed squares. Rasterised: a PDF of 100 000 squares is slow to show.
        drawn = PolyCollection(squares, array=values, cmap=cmap, rasterized=True)
        drawn.set(clim=(low, high), edgecolor="face", linewidth=0.5)
        ax.add_collection(drawn, autolim=False)
        margin = half.max() + 0.02 * np.ptp(x, axis=0).max()
        ax.set_xlim(x[:, 0].min() - margin, x[:, 0].max() + margin)
        ax.set_ylim(x[:, 1].min() - margin, x[:, 1].max() + margin)
        ax.set_aspect("equal")
        ax.set_ylabel(f"y ({unit})")
        # As high as the axes, whose height follows from the height of the body.
        beside = ax.inset_axes((1.03, 0.0, 0.03, 1.0))
        ax.figure.colorbar(drawn, cax=beside, label=label)
        return ax

    def _cell_sides(self) -> NDArray[np.float64]:
        """The sides of the cells of the points, m."""
        if self._recording is not None and self._sides is not None:
            return self._sides
        shape = (len(self.points), self._dimension)
        spacing = float((self._report.get("model") or {}).get("spacing") or 0.0)
        if "radius" in self.fields:
            return np.broadcast_to(2 * np.asarray(self.field("radius"))[:, None], shape)
        return np.full(shape, spacing)

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
        if self._folder is None:
            raise PericlesError("results in memory cannot be viewed; give an output folder, such as run(deck, out=\"results\")")
        if not any((self._folder / name).exists() for name in ("fields.pvd", "fields.exo", "fields.vtkhdf")):
            raise PericlesError("the run has no outputs of fields; request them under [output] of the deck")
        if every is not None and every < 1:
            raise PericlesError(f"every is {every}; allowed: an integer of at least 1")
        target = Path(path) if path is not None else self._folder / "fields.html"
        notes = _pericles.write_page(self._folder, target, every, list(fields))
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
        from ._model import table_html

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


def _component(values: Any, field: str, component: int | str | None) -> tuple[Any, str]:
    """Return a component, or the magnitude, of a field with its name."""
    name = field.replace("_", " ")
    if values.ndim == 1:
        return values, name
    if component is None:
        return (values[:, 0], name) if values.shape[1] == 1 else (np.linalg.norm(values, axis=1), f"{name}, magnitude")
    number = "xyz".find(component) if isinstance(component, str) and len(component) == 1 else component
    if not isinstance(number, int) or not 0 <= number < values.shape[1]:
        raise PericlesError(f"the field `{field}` has no component {component!r}; it has {values.shape[1]}, from 0")
    return values[:, number], f"{name}, {component}"


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
