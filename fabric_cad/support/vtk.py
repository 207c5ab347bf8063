"""The door to PyVista and VTK, which are loaded when they are needed, whole or not at all."""

from __future__ import annotations

from .interrupts import uninterrupted


def pyvista():
    """The package PyVista."""
    with uninterrupted():
        import pyvista

    return pyvista


def grid_writer():
    """VTK's writer of unstructured grids as ``.vtu``."""
    with uninterrupted():
        from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

    return vtkXMLUnstructuredGridWriter()


def image_writer():
    """VTK's writer of image data as ``.vti``, which compresses nothing."""
    with uninterrupted():
        from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

    writer = vtkXMLImageDataWriter()
    writer.SetCompressorTypeToNone()
    writer.EncodeAppendedDataOff()
    return writer
