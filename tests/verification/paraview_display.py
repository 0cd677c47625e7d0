"""Runs the scripts of verification/paraview/ with ParaView's modules, on a virtual display."""
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "verification" / "paraview"
MODULES = pathlib.Path(os.environ["LATCON_PARAVIEW"])


@unittest.skipIf(not (MODULES / "paraview").is_dir() or shutil.which("Xvfb") is None, "no ParaView or no Xvfb")
class ParaView(unittest.TestCase):
    """Test case with a folder and a display."""

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        read_end, write_end = os.pipe()
        # -displayfd: writes the number once connections are accepted; -noreset: continues after the last one closes.
        cls.display = subprocess.Popen(["Xvfb", "-displayfd", str(write_end), "-noreset", "-nolisten", "tcp", "-screen",
                                        "0", "1280x1024x24"], pass_fds=[write_end], stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL)
        cls.addClassCleanup(cls.end_display)  # also if the rest of the set-up fails
        os.close(write_end)
        with os.fdopen(read_end) as told:
            number = told.readline().strip()
        # Runs the script like pvpython, with the interpreter for which ParaView was built.
        cls.environment = dict(os.environ, DISPLAY=f":{number}", PYTHONPATH=str(MODULES), PYTHONDONTWRITEBYTECODE="1",
                               OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")

    @classmethod
    def end_display(cls):
        cls.display.terminate()
        cls.display.wait()
        cls.temporary.cleanup()

    def script(self, name, *arguments):
        """Runs a script of that folder."""
        return subprocess.run(["/usr/bin/python3", str(SCRIPTS / name), *map(str, arguments)], capture_output=True,
                              text=True, timeout=300, env=self.environment, check=False)
