"""The last frame of a lattice, as latcon writes it for ParaView."""
from dataclasses import dataclass
from xml.etree import ElementTree

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkObject
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

from files import DamagedFile, read_text


@dataclass(frozen=True)
class Frame:
    """Sites and bonds of a sheet at one time."""

    time: float  # [s]
    position: np.ndarray  # (sites, 2) current positions [m]
    bonds: np.ndarray  # (bonds, 2) sites at the ends
    stretch: np.ndarray  # (bonds) current over undeformed length [-]


def read_last_frame(folder):
    """The last frame that lattice.pvd names and that is there; None if there is none."""
    path = folder / "lattice.pvd"
    text = read_text(path)
    if text is None:
        return None
    try:
        frames = [(float(d.attrib["timestep"]), d.attrib["file"]) for d in ElementTree.fromstring(text).iter("DataSet")]
    except ElementTree.ParseError as error:
        raise DamagedFile(path, f"not XML: {error}") from error
    except (KeyError, ValueError) as error:
        raise DamagedFile(path, f"a DataSet lacks its time or file: {error}") from error
    for time, name in reversed(frames):
        if (folder / name).exists():
            return read_frame(folder / name, time)
    return None


def read_frame(path, time):
    """One vtp file; only the arrays that the picture needs are read."""
    vtkObject.GlobalWarningDisplayOff()  # what is wrong is said once, below
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    for selection, wanted in ((reader.GetPointDataArraySelection(), "displacement"),
                              (reader.GetCellDataArraySelection(), "stretch")):
        if not selection.ArrayExists(wanted):
            raise DamagedFile(path, f"no VTK file of a lattice: it has no array {wanted!r}")
        selection.DisableAllArrays()
        selection.EnableArray(wanted)
    reader.Update()
    sheet = reader.GetOutput()
    if sheet.GetNumberOfPoints() == 0 or sheet.GetNumberOfLines() == 0:  # what VTK returns of a broken file
        raise DamagedFile(path, "cut short, or without sites and bonds")
    ends = vtk_to_numpy(sheet.GetLines().GetConnectivityArray())
    # Cell data counts the vertices first.
    stretch = vtk_to_numpy(sheet.GetCellData().GetArray("stretch"))[sheet.GetNumberOfVerts():]
    position = (vtk_to_numpy(sheet.GetPoints().GetData())
                + vtk_to_numpy(sheet.GetPointData().GetArray("displacement")))[:, :2]
    if len(ends) != 2 * len(stretch) or not np.isfinite(position).all() or not np.isfinite(stretch).all():
        raise DamagedFile(path, "its bonds or positions make no sense")
    return Frame(time, position, ends.reshape(-1, 2), stretch)
