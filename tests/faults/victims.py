"""Small runs of every kind that writes checkpoints, on which the fault harness acts."""
import os
import subprocess

from program import CASES, LATCON, latcon


def settings(**entries):
    """--set options; `Section__name` represents Section/name, `_` for a blank."""
    words = []
    for key, value in entries.items():
        words += ["--set", key.replace("__", "/").replace("_", " ") + "=" + str(value)]
    return words


STRIP = ["fracture", str(CASES / "quick.prm"), "--skip-verification", "--no-report", "--quiet",
         *settings(Sheet__length="2.5 cm", Sheet__height="1.5 cm", Output__frame_interval="0.1 ms",
                   Output__energy_interval=40, Checkpoints__steps=48, Time__end="1 ms", Near_tip__interval="7e-6",
                   Near_tip__ahead="4 mm", Near_tip__behind="4 mm", Near_tip__half_height="4 mm")]
VICTIMS = {
    "crack": [*STRIP, *settings(Fracture__right_end="absorbing", Contact__present="true")],
    "retracting crack in long steps": [*STRIP, *settings(Fracture__toughening="retraction", Time__stages=4,
                                                         Time__integrator="runge-kutta-chebyshev")],
    "lattice in motion": ["lattice", str(CASES / "quick.prm"), "--quiet",
                          *settings(Lattice__solution="motion", Time__end="0.1 ms", Sheet__length="2.5 cm",
                                    Output__frame_interval="0.02 ms", Output__energy_interval=30,
                                    Checkpoints__steps=32)],
    "crack of the continuum": [
        "fracture", str(CASES / "quick.prm"), "--side", "continuum", "--skip-verification", "--no-report", "--quiet",
        *settings(Sheet__spacing="1 mm", Sheet__length="30 mm", Sheet__height="16 mm", Fracture__seed_sites=8,
                  Time__end="0.4 ms", Time__integrator="runge-kutta-chebyshev", Output__frame_interval="0.05 ms",
                  Output__energy_interval=10, Checkpoints__steps=7)],
    "sheet in motion": [
        "continuum", str(CASES / "shear_layer.prm"), "--quiet",
        *settings(Continuum__solution="motion", Continuum__cells_y=8, Continuum__degree=2, Continuum__time_step="5 us",
                  Left_edge__condition="held", Right_edge__condition="held", Continuum__direct_limit=0,
                  Loading__shear=0.1, Initial_state__velocity_x="6*sin(pi*y/0.02)^2*sin(pi*x/0.01)^2",
                  Time__end="0.1 ms", Output__frame_interval="0.02 ms", Output__energy_interval=2, Checkpoints__steps=3)],
}
# Files that record the circumstances of a run.
NOT_RESULTS = ("run.json", "log.txt", ".latcon.lock", "study.json", "study.html")
DONE = (0, 3)  # 3: the energy balance of such small strips may exceed the tolerance


def run_with_fault(arguments, out, fault=None):
    """@return exit status, standard error"""
    environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    if fault is not None:
        environment.update(LD_PRELOAD=os.environ["LATCON_FILE_FAULTS"], LATCON_FAULT_IN=str(out), **fault)
    ended = subprocess.run([LATCON, *arguments, "--output-dir", str(out)], env=environment, stdout=subprocess.DEVNULL,
                           stderr=subprocess.PIPE, text=True, timeout=600, check=False)
    return ended.returncode, ended.stderr


def run(arguments, out, timeout=600):
    """The same in a fork, without a fault."""
    try:
        ended = latcon(*arguments, "--output-dir", out, timeout=timeout, expect=None)
    except subprocess.TimeoutExpired:
        return "hangs", ""
    return ended.returncode, ended.stderr


def run_to_end(arguments, out):
    status, said = run(arguments, out)
    if status not in DONE:
        raise RuntimeError(f"exit {status}: {said}")


def contents(folder):
    """Results of a run by file name, without the files that record its circumstances."""
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*"))
            if path.is_file() and path.suffix != ".part" and path.name not in NOT_RESULTS
            and not {"checkpoints", "earlier-run"} & set(path.parts)}


def differences(found, expected):
    """Names of files that differ."""
    return sorted(name for name in found.keys() | expected.keys() if found.get(name) != expected.get(name))
