#!/usr/bin/env python3
"""Writes the .vtr files of this folder with VTK itself (Debian's python3-vtk9; here 9.1).

Posts at x 0, 1, 3; y 10, 20; z -5, 5. Array T counts them from 0, S from 12. Run by hand.
"""

import pathlib

from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkFloatArray
from vtkmodules.vtkCommonDataModel import vtkRectilinearGrid
from vtkmodules.vtkIOXML import vtkXMLRectilinearGridWriter

HERE = pathlib.Path(__file__).parent


def array(kind, name, values):
    result = kind()
    result.SetName(name)
    for value in values:
        result.InsertNextValue(value)
    return result


def write(grid, name, mode, is_packed, is_64=False, is_big=False):
    writer = vtkXMLRectilinearGridWriter()
    writer.SetInputData(grid)
    writer.SetFileName(str(HERE / f"{name}.vtr"))
    getattr(writer, f"SetDataModeTo{mode.split()[0]}")()
    writer.SetEncodeAppendedData("raw" not in mode)
    getattr(writer, f"SetCompressorTypeTo{'ZLib' if is_packed else 'None'}")()
    getattr(writer, f"SetHeaderTypeToUInt{64 if is_64 else 32}")()
    getattr(writer, f"SetByteOrderTo{'Big' if is_big else 'Little'}Endian")()
    writer.Write()


grid = vtkRectilinearGrid()
grid.SetDimensions(3, 2, 2)
grid.SetXCoordinates(array(vtkDoubleArray, "x", [0, 1, 3]))
grid.SetYCoordinates(array(vtkDoubleArray, "y", [10, 20]))
grid.SetZCoordinates(array(vtkDoubleArray, "z", [-5, 5]))
grid.GetPointData().AddArray(array(vtkFloatArray, "T", range(12)))
grid.GetPointData().AddArray(array(vtkFloatArray, "S", range(12, 24)))
write(grid, "ascii", "Ascii", True)
write(grid, "inline_zlib", "Binary", True)
write(grid, "inline_plain", "Binary", False, is_64=True)
write(grid, "appended_base64_zlib", "Appended", True)
write(grid, "appended_base64_plain", "Appended", False, is_64=True)
write(grid, "appended_raw_zlib", "Appended raw", True, is_64=True)
write(grid, "appended_raw_big", "Appended raw", False, is_big=True)
