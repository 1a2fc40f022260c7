# SPDX-License-Identifier: GPL-2.0-or-later
"""VTU files by VTK's own reader."""
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader


def read_vtu(path):
    """Positions, and arrays at the points by name."""
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    grid, data = reader.GetOutput(), reader.GetOutput().GetPointData()
    return (vtk_to_numpy(grid.GetPoints().GetData()).astype(float),
            {data.GetArrayName(k): vtk_to_numpy(data.GetArray(k)).astype(float)
             for k in range(data.GetNumberOfArrays())})
