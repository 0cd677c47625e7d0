"""Reduced frames of the motion of a run: displacement and velocity only."""
from dataclasses import dataclass

from files import DamagedFile
from frame import Frame, read_frame, read_series
from raster import Mesh


@dataclass(frozen=True)
class Motion:
    """A sheet in motion; sites are numbered as in the frames."""

    mesh: Mesh
    whole: Frame  # first full frame, with bonds
    frames: list  # of Frame, without bonds


def read_motion(run):
    """Reads the frames listed in motion.pvd of a run; None for fewer than two, or without the table of broken bonds."""
    frames = [(time, path) for time, path in read_series(run.folder / "motion.pvd") or [] if path.exists()]
    sheets = read_series(run.folder / "lattice.pvd")
    if len(frames) < 2 or not sheets or not sheets[0][1].exists() or run.broken is None:
        return None
    whole = read_frame(sheets[0][1], sheets[0][0])
    mesh = Mesh(whole, run.broken)
    return Motion(mesh, whole, [read_reduced_frame(path, time, mesh) for time, path in frames])


def read_reduced_frame(path, time, mesh):
    """Reads a frame without bonds, with the sites of the mesh."""
    frame = read_frame(path, time, with_bonds=False)
    if "velocity" not in frame.fields or len(frame.position) <= mesh.bonds.max(initial=0):
        raise DamagedFile(path, "not a frame of the motion of this sheet: velocities or sites are missing")
    return frame
