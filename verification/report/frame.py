"""Frames of a lattice, as latcon writes them for ParaView."""
from dataclasses import dataclass
from xml.etree import ElementTree

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkObject
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

from files import DamagedFile, read_text

FIELDS = ("velocity", "cauchy_stress", "damage", "site")  # read where they are


@dataclass(frozen=True)
class Frame:
    """Sites and bonds of a sheet at one time."""

    time: float  # [s]
    reference: np.ndarray  # (sites, 2) undeformed positions [m]
    position: np.ndarray  # (sites, 2) current positions [m]
    bonds: np.ndarray  # (bonds, 2) sites at the ends; none in light frames
    stretch: np.ndarray  # (bonds) current over undeformed length [-]
    fields: dict  # of FIELDS, as they are in the file, SI units


def read_series(path):
    """What a .pvd names: [(time [s], file), ...]; None if there is no such file."""
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
    """The last frame that lattice.pvd names and that is there; None if there is none."""
    for time, path in reversed(read_series(folder / "lattice.pvd") or []):
        if path.exists():
            return read_frame(path, time)
    return None


def read_frame(path, time, with_bonds=True):
    """One vtp file; only the arrays that the pictures need are read."""
    vtkObject.GlobalWarningDisplayOff()  # what is wrong is said once, below
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    needed = [(reader.GetPointDataArraySelection(), "displacement")]
    needed += [(reader.GetCellDataArraySelection(), "stretch")] if with_bonds else []
    for selection, wanted in needed:
        if not selection.ArrayExists(wanted):
            raise DamagedFile(path, f"no VTK file of a lattice: it has no array {wanted!r}")
        selection.DisableAllArrays()
        selection.EnableArray(wanted)
    for name in FIELDS:
        if reader.GetPointDataArraySelection().ArrayExists(name):
            reader.GetPointDataArraySelection().EnableArray(name)
    reader.Update()
    sheet = reader.GetOutput()
    if sheet.GetNumberOfPoints() == 0 or with_bonds and sheet.GetNumberOfLines() == 0:  # VTK's answer to a broken file
        raise DamagedFile(path, "cut short, or without sites and bonds")
    reference = vtk_to_numpy(sheet.GetPoints().GetData())[:, :2].astype(float)
    position = reference + vtk_to_numpy(sheet.GetPointData().GetArray("displacement"))[:, :2]
    fields = {name: vtk_to_numpy(sheet.GetPointData().GetArray(name)) for name in FIELDS
              if sheet.GetPointData().GetArray(name) is not None}
    ends, stretch = np.empty(0, dtype=int), np.empty(0)
    if with_bonds:
        ends = vtk_to_numpy(sheet.GetLines().GetConnectivityArray())
        # Cell data counts the vertices first.
        stretch = vtk_to_numpy(sheet.GetCellData().GetArray("stretch"))[sheet.GetNumberOfVerts():]
    if len(ends) != 2 * len(stretch) or not np.isfinite(position).all() or not np.isfinite(stretch).all():
        raise DamagedFile(path, "its bonds or positions make no sense")
    return Frame(time, reference, position, ends.reshape(-1, 2), stretch, fields)
