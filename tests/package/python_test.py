"""Checks that the Python package can be installed from its sources into a new virtual environment, and runs the program."""
import shutil

from folders import BUILD, FOLDER, SOURCE, VERSION, modules, run

LATCON = BUILD / "verification" / "latcon"
CHECK = "import importlib.metadata as m, latcon, latcon.fit; print(m.version('latcon'), latcon.schema().version, " \
        "latcon.Case('quick')['Sheet/length'], latcon.__file__)"


def test_is_installed_without_network():
    # Building creates files in the source folder.
    shutil.copytree(SOURCE / "python", FOLDER / "python", ignore=shutil.ignore_patterns("__pycache__", "build", "*.egg-info"))
    run("/usr/bin/python3", "-m", "venv", "--system-site-packages", FOLDER / "own")
    run(FOLDER / "own/bin/pip", "install", "--quiet", "--no-build-isolation", "--no-index", FOLDER / "python")
    fresh = FOLDER / "fresh"
    fresh.mkdir()
    printed = run("env", "-C", fresh, f"LATCON={LATCON}", FOLDER / "own/bin/python", "-c", CHECK).split()
    assert printed[:3] == [VERSION, VERSION, "0.04"]
    assert printed[3].startswith(str(FOLDER / "own")), printed[3]
    installed = next((FOLDER / "own").glob("lib/python3*/site-packages/latcon"))
    assert modules(installed) == modules(SOURCE / "python/latcon")
    # A run in the fresh folder, by the installed package alone.
    printed = run("env", "-C", fresh, f"LATCON={LATCON}", FOLDER / "own/bin/python", "-c",
                  "import latcon; case = latcon.Case('quick').set('Sheet/length', '1 cm').set('Sheet/height', '6 mm'); "
                  "case = case.set('Time/end', '0.01 ms'); "
                  "run = latcon.fracture(case, 'out', skip_verification=True, report=False, progress=False); "
                  "print(run.exit_code, len(run.frames))")
    assert printed.split() == ["0", "2"]
    assert (fresh / "out" / "crack.json").is_file()
