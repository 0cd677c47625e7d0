"""latcon behind a fork, as fuzzing has it: what takes half a second to start, MPI and the libraries, starts once."""
import pathlib
import sys
import tempfile

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "fuzz"))
import mutate


class Forked:
    """A program of victims.Program's kind, for runs on one thread that nothing disturbs."""

    def __init__(self, server):
        self.folder = tempfile.TemporaryDirectory()
        self.server = mutate.Server(server, pathlib.Path(self.folder.name))

    def run(self, arguments, out, timeout=600):
        """@return exit status, minus the number of a signal, or "hangs"; what it said on standard error"""
        folder = pathlib.Path(self.folder.name)
        how, _, number = self.server.run([*arguments, "--output-dir", str(out)], folder, timeout).partition(" ")
        status = {"exit": lambda: int(number), "signal": lambda: -int(number), "limit": lambda: "hangs"}[how]()
        return status, (folder / "stderr").read_text(errors="replace")

    def close(self):
        self.server.close()
        self.folder.cleanup()
