"""Checks with independent readers that all files of a run are complete."""
import csv
import hashlib
import json
import xml.etree.ElementTree

import h5py
from vtkmodules.vtkIOImage import vtkPNGReader
from vtkmodules.vtkIOXML import vtkXMLGenericDataObjectReader

USER_BLOCK = 512


class Broken(Exception):
    """A file is incomplete."""


def read_vtk(reader, path):
    problems = []
    reader.AddObserver("ErrorEvent", lambda *event: problems.append("cannot be read"))
    reader.SetFileName(str(path))
    reader.Update()
    if problems or reader.GetOutput().GetNumberOfPoints() == 0:
        raise Broken(f"{path}: VTK cannot read it")


def read_csv(path):
    text = path.read_text()
    if not text.endswith("\n"):
        raise Broken(f"{path}: its last line has no end")
    widths = {len(row) for row in csv.reader(text.splitlines())}
    if len(widths) != 1:
        raise Broken(f"{path}: rows of {sorted(widths)} columns")


def read_collection(path):
    for data in xml.etree.ElementTree.parse(path).getroot().iter("DataSet"):
        if not (path.parent / data.get("file")).exists():
            raise Broken(f"{path}: there is no {data.get('file')}")


def read_checkpoint(path):
    """Checks the hash of a checkpoint, and reads it with HDF5."""
    content = path.read_bytes()
    told = content[:content.index(b"\n")].decode().rpartition(" ")[2]
    if hashlib.sha256(content[USER_BLOCK:]).hexdigest() != told:
        raise Broken(f"{path}: its hash is not that of its bytes")
    with h5py.File(path, "r") as file:
        if file["run/step"][0] < 0:
            raise Broken(f"{path}: no step")


def read_page(path):
    if not path.read_text().rstrip().endswith("</html>"):
        raise Broken(f"{path}: it has no end")


def read_animation(path):
    content = path.read_bytes()
    if content[:4] != b"GIF8" or content[-1:] != b";":
        raise Broken(f"{path}: it is no whole GIF")


def read_list(path):
    names = path.read_text().splitlines()
    if names != sorted(set(names)):
        raise Broken(f"{path}: names are not sorted, or not once")


READERS = {
    ".csv": read_csv,
    ".json": lambda path: json.loads(path.read_text()),
    ".pvd": read_collection,
    **dict.fromkeys((".vtp", ".vtu", ".pvtu", ".vti"), lambda path: read_vtk(vtkXMLGenericDataObjectReader(), path)),
    ".h5": read_checkpoint,
    ".prm": lambda path: path.read_text(),
    ".html": read_page,
    ".png": lambda path: read_vtk(vtkPNGReader(), path),
    ".gif": read_animation,
    ".svg": lambda path: xml.etree.ElementTree.parse(path),
    ".latcon-files": read_list,  # which has no suffix
}


def check(folder):
    """Reads all files in a folder and below it, if there is one, except temporary files, locks and terminal output.
    @return number of files read"""
    n = 0
    for path in sorted(folder.rglob("*")):
        inside = path.relative_to(folder)
        if not path.is_file() or path.suffix == ".part" or path.name in ("log.txt", ".latcon.lock"):
            continue
        kind = path.suffix or path.name
        if kind not in READERS:
            raise Broken(f"{path}: no reader for it")
        try:
            READERS[kind](path)
        except Broken:
            raise
        except Exception as error:  # each reader has its own exceptions
            raise Broken(f"{inside}: {error}") from error
        n += 1
    return n
