"""Checks that Pericles reads what gmsh, meshio, netCDF and VTK write: check_meshes.py MESH_INFO, the program of the example mesh_info of pericles-mesh.

Two boxes of side 1 that share a face, in tetrahedra of first and second order: volume 2, a group for each box, one for both, and the face x = 0 of area 1.
"""
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import gmsh
import meshio
import netCDF4
import numpy as np
import vtk

program = sys.argv[1]
folder = Path(tempfile.mkdtemp())


def report(path):
    text = subprocess.run([program, str(path)], capture_output=True, text=True, check=True).stdout
    assert "rejected" not in text, text
    sets = {}
    for body in re.findall(r"SetSummary \{(.*?)\n        \}", text, re.S):
        area = re.search(r"area: Some\(\s*([-0-9.e]+)", body)
        sets[re.search(r'name: "(.*)"', body)[1]] = (int(re.search(r"points: (\d+)", body)[1]), float(area[1]) if area else None)
    return int(re.search(r"^    points: (\d+)", text, re.M)[1]), float(re.search(r"volume: ([-0-9.e]+)", text)[1]), sets


def boxes(name, size, order):
    gmsh.clear()
    occ, model = gmsh.model.occ, gmsh.model
    occ.fragment([(3, occ.addBox(0, 0, 0, 1, 1, 1))], [(3, occ.addBox(1, 0, 0, 1, 1, 1))])
    occ.synchronize()
    volumes = [tag for _, tag in model.getEntities(3)]
    faces = [tag for _, tag in model.getEntities(2) if abs(occ.getCenterOfMass(2, tag)[0]) < 1e-9]
    for tag, (word, members) in enumerate([("left part", volumes[:1]), ("right", volumes[1:]), ("all", volumes)], 1):
        model.addPhysicalGroup(3, members, tag, word)
    model.addPhysicalGroup(2, faces, 7, "x0")
    gmsh.option.setNumber("Mesh.MeshSizeMax", size)
    gmsh.option.setNumber("Mesh.MeshSizeMin", size)
    model.mesh.generate(3)
    model.mesh.setOrder(order)
    count = sum(len(tags) for tags in model.mesh.getElements(3)[1])
    paths = []
    for version in (2.2, 4.1):
        for binary in (0, 1):
            gmsh.option.setNumber("Mesh.MshFileVersion", version)
            gmsh.option.setNumber("Mesh.Binary", binary)
            paths.append(folder / f"{name}-{version}-{binary}.msh")
            gmsh.write(str(paths[-1]))
    gmsh.option.setNumber("Mesh.Binary", 0)
    gmsh.option.setNumber("Mesh.SaveGroupsOfNodes", 1)
    gmsh.option.setNumber("Mesh.SaveGroupsOfElements", 1)
    paths.append(folder / f"{name}.inp")
    gmsh.write(str(paths[-1]))
    for path in paths:
        points, volume, sets = report(path)
        assert points == count and abs(volume - 2) < 1e-12, (path, points, count, volume)
        left = "left_part" if path.suffix == ".inp" else "left part"
        assert sets[left][0] + sets["right"][0] == sets["all"][0] == count, sets
        assert abs(sets["x0"][1] - 1) < 1e-12, sets
        print(f"{path.name}: {points} points, volume and sets as expected")
    return paths[2]


gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
first = boxes("first", 0.35, 1)
boxes("second", 0.5, 2)
mesh = meshio.read(first)
cells = np.vstack([block.data for block in mesh.cells if block.type == "tetra"])
# A tetrahedron in two groups appears twice in meshio's blocks.
cells = np.unique(cells, axis=0)
plain = meshio.Mesh(mesh.points, [("tetra", cells)])
meshio.write(folder / "meshio.vtu", plain)
# meshio writes netCDF-4. Pericles reads it with the feature netcdf4, and otherwise rejects it and prints the conversion command. Here it is converted to CDF-1, CDF-2 and CDF-5.
meshio.write(folder / "meshio.exo", plain, file_format="exodus")
answer = subprocess.run([program, str(folder / "meshio.exo")], capture_output=True, text=True, check=True).stdout
paths = [folder / "meshio.vtu"]
if "rejected" in answer:
    assert "nccopy -k cdf5" in answer and "feature netcdf4" in answer, answer
    print("meshio.exo: netCDF-4, rejected with the conversion command")
else:
    paths.append(folder / "meshio.exo")
source = netCDF4.Dataset(folder / "meshio.exo")
for form in ("NETCDF3_CLASSIC", "NETCDF3_64BIT_OFFSET", "NETCDF3_64BIT_DATA"):
    paths.append(folder / f"{form}.exo")
    target = netCDF4.Dataset(paths[-1], "w", format=form)
    for name, dimension in source.dimensions.items():
        if name == "time_step" or len(dimension):
            target.createDimension(name, None if name == "time_step" else len(dimension))
    for name, variable in source.variables.items():
        if all(dimension in target.dimensions for dimension in variable.dimensions):
            kind = np.int32 if variable.dtype == np.int64 else variable.dtype
            copy = target.createVariable(name, kind, variable.dimensions)
            copy.setncatts({key: variable.getncattr(key) for key in variable.ncattrs()})
            if variable.size:
                copy[:] = variable[:]
    target.close()
for path in paths:
    points, volume, _ = report(path)
    assert points == len(cells) and abs(volume - 2) < 1e-12, (path, points, volume)
    print(f"{path.name}: {points} points, volume as expected")

grid = vtk.vtkUnstructuredGrid()
points = vtk.vtkPoints()
for x in [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1), (2, 0, 0), (2, 0, 1)]:
    points.InsertNextPoint(*x)
grid.SetPoints(points)
for kind, corners in ((vtk.VTK_HEXAHEDRON, range(8)), (vtk.VTK_WEDGE, (1, 8, 2, 5, 9, 6))):
    grid.InsertNextCell(kind, len(corners), list(corners))
for name, mode, compressed in (("ascii", 0, True), ("binary", 1, True), ("appended", 2, True), ("raw", 2, False)):
    writer = vtk.vtkXMLUnstructuredGridWriter()
    writer.SetFileName(str(folder / f"vtk-{name}.vtu"))
    writer.SetInputData(grid)
    writer.SetDataMode(mode)
    if not compressed:
        writer.SetCompressorTypeToNone()
    writer.Write()
    count, volume, _ = report(folder / f"vtk-{name}.vtu")
    assert count == 2 and abs(volume - 1.5) < 1e-14
    print(f"vtk-{name}.vtu: 2 points, volume as expected")

# VTK's Exodus writer, in a separate process: `import vtk` replaces the serial writer by the parallel one, which crashes without a controller.
subprocess.run([sys.executable, str(Path(__file__).with_name("vtk_exodus.py")), str(folder)], check=True)
for name in ("grid", "blocks"):
    count, volume, sets = report(folder / f"vtk-{name}.exo")
    assert count == 2 and abs(volume - 1.5) < 1e-14, (count, volume)
    assert sorted(points for points, _ in sets.values()) == [1, 1], sets
    print(f"vtk-{name}.exo: 2 points in blocks {sorted(sets)}, volume as expected")
