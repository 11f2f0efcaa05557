"""Checks that VTK, h5py and netCDF read the files of the example result_files of pericles-mesh: read_results.py FOLDER."""
import sys
from pathlib import Path

import h5py
import meshio
import netCDF4
import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

folder = Path(sys.argv[1])
n = 24
i = np.arange(n)
positions = np.stack([i % 2, i // 2 % 3, i // 6], axis=1).astype(float)
volumes = 1 + i / 100


def damage(k):
    return i + 100.0 * k


def displacement(k):
    return np.stack([i, 2 * i, 3 * i + k], axis=1).astype(float)


def check(name, found, expected):
    found = np.asarray(found)
    assert found.shape == np.shape(expected), (name, found.shape, np.shape(expected))
    assert np.array_equal(found, expected), (name, found, expected)


for ending, kind in (("64", np.float64), ("32", np.float32)):
    file = netCDF4.Dataset(folder / f"run{ending}.exo")
    check("times", file["time_whole"][:], [0, 0.5, 1])
    check("volumes", np.concatenate([file["attrib1"][:, 1], file["attrib2"][:, 1]]), volumes)
    check("globals", file["vals_glo_var"][:, 0], [0, 5, 10])
    names = ["".join(c.decode() for c in row).strip("\0") for row in file["name_nod_var"][:].filled(b"\0")]
    assert names == ["Damage", "DisplacementX", "DisplacementY", "DisplacementZ"], names
    for k in range(3):
        check("damage", file["vals_nod_var1"][k], damage(k))

    reader = vtk.vtkExodusIIReader()
    reader.SetFileName(str(folder / f"run{ending}.exo"))
    reader.ApplyDisplacementsOff()
    reader.UpdateInformation()
    reader.SetAllArrayStatus(vtk.vtkExodusIIReader.NODAL, 1)
    reader.SetAllArrayStatus(vtk.vtkExodusIIReader.NODE_SET, 1)
    reader.SetAllArrayStatus(vtk.vtkExodusIIReader.GLOBAL, 1)
    times = reader.GetOutputInformation(0).Get(vtk.vtkStreamingDemandDrivenPipeline.TIME_STEPS())
    check("times", times, [0, 0.5, 1])
    for k in range(3):
        reader.UpdateTimeStep(times[k])
        blocks = reader.GetOutput().GetBlock(0)
        sizes = []
        for b in range(blocks.GetNumberOfBlocks()):
            block = blocks.GetBlock(b)
            x = vtk_to_numpy(block.GetPoints().GetData())
            ids = np.array([np.flatnonzero((positions == p).all(1))[0] for p in x])
            check("damage", vtk_to_numpy(block.GetPointData().GetArray("Damage")), damage(k)[ids])
            check("displacement", vtk_to_numpy(block.GetPointData().GetArray("Displacement")), displacement(k)[ids])
            sizes.append((blocks.GetMetaData(b).Get(vtk.vtkCompositeDataSet.NAME()), len(x)))
        assert [s for _, s in sizes] == [10, 14], sizes
    print(f"Exodus {ending}: VTK {vtk.VTK_VERSION} and netCDF read all; blocks {sizes}; node sets",
          [reader.GetObjectName(vtk.vtkExodusIIReader.NODE_SET, s) for s in range(reader.GetNumberOfObjects(vtk.vtkExodusIIReader.NODE_SET))])

    # meshio reads the first output only, without volumes of spheres.
    mesh = meshio.read(folder / f"run{ending}.exo", file_format="exodus")
    check("points", mesh.points, positions)
    check("damage", mesh.point_data["Damage"], damage(0))
    check("displacement", mesh.point_data["Displacement"], displacement(0))
    check("blocks", [len(block.data) for block in mesh.cells], [10, 14])
    check("left", np.sort(mesh.point_sets["left"]), np.arange(6))
    print(f"Exodus {ending}: meshio {meshio.__version__} reads points, blocks, sets and the fields of the first output")

    file = h5py.File(folder / f"run{ending}.vtkhdf")
    root = file["VTKHDF"]
    check("version", root.attrs["Version"], [2, 0])
    assert root["Steps"].attrs["NSteps"] == 3
    check("times", root["Steps/Values"][:], [0, 0.5, 1])
    assert root["PointData/Damage"].dtype == kind
    for k in range(3):
        check("damage", root["PointData/Damage"][k * n:(k + 1) * n], damage(k))
        check("displacement", root["PointData/Displacement"][k * n:(k + 1) * n], displacement(k))
    check("points", root["Points"][:], positions)

    reader = vtk.vtkHDFReader()
    reader.SetFileName(str(folder / f"run{ending}.vtkhdf"))
    reader.UpdateInformation()
    times = reader.GetOutputInformation(0).Get(vtk.vtkStreamingDemandDrivenPipeline.TIME_STEPS())
    check("times", times, [0, 0.5, 1])
    for k in range(3):
        reader.UpdateTimeStep(times[k])
        grid = reader.GetOutputDataObject(0)
        check("points", vtk_to_numpy(grid.GetPoints().GetData()), positions)
        data = grid.GetPointData()
        check("damage", vtk_to_numpy(data.GetArray("Damage")), damage(k))
        check("displacement", vtk_to_numpy(data.GetArray("Displacement")), displacement(k))
        check("volume", vtk_to_numpy(data.GetArray("Volume")), volumes.astype(kind))
    print(f"VTKHDF {ending}: VTK {vtk.VTK_VERSION} and h5py {h5py.__version__} read all")
