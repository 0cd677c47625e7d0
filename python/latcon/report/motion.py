"""Frames of a run for its pictures: the last one, and those of the motion."""
from dataclasses import dataclass

from ..errors import UnreadableFile
from ..files import if_present, read_series
from ..frames import Frame, read_frame
from .raster import Mesh

FIELDS = ("displacement", "stretch", "velocity", "cauchy_stress", "damage", "site")  # that pictures show


@dataclass(frozen=True)
class Motion:
    """A sheet in motion; sites are numbered as in the frames."""

    mesh: Mesh
    whole: Frame  # first full frame, with bonds
    frames: list  # of Frame, without bonds


def last_frame(series):
    """Time and file of the last existing frame of points and lines or cells in a series, or (None, None)."""
    frames = if_present(read_series, series) or []
    return next((frame for frame in reversed(frames) if frame[1].suffix == ".vtp" and frame[1].exists()), (None, None))


def read_last_frame(folder):
    """Reads the last existing frame listed in lattice.pvd; None if there is none."""
    time, path = last_frame(folder / "lattice.pvd")
    return read_sheet(path, time) if path else None


def read_sheet(path, time):
    """Reads a frame with its bonds."""
    frame = read_frame(path, time, FIELDS)
    if not len(frame.bonds):
        raise UnreadableFile(path, "truncated, or without bonds")
    return frame


def read_motion(run):
    """Reads the frames listed in motion.pvd of a run; None for fewer than two, or without the table of broken bonds."""
    frames = [(time, path) for time, path in if_present(read_series, run.folder / "motion.pvd") or [] if path.exists()]
    sheets = if_present(read_series, run.folder / "lattice.pvd")
    if len(frames) < 2 or not sheets or not sheets[0][1].exists() or run.broken is None:
        return None
    whole = read_sheet(sheets[0][1], sheets[0][0])
    mesh = Mesh(whole, run.broken)
    return Motion(mesh, whole, [read_reduced_frame(path, time, mesh) for time, path in frames])


def read_reduced_frame(path, time, mesh):
    """Reads a frame without bonds, with the sites of the mesh."""
    frame = read_frame(path, time, FIELDS)
    if "velocity" not in frame.fields or len(frame.position) <= mesh.bonds.max(initial=0):
        raise UnreadableFile(path, "not a frame of the motion of this sheet: velocities or sites are missing")
    return frame
