"""Reader of the lattice frames that latcon writes for ParaView."""
import os
from dataclasses import dataclass
from xml.etree import ElementTree

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkObject
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

from files import DamagedFile, read_text

FIELDS = ("velocity", "cauchy_stress", "damage", "site")  # read if present


@dataclass(frozen=True)
class Frame:
    """Sites and bonds of a sheet at one time."""

    time: float  # [s]
    reference: np.ndarray  # (sites, 2) undeformed positions [m]
    position: np.ndarray  # (sites, 2) current positions [m]
    bonds: np.ndarray  # (bonds, 2) sites at the ends; none in reduced frames
    stretch: np.ndarray  # (bonds) current over undeformed length [-]
    fields: dict  # those of FIELDS in the file, SI units


def read_series(path):
    """Frames listed in a .pvd: [(time [s], file), ...]; None if there is no such file."""
    text = read_text(path)
    if text is None:
        return None
    try:
        return [(float(d.attrib["timestep"]), path.parent / d.attrib["file"])
                for d in ElementTree.fromstring(text).iter("DataSet")]
    except ElementTree.ParseError as error:
        raise DamagedFile(path, f"not XML: {error}") from error
    except (KeyError, ValueError) as error:
        raise DamagedFile(path, f"a DataSet lacks its time or file: {error}") from error


def read_last_frame(folder):
    """Reads the last existing frame listed in lattice.pvd; None if there is none."""
    for time, path in reversed(read_series(folder / "lattice.pvd") or []):
        if path.exists():
            return read_frame(path, time)
    return None


def read_frame(path, time, with_bonds=True):
    """Reads the arrays of a vtp file that the pictures need."""
    vtkObject.GlobalWarningDisplayOff()  # errors are reported once, below
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(os.fsencode(path))  # a name need not be UTF-8 text
    reader.UpdateInformation()
    needed = [(reader.GetPointDataArraySelection(), "displacement")]
    needed += [(reader.GetCellDataArraySelection(), "stretch")] if with_bonds else []
    for selection, wanted in needed:
        if not selection.ArrayExists(wanted):
            raise DamagedFile(path, f"not a VTK file of a lattice: array {wanted!r} is missing")
        selection.DisableAllArrays()
        selection.EnableArray(wanted)
    for name in FIELDS:
        if reader.GetPointDataArraySelection().ArrayExists(name):
            reader.GetPointDataArraySelection().EnableArray(name)
    reader.Update()
    sheet = reader.GetOutput()
    if sheet.GetNumberOfPoints() == 0 or with_bonds and sheet.GetNumberOfLines() == 0:  # VTK's result for a damaged file
        raise DamagedFile(path, "truncated, or without sites and bonds")
    reference = vtk_to_numpy(sheet.GetPoints().GetData())[:, :2].astype(float)
    position = reference + vtk_to_numpy(sheet.GetPointData().GetArray("displacement"))[:, :2]
    fields = {name: vtk_to_numpy(sheet.GetPointData().GetArray(name)) for name in FIELDS
              if sheet.GetPointData().GetArray(name) is not None}
    ends, stretch = np.empty(0, dtype=int), np.empty(0)
    if with_bonds:
        ends = vtk_to_numpy(sheet.GetLines().GetConnectivityArray())
        # Cell data begin with the vertices.
        stretch = vtk_to_numpy(sheet.GetCellData().GetArray("stretch"))[sheet.GetNumberOfVerts():]
    if len(ends) != 2 * len(stretch) or not np.isfinite(position).all() or not np.isfinite(stretch).all():
        raise DamagedFile(path, "its bonds or positions are inconsistent")
    return Frame(time, reference, position, ends.reshape(-1, 2), stretch, fields)
