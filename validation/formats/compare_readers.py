"""Compares the reading times of Pericles and meshio, measured in alternation: compare_readers.py MESH_INFO [ROUNDS], the program of the example mesh_info of pericles-mesh.

A cube of 6 · 50³ tetrahedra as Gmsh 4.1 (binary), Gmsh 2.2 (text), Abaqus, and Exodus (CDF-2 for Pericles; netCDF-4 for meshio, which writes no other). Prints the median of the ratios.
"""
import re
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import meshio
import netCDF4
import numpy as np

program = sys.argv[1]
rounds = int(sys.argv[2]) if len(sys.argv) > 2 else 3
folder = Path(tempfile.mkdtemp())

n = 50
x = np.arange(n + 1) / n
points = np.stack(np.meshgrid(x, x, x, indexing="ij"), -1).reshape(-1, 3)
at = lambda i, j, k: (i * (n + 1) + j) * (n + 1) + k
i, j, k = (a.ravel() for a in np.meshgrid(*[np.arange(n)] * 3, indexing="ij"))
c = [at(i + a, j + b, k + d) for d, b, a in [(0, 0, 0), (0, 0, 1), (0, 1, 1), (0, 1, 0), (1, 0, 0), (1, 0, 1), (1, 1, 1), (1, 1, 0)]]
tets = [[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]]
cells = np.concatenate([np.stack([c[corner] for corner in tet], 1) for tet in tets])
mesh = meshio.Mesh(points, [("tetra", cells)])


def exodus(path):
    """The same in CDF-2: what meshio does not write."""
    file = netCDF4.Dataset(path, "w", format="NETCDF3_64BIT_OFFSET")
    for name, size in [("num_dim", 3), ("num_nodes", len(points)), ("num_elem", len(cells)), ("num_el_blk", 1), ("num_el_in_blk1", len(cells)), ("num_nod_per_el1", 4)]:
        file.createDimension(name, size)
    for axis, name in enumerate("xyz"):
        file.createVariable("coord" + name, "f8", ("num_nodes",))[:] = points[:, axis]
    file.createVariable("eb_prop1", "i4", ("num_el_blk",))[:] = [1]
    connect = file.createVariable("connect1", "i4", ("num_el_in_blk1", "num_nod_per_el1"))
    connect.elem_type = "TETRA"
    connect[:] = cells + 1
    file.close()


files = []
for name, form, options in [
    ("gmsh 4.1, binary", "gmsh", {"binary": True}),
    ("gmsh 2.2, text", "gmsh22", {"binary": False}),
    ("Abaqus", "abaqus", {}),
    ("Exodus", "exodus", {}),
]:
    path = folder / (form + {"gmsh": ".msh", "gmsh22": ".msh", "abaqus": ".inp", "exodus": ".exo"}[form])
    meshio.write(path, mesh, file_format=form, **options)
    ours = path
    if form == "exodus":
        ours = folder / "cdf2.exo"
        exodus(ours)
    files.append((name, form, ours, path))

times = {name: [] for name, *_ in files}
for _ in range(rounds):
    for name, form, ours, theirs in files:
        text = subprocess.run([program, str(ours)], capture_output=True, text=True, check=True).stdout
        assert re.search(rf"^    points: {len(cells)},", text, re.M), text[:500]
        own = float(re.search(r"read in ([0-9.]+) s", text)[1])
        begin = time.perf_counter()
        found = meshio.read(theirs, file_format="gmsh" if form == "gmsh22" else form)
        other = time.perf_counter() - begin
        assert sum(len(block.data) for block in found.cells) == len(cells)
        times[name].append((own, other))
print(f"{len(cells)} tetrahedra, {rounds} rounds in alternation, meshio {meshio.__version__}")
for name, pairs in times.items():
    own, other = (statistics.median(t) for t in zip(*pairs))
    least = [min(t) for t in zip(*pairs)]
    ratio = statistics.median(a / b for a, b in pairs)
    print(f"{name}: Pericles {own:.3f} s, meshio {other:.3f} s (least {least[0]:.3f} and {least[1]:.3f}), ratio {ratio:.2f}")
