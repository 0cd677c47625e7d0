"""Runs latcon in forks of one process, as for fuzzing: MPI and the libraries, which take half a second, start once."""
import pathlib
import sys
import tempfile

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "fuzz"))
import mutate


class Forked:
    """Program like victims.Program, for uninterrupted runs on one thread."""

    def __init__(self, server):
        self.folder = tempfile.TemporaryDirectory()
        self.server = mutate.Server(server, pathlib.Path(self.folder.name))

    def run(self, arguments, out, timeout=600):
        """@return exit status, minus the number of a signal, or "hangs"; standard error"""
        folder = pathlib.Path(self.folder.name)
        how, _, number = self.server.run([*arguments, "--output-dir", str(out)], folder, timeout).partition(" ")
        status = {"exit": lambda: int(number), "signal": lambda: -int(number), "limit": lambda: "hangs"}[how]()
        return status, (folder / "stderr").read_text(errors="replace")

    def close(self):
        self.server.close()
        self.folder.cleanup()
