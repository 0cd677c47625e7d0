"""Runs latcon for the tests of the command line, and reads what it wrote with readers of other people."""
import csv
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

LATCON = sys.argv.pop(1)
# Verdicts are stored for the time of a test alone, and never among those of the user.
CACHE = tempfile.TemporaryDirectory()
os.environ["XDG_CACHE_HOME"] = CACHE.name
os.environ["MPLCONFIGDIR"] = f"{CACHE.name}/matplotlib"  # its list of fonts takes seconds to make, once is enough
CASES = pathlib.Path(__file__).resolve().parents[2] / "verification" / "cases"


def latcon(*arguments, program=LATCON, timeout=600, **keywords):
    return subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, timeout=timeout, **keywords)


def latcon_on_ranks(ranks, *arguments, env=None):
    environment = dict(env or os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    return subprocess.run(["mpirun", "--oversubscribe", "-n", str(ranks), LATCON, *map(str, arguments)],
                          capture_output=True, text=True, timeout=600, env=environment)


def read_csv(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def frames(path):
    """(time, file) of every data set of a .pvd."""
    root = xml.etree.ElementTree.parse(path).getroot()
    return [(float(d.get("timestep")), path.parent / d.get("file")) for d in root.iter("DataSet")]


def read(reader, path):
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


class TemporaryFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.out = self.folder / "out"
