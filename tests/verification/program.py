"""Runs latcon for the tests of the command line, and reads its output with independent readers."""
import atexit
import csv
import functools
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import time
import xml.etree.ElementTree

import numpy as np

from forked import ForkServer

# latcon, or the fork server, which with arguments is latcon.
LATCON = os.environ["LATCON"]
# Long versions of tests run too, and instead of short ones.
FULL = "LATCON_FULL" in os.environ
# Verdicts are cached for the duration of a test only, never in the user's cache. A fixture may have left verdicts to begin with.
CACHE = tempfile.TemporaryDirectory()
if "LATCON_VERDICTS" in os.environ:
    for part in ("latcon", "matplotlib"):
        shutil.copytree(pathlib.Path(os.environ["LATCON_VERDICTS"]) / part, pathlib.Path(CACHE.name) / part)
os.environ["XDG_CACHE_HOME"] = CACHE.name
# Tests run as root, side by side, and on one machine: ranks look for no network.
os.environ.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMPI_MCA_mpi_yield_when_idle="1", OMPI_MCA_pml="ob1")
os.environ["MPLCONFIGDIR"] = f"{CACHE.name}/matplotlib"  # its list of fonts takes seconds to make, once is enough
CASES = pathlib.Path(__file__).resolve().parents[2] / "verification" / "cases"


@functools.cache
def server():
    """The fork server of this process, which ends with it."""
    started = ForkServer(LATCON)
    atexit.register(started.close)
    return started


def latcon(*arguments, expect=0, program=LATCON, launcher=(), timeout=600, **keywords):
    """Runs latcon: in a fork of the server, if that is what LATCON is, and nothing but the folder is asked for.
    @param expect exit code, several of them, or None for any @param launcher words before the program"""
    command = [*map(str, (*launcher, program, *arguments))]
    if launcher or program != LATCON or pathlib.Path(LATCON).name != "fork_server" or not keywords.keys() <= {"cwd"}:
        return ended(subprocess.run(command, capture_output=True, text=True, timeout=timeout, **keywords), expect)
    how, _, number = server().run(command[1:], keywords.get("cwd", pathlib.Path.cwd()), timeout).partition(" ")
    if how == "limit":
        raise subprocess.TimeoutExpired(command, timeout)
    return ended(subprocess.CompletedProcess(command, int(number) if how == "exit" else -int(number), server().stdout(), server().stderr()), expect)


def ended(run, expect):
    """A run, after a check of its exit code."""
    assert expect is None or run.returncode in (expect if isinstance(expect, tuple) else (expect,)), (run.args, run.returncode, run.stdout + run.stderr)
    return run


def claims_where(property_):
    """Names of the registered claims that have a property in `latcon schema`: "default" or "before_fracture"."""
    return {claim["name"] for claim in json.loads(latcon("schema").stdout)["claims"] if claim[property_]}


def on_ranks(ranks):
    """What starts ranks of a program; nothing for one."""
    return ["mpirun", "--oversubscribe", "-n", ranks] if ranks > 1 else []


def latcon_on_ranks(ranks, *arguments, expect=0):
    return latcon(*arguments, launcher=on_ranks(ranks), expect=expect)


def refused(*arguments, **keywords):
    """What latcon says of bad input, without any other output."""
    run = latcon(*arguments, **keywords, expect=2)
    assert run.stdout == ""
    return run.stderr.strip()


def settings(*entries):
    """Options that set these entries, each Section/name=value."""
    return [word for entry in entries for word in ("--set", entry)]


def checkpoints(out):
    return sorted((out / "checkpoints").glob("*.h5"))


def read_csv(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def read_json(path):
    return json.loads(path.read_text())


def numbers(path):
    """Columns of a table; checks that all cells are finite numbers."""
    rows = read_csv(path)
    columns = {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}
    assert all(np.isfinite(column).all() for column in columns.values()), path
    return columns


def frames(path):
    """(time, file) of every data set of a .pvd."""
    root = xml.etree.ElementTree.parse(path).getroot()
    return [(float(d.get("timestep")), path.parent / d.get("file")) for d in root.iter("DataSet")]


def read(path):
    """Data of a VTK file as VTK reads it; `PointData`, `CellData` and `FieldData` have its arrays by name."""
    from vtkmodules.numpy_interface.dataset_adapter import WrapDataObject
    from vtkmodules.vtkIOXML import vtkXMLGenericDataObjectReader
    reader = vtkXMLGenericDataObjectReader()
    reader.SetFileName(str(path))
    reader.Update()
    return WrapDataObject(reader.GetOutput())


def unit(array):
    """Unit of an array of a VTK file, None if it has none."""
    from vtkmodules.vtkCommonCore import vtkDataArray
    return array.VTKObject.GetInformation().Get(vtkDataArray.UNITS_LABEL())


def files(folder):
    """Results of a run by name: its files without those that record its circumstances and without the report and its pictures."""
    return {path.name: path.read_bytes() for path in folder.iterdir()
            if path.is_file() and path.name not in ("run.json", "log.txt", "report.html") and path.suffix != ".png"}


def expect_same(folder, expected):
    """Checks that a folder has these results, byte for byte."""
    found = files(folder)
    assert sorted(found) == sorted(expected)
    assert [name for name, content in expected.items() if found[name] != content] == [], folder.name


# Time [s] after which a process is assumed never to start, even on a busy machine.
BEGINS = 600


def wait_for(condition, process, seconds=BEGINS):
    """Waits until the condition holds or the process ends. @return whether it holds"""
    deadline = time.monotonic() + seconds
    while not condition() and process.poll() is None and time.monotonic() < deadline:
        time.sleep(0.01)
    return condition()


def catches(process, number):
    """Returns whether the program has installed its signal handlers."""
    with open(f"/proc/{process.pid}/status") as file:
        caught = next(line.split()[1] for line in file if line.startswith("SigCgt:"))
    return bool(int(caught, 16) >> (number - 1) & 1)


def children(process):
    """Running child processes of a process; none if it has ended."""
    try:
        return [int(child) for child in pathlib.Path(f"/proc/{process}/task/{process}/children").read_text().split()]
    except OSError:
        return []
