"""Writes a hexahedron and a wedge with VTK's serial writer of Exodus: vtk-grid.exo from one grid, vtk-blocks.exo from a multi-block data set.

    python validation/formats/vtk_exodus.py FOLDER
"""

import sys

from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import VTK_HEXAHEDRON, VTK_WEDGE, vtkMultiBlockDataSet, vtkUnstructuredGrid
from vtkmodules.vtkIOExodus import vtkExodusIIWriter

NODES = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1), (2, 0, 0), (2, 0, 1)]
CELLS = [(VTK_HEXAHEDRON, range(8)), (VTK_WEDGE, (1, 8, 2, 5, 9, 6))]

points = vtkPoints()
for x in NODES:
    points.InsertNextPoint(*x)


def grid(cells):
    result = vtkUnstructuredGrid()
    result.SetPoints(points)
    for kind, corners in cells:
        result.InsertNextCell(kind, len(corners), list(corners))
    return result


blocks = vtkMultiBlockDataSet()
for number, cell in enumerate(CELLS):
    blocks.SetBlock(number, grid([cell]))
for name, data in (("grid", grid(CELLS)), ("blocks", blocks)):
    writer = vtkExodusIIWriter()
    writer.SetFileName(f"{sys.argv[1]}/vtk-{name}.exo")
    writer.SetInputData(data)
    writer.Write()
