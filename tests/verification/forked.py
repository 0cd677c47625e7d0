"""Runs latcon in forks of one process (fork_server.cc): MPI and the libraries, which take half a second, start once."""
import os
import pathlib
import subprocess
import tempfile


class ForkServer:
    """A fork server, and the folder of the output of its children."""

    def __init__(self, program, environment=None):
        self.temporary = tempfile.TemporaryDirectory()
        self.output = pathlib.Path(self.temporary.name)
        environment = dict(environment or os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
        self.process = subprocess.Popen([program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=environment)

    def run(self, arguments, folder, limit):
        """Runs latcon in `folder`, for at most `limit` s. @return `exit CODE`, `signal NUMBER` or `limit`"""
        words = [os.fsencode(word).hex() for word in [str(self.output), str(folder), *arguments]]
        self.process.stdin.write(f"{limit} " + " ".join(words) + "\n")
        self.process.stdin.flush()
        answer = self.process.stdout.readline().strip()
        if not answer:
            raise SystemExit("the server has ended")
        return answer

    def stdout(self):
        """Standard output of the last run."""
        return (self.output / "stdout").read_text(errors="replace")

    def stderr(self):
        """Standard error of the last run."""
        return (self.output / "stderr").read_text(errors="replace")

    def close(self):
        self.process.stdin.close()
        self.process.wait()
        self.process.stdout.close()
        self.temporary.cleanup()
