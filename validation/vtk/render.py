#!/usr/bin/env python3
"""Renders a .vtu file like the default view of ParaView: representation "Surface", coloured by one array.

    python3 validation/vtk/render.py branching/fields/fields_000020.vtu branching.png --array Damage

Bodies in the plane are seen along z, bodies in space from the front right and above. Needs VTK (`pip install vtk`).
"""

import argparse

import vtkmodules.vtkRenderingOpenGL2  # noqa: F401  (registers the renderer)
from vtkmodules.vtkCommonCore import vtkLookupTable
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor
from vtkmodules.vtkRenderingCore import (
    vtkActor,
    vtkDataSetMapper,
    vtkRenderer,
    vtkRenderWindow,
    vtkWindowToImageFilter,
)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("file", help="a .vtu file")
    parser.add_argument("picture", help="the PNG file to write")
    parser.add_argument("--array", help="the array that colours the body (default: the first one)")
    arguments = parser.parse_args()

    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(arguments.file)
    reader.Update()
    grid = reader.GetOutput()
    data, use = grid.GetCellData(), "cell"
    if data.GetNumberOfArrays() == 0:
        data, use = grid.GetPointData(), "point"
    name = arguments.array or data.GetArrayName(0)
    array = data.GetArray(name)
    if array is None:
        parser.error(f"the file has no {use} array {name}")

    table = vtkLookupTable()
    table.SetHueRange(0.667, 0.0)
    if array.GetNumberOfComponents() > 1:
        table.SetVectorModeToMagnitude()
    table.Build()
    mapper = vtkDataSetMapper()
    mapper.SetInputData(grid)
    mapper.SetLookupTable(table)
    mapper.SetScalarRange(array.GetRange(-1))
    if use == "cell":
        mapper.SetScalarModeToUseCellFieldData()
    else:
        mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray(name)
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetPointSize(2)

    renderer = vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    renderer.AddActor(actor)
    bar = vtkScalarBarActor()
    bar.SetLookupTable(mapper.GetLookupTable())
    bar.SetTitle(name)
    bar.GetTitleTextProperty().SetColor(0, 0, 0)
    bar.GetLabelTextProperty().SetColor(0, 0, 0)
    renderer.AddViewProp(bar)
    bounds = grid.GetBounds()
    if bounds[5] > bounds[4]:
        camera = renderer.GetActiveCamera()
        camera.SetPosition(1.0, -2.0, 1.0)
        camera.SetFocalPoint(0.0, 0.0, 0.0)
        camera.SetViewUp(0.0, 0.0, 1.0)
    renderer.ResetCamera()
    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(900, 600)
    window.AddRenderer(renderer)
    window.Render()
    image = vtkWindowToImageFilter()
    image.SetInput(window)
    image.Update()
    writer = vtkPNGWriter()
    writer.SetFileName(arguments.picture)
    writer.SetInputData(image.GetOutput())
    writer.Write()


if __name__ == "__main__":
    main()
