#!/usr/bin/env python3
"""Reads a series written by Pericles with two independent readers and compares them.

    python3 validation/vtk/check.py branching/fields.pvd

VTK itself and meshio must agree bit for bit on every array of every output. Exit status 0 if all is well, 1 on any difference,
2 if the check could not be made. See README.md.
"""

import argparse
import os
import subprocess
import sys
import tempfile
import venv
import xml.etree.ElementTree as ElementTree
from pathlib import Path

PACKAGES = ["vtk", "meshio", "numpy"]
# VTK's and meshio's names of the cells that Pericles writes.
CELL_TYPES = {1: "vertex", 3: "line", 5: "triangle", 9: "quad", 12: "hexahedron"}


def in_environment(folder):
    """Runs this script again inside a virtual environment that has the readers, created on first use."""
    python = folder / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    if not python.exists():
        print(f"creating a virtual environment in {folder}", file=sys.stderr)
        venv.create(folder, with_pip=True)
    if subprocess.run([python, "-c", "import vtk, meshio, numpy"], capture_output=True).returncode:
        if subprocess.run([python, "-m", "pip", "install", "--quiet", *PACKAGES]).returncode:
            sys.exit(2)
    environment = dict(os.environ, PERICLES_VTK_CHECK="1")
    sys.exit(subprocess.run([python, __file__, *sys.argv[1:]], env=environment).returncode)


def read_with_vtk(path):
    """Time, points, cell types and fields read by VTK."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

    complaints = []
    reader = vtkXMLUnstructuredGridReader()
    reader.AddObserver("ErrorEvent", lambda *_: complaints.append("VTK reports an error"))
    reader.AddObserver("WarningEvent", lambda *_: complaints.append("VTK reports a warning"))
    reader.SetFileName(str(path))
    reader.Update()
    grid = reader.GetOutput()
    time = grid.GetFieldData().GetArray("TimeValue")
    if time is None:
        complaints.append("VTK finds no TimeValue")
    fields = {}
    for place, data in [("point", grid.GetPointData()), ("cell", grid.GetCellData())]:
        for k in range(data.GetNumberOfArrays()):
            fields[place, data.GetArrayName(k)] = vtk_to_numpy(data.GetArray(k))
    points = grid.GetPoints()
    return {
        "time": time.GetValue(0) if time is not None else None,
        "points": vtk_to_numpy(points.GetData()) if points else None,
        "cells": [CELL_TYPES.get(grid.GetCellType(k)) for k in range(grid.GetNumberOfCells())],
        "fields": fields,
    }, complaints


def read_with_meshio(path):
    """The same, read by meshio."""
    import meshio
    import numpy

    mesh = meshio.read(path)
    cells = [block.type for block in mesh.cells for _ in block.data]
    fields = {("point", name): values for name, values in mesh.point_data.items()}
    for name, blocks in mesh.cell_data.items():
        fields["cell", name] = numpy.concatenate(blocks)
    return {"points": mesh.points, "cells": cells, "fields": fields}


def check_file(path, time):
    """Table rows and errors of one output."""
    import numpy

    by_vtk, complaints = read_with_vtk(path)
    by_meshio = read_with_meshio(path)
    if by_vtk["points"] is None:
        return [], complaints + ["VTK finds no points"]
    if by_vtk["time"] != time:
        complaints.append(f"TimeValue is {by_vtk['time']!r}, the collection says {time!r}")
    counts = {"point": len(by_vtk["points"]), "cell": len(by_vtk["cells"])}
    if by_vtk["cells"] != by_meshio["cells"] or None in by_vtk["cells"]:
        complaints.append("VTK and meshio find different cells, or cells of an unexpected type")
    names = list(by_vtk["fields"])
    if sorted(names) != sorted(by_meshio["fields"]):
        complaints.append(f"VTK finds the fields {names}, meshio {list(by_meshio['fields'])}")

    rows = []
    pairs = [(("point", "(points)"), by_vtk["points"], by_meshio["points"])]
    pairs += [(name, by_vtk["fields"][name], by_meshio["fields"].get(name)) for name in names]
    for (place, name), one, other in pairs:
        count = counts[place]
        other = numpy.zeros(0) if other is None else numpy.asarray(other)
        one = numpy.asarray(one)
        equal = (
            one.dtype == other.dtype.newbyteorder("=")
            and one.shape == other.shape
            and numpy.ascontiguousarray(one).tobytes() == numpy.ascontiguousarray(other).tobytes()
        )
        finite = bool(numpy.isfinite(one).all())
        if len(one) != count:
            complaints.append(f"{name} has {len(one)} values for {count} {place}s")
        if not equal:
            complaints.append(f"VTK and meshio read {name} differently")
        if not finite:
            complaints.append(f"{name} holds values that are not finite")
        span = (one.min(), one.max()) if one.size else (numpy.nan, numpy.nan)
        rows.append((f"{name} ({place})", str(one.dtype), "×".join(map(str, one.shape)), *span, equal, finite))
    return rows, complaints


def read_collection(path):
    """Times and files of a .pvd, or the one file of a .vtu."""
    if path.suffix == ".vtu":
        return [(read_with_vtk(path)[0]["time"], path)], []
    complaints = []
    entries = ElementTree.parse(path).getroot().find("Collection").findall("DataSet")
    outputs = [(float(e.get("timestep")), path.parent / e.get("file")) for e in entries]
    times = [time for time, _ in outputs]
    if any(later <= earlier for earlier, later in zip(times, times[1:])):
        complaints.append(f"the times do not increase: {times}")
    if not outputs:
        complaints.append("the collection is empty")
    return outputs, complaints


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("series", type=Path, help="a fields.pvd, or a single .vtu")
    parser.add_argument(
        "--venv",
        type=Path,
        default=Path(tempfile.gettempdir()) / "pericles-vtk-check",
        help="virtual environment for the readers, created if missing (default: %(default)s)",
    )
    arguments = parser.parse_args()
    try:
        import meshio  # noqa: F401
        import numpy  # noqa: F401
        import vtk  # noqa: F401
    except ImportError:
        if os.environ.get("PERICLES_VTK_CHECK"):
            raise
        in_environment(arguments.venv)

    try:
        outputs, complaints = read_collection(arguments.series)
    except (OSError, ElementTree.ParseError, AttributeError) as error:
        print(f"{arguments.series} cannot be read as a PVD collection: {error}", file=sys.stderr)
        sys.exit(2)
    for complaint in complaints:
        print(f"  WRONG: {complaint}")
    failed = bool(complaints)
    layout = None
    for time, path in outputs:
        print(f"{path.name}  t = {time!r} s")
        if not path.exists():
            print("  WRONG: the file is missing")
            failed = True
            continue
        try:
            rows, complaints = check_file(path, time)
        except Exception as error:  # whatever a reader throws at a bad file
            rows, complaints = [], [f"the file cannot be read: {error}"]
        for name, kind, shape, low, high, equal, finite in rows:
            verdict = "equal" if equal and finite else "WRONG"
            print(f"  {name:<32} {kind:<8} {shape:>12}  {low:>13.6g} … {high:<13.6g} {verdict}")
        these = [row[:3] for row in rows]
        if layout is not None and these != layout:
            complaints.append("fields or sizes differ from those of the first output")
        layout = layout or these
        for complaint in complaints:
            print(f"  WRONG: {complaint}")
        failed = failed or bool(complaints)
    print(f"{len(outputs)} outputs: " + ("DIFFERENCES" if failed else "VTK and meshio agree"))
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
