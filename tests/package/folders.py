"""Utilities of the tests of the installed project: folders of sources and build, running of programs."""
import os
import pathlib
import re
import subprocess
import tempfile

SOURCE, BUILD = pathlib.Path(__file__).resolve().parents[2], pathlib.Path(os.environ["LATCON_BUILD"])
VERSION = re.search(r"project\(latcon VERSION ([\d.]+)", (SOURCE / "CMakeLists.txt").read_text())[1]
SCRATCH = tempfile.TemporaryDirectory()
FOLDER = pathlib.Path(SCRATCH.name)
ENVIRONMENT = dict(os.environ, XDG_CACHE_HOME=str(FOLDER / "cache"), OMP_NUM_THREADS="1")
# A strip so short that a crack runs through it in a second.
TINY = ["--set", "Sheet/length=2.5 cm", "--set", "Sheet/height=1.5 cm", "--set", "Time/end=1.5 ms"]


def run(*command, fails=False, **keywords):
    """Runs a command outside the source folder and checks its exit code. @return its output"""
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, cwd=FOLDER, timeout=600,
                          env=ENVIRONMENT, **keywords)
    if (done.returncode != 0) != fails:
        raise AssertionError(f"{command} ended with {done.returncode}:\n{done.stdout[-4000:]}\n{done.stderr[-4000:]}")
    return done.stdout + done.stderr


def files_below(folder):
    return [path for path in folder.rglob("*") if path.is_file()]


def modules(package):
    """Files of a Python package, relative to it."""
    return {path.relative_to(package) for path in files_below(package) if "__pycache__" not in path.parts}


def mentions_of_sources(folder):
    """Files that contain the path of the sources (usually the beginning of the path of the build folder)."""
    paths = [str(SOURCE).encode(), str(BUILD).encode()]
    return [path for path in files_below(folder) if any(word in path.read_bytes() for word in paths)]


def check_program(prefix):
    """Checks that the program below a prefix runs, reads its data files, and draws its report."""
    latcon, data = prefix / "bin" / "latcon", prefix / "share" / "latcon"
    assert re.match(r"latcon \d+\.\d+\.\d+", run(latcon, "--version"))
    quick = data / "cases" / "quick.prm"
    assert "sites" in run(latcon, "fracture", quick, "--dry-run")
    assert "little-viscosity" in run(latcon, "study", "patterns", "--quick", "--dry-run")
    style = data / "python" / "latcon" / "report" / "templates" / "style.css"
    style.write_text(style.read_text() + "/* of this installation */\n")
    output = prefix.parent / "crack"
    run(latcon, "fracture", quick, "--skip-verification", "--output-dir", output, *TINY)
    assert "/* of this installation */" in (output / "report.html").read_text()
    data.rename(data.with_name("elsewhere"))
    assert str(data) in run(latcon, "verify", "energy", "--dry-run", fails=True)
    data.with_name("elsewhere").rename(data)


def python(prefix, statements):
    """Output of Python statements that use the package below a prefix."""
    return run("env", "-u", "LATCON", f"PYTHONPATH={prefix}/lib/python3/dist-packages", "/usr/bin/python3", "-B", "-c",
               f"import latcon; {statements}")
