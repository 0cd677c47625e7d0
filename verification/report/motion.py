"""Frames of the motion of a run: light files of displacement and velocity, one after the other."""
from dataclasses import dataclass

from files import DamagedFile
from frame import Frame, read_frame, read_series
from raster import Mesh


@dataclass(frozen=True)
class Motion:
    """A sheet in motion; point numbers are those of the frames."""

    mesh: Mesh
    whole: Frame  # first full frame, with bonds
    frames: list  # of Frame, without bonds


def read_motion(run):
    """The frames that motion.pvd of a run names; None with fewer than two, or without the bonds that broke."""
    frames = [(time, path) for time, path in read_series(run.folder / "motion.pvd") or [] if path.exists()]
    sheets = read_series(run.folder / "lattice.pvd")
    if len(frames) < 2 or not sheets or not sheets[0][1].exists() or run.broken is None:
        return None
    whole = read_frame(sheets[0][1], sheets[0][0])
    mesh = Mesh(whole, run.broken)
    return Motion(mesh, whole, [read_light_frame(path, time, mesh) for time, path in frames])


def read_light_frame(path, time, mesh):
    """A frame without bonds, its sites those of the mesh."""
    frame = read_frame(path, time, with_bonds=False)
    if "velocity" not in frame.fields or len(frame.position) <= mesh.bonds.max(initial=0):
        raise DamagedFile(path, "no frame of the motion of this sheet: it lacks velocities or sites")
    return frame
