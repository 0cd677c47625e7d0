"""Tests of user-defined bond laws in cases: expressions, and the shared library of examples/own-laws."""
import pathlib
import re
import shutil
import subprocess

import numpy as np
import pytest

from program import CASES, LATCON, ended, latcon, numbers, read_json, settings

SOURCE = pathlib.Path(__file__).resolve().parents[2]
GENT_LAW = (SOURCE / "examples/own-laws/gent_law.c").read_text()
# A crack that takes a second.
TINY = [*settings("Sheet/length=2.5 cm", "Sheet/height=1.5 cm", "Time/end=0.6 ms"), "--no-report", "--skip-verification"]
GENT = "mu = 0.25 MPa, Jm = 120"
MOONEY_RIVLIN = {"law": "expression", "psi": "a*(lam^2/2 + 1/lam) + k/2*(2*lam + lam^-2)", "parameters": "k = 0.15 MPa"}


def bonds(**entries):
    """Options that set entries of both kinds of bonds."""
    return settings(*(f"{section}/{name.replace('_', ' ')}={value}"
                      for section in ("Nearest neighbours", "Next-nearest neighbours") for name, value in entries.items()))


def crack(tmp_path, name, *options, **entries):
    latcon("fracture", CASES / "quick.prm", *TINY, *bonds(**entries), *options, "--output-dir", tmp_path / name)
    return tmp_path / name


def refused(tmp_path, part, *options, **entries):
    run = latcon("fracture", CASES / "quick.prm", *TINY, *bonds(**entries), *options, "--output-dir", tmp_path / "bad", expect=2)
    assert part in run.stderr
    assert not (tmp_path / "bad").exists()


def library(tmp_path, name, *flags, text=GENT_LAW):
    source = tmp_path / f"{name}.c"
    source.write_text(text)
    library = tmp_path / f"{name}.so"
    subprocess.run(["cc", "-O1", "-shared", "-fPIC", "-I", SOURCE, *flags, source, "-o", library, "-lm"], check=True)
    return library


@pytest.fixture(scope="module")
def typed(module_path):
    """A crack of the Mooney-Rivlin law as an expression, on one thread."""
    return crack(module_path, "typed", "--threads", 1, **MOONEY_RIVLIN)


@pytest.fixture(scope="module")
def gent(module_path):
    """The library of Gent's law."""
    return library(module_path, "gent")


@pytest.fixture(scope="module")
def compiled(module_path, gent):
    """A crack of that law."""
    return crack(module_path, "compiled", law="library", library=gent, parameters=GENT)


def same_crack(one, other):
    """Bond after bond. The laws differ by a few roundings of each force, 1e-16. Between two breaks they grow like any
    perturbation; over the run of this test, from 1e-16 to less than 1e-9. A bond breaks in the same step unless it is as
    close to its limit as that, and time steps follow from the stiffness, whose roundings are those of the times."""
    first, second = (numbers(folder / "broken_bonds.csv") for folder in (one, other))
    assert len(first["t"]) > 20
    for name, column in first.items():
        assert (abs(second[name] - column) <= 1e-9 * np.maximum(abs(column), 1e-3)).all(), name


def test_expression_cracks_as_the_built_in_law(tmp_path, typed):
    same_crack(crack(tmp_path, "built-in"), typed)


def test_library_cracks_as_the_same_expression(tmp_path, compiled):
    same_crack(crack(tmp_path, "typed", law="expression", psi="-mu*Jm/2*log(1 - (lam^2 + 2/lam - 3)/Jm)", parameters=GENT), compiled)


def test_claims_need_the_law_up_to_their_largest_stretch(tmp_path):
    # Locks between 2.9, the largest stretch of this case's bonds, and 3.5.
    law = {"law": "expression", "psi": "-lam - (k-1)*log(k-lam)", "parameters": "k=3.2"}
    case = (CASES / "quick.prm", *settings("Fracture/toughening=none", "Fracture/factor=1", "Fracture/breaking stretch=2.9"),
            *bonds(**law), "--output-dir", tmp_path / "bad")
    sweep = ("--sweep", "Sheet/height=1 cm,1.5 cm", *case)
    for command in (("fracture", *case), ("verify", "energy", "--quick", "--case", *case), ("study", *sweep), ("batch", "--slurm", *sweep)):
        run = latcon(*command, expect=2)
        assert "claims evaluate the law at stretches up to 3.5: psi is nan at stretch 3.2" in run.stderr
        assert not (tmp_path / "bad").exists()
    for command in (("fracture", *case), ("study", *sweep)):
        latcon(*command, "--skip-verification", "--dry-run")


def test_claims_hold(tmp_path):
    latcon("verify", "intrinsic-length", "--quick", "--case", CASES / "quick.prm", "--set",
           "Next-nearest neighbours/present=false", *bonds(**MOONEY_RIVLIN), "--output-dir", tmp_path / "claims")
    rows = read_json(tmp_path / "claims" / "results.json")["claims"]
    assert sum(row["verdict"] == "holds" for row in rows) > 15


def test_force_is_compared_with_the_derivatives(tmp_path):
    wrong = GENT_LAW.replace("  return mu * (lam", "  return (1. + 1e-3 * (lam > 2.3)) * mu * (lam")
    assert GENT_LAW != wrong
    refused(tmp_path, "psi' is", law="library", library=library(tmp_path, "wrong", text=wrong), parameters=GENT)


def test_library_is_part_of_the_case(tmp_path):
    gent = library(tmp_path, "gent")

    def case_hash(name):
        latcon("lattice", CASES / "quick.prm", "--set", "Sheet/length=8 mm", "--set", "Sheet/height=6 mm",
               *bonds(law="library", library=gent, parameters=GENT), "--output-dir", tmp_path / name)
        return read_json(tmp_path / name / "run.json")["case_hash"]
    first = case_hash("first")
    library(tmp_path, "gent", "-DANOTHER=1", "-O0")  # in its place
    run = latcon("lattice", tmp_path / "first" / "case.prm", "--output-dir", tmp_path / "second", expect=2)
    assert "Nearest neighbours/library sha256" in run.stderr
    assert re.search(r"library sha256 *= [0-9a-f]{64}", (tmp_path / "first" / "case.prm").read_text())
    assert case_hash("third") != first


def test_all_ranks_need_the_same_library(tmp_path):
    library(tmp_path, "gent")
    for name in ("one", "two", "none"):
        (tmp_path / name).mkdir()
    shutil.copy(tmp_path / "gent.so", tmp_path / "one")
    library(tmp_path, "gent", "-DANOTHER=1", "-O0")
    shutil.copy(tmp_path / "gent.so", tmp_path / "two")
    case = ["fracture", CASES / "quick.prm", *TINY, "--threads", 1, "--output-dir", tmp_path / "ranks",
            *bonds(law="library", library="gent.so", parameters=GENT)]
    for other in ("two", "none"):
        ranks = [["-n", 1, "--wdir", tmp_path / folder, LATCON, *case] for folder in ("one", other)]
        command = map(str, ["mpirun", "--oversubscribe", *ranks[0], ":", *ranks[1]])
        run = ended(subprocess.run(list(command), capture_output=True, text=True, timeout=600), expect=2)
        assert "the ranks find different libraries, or some none" in run.stderr
        assert not (tmp_path / "ranks").exists()


def test_large_library(tmp_path):
    large = library(tmp_path, "large", text=GENT_LAW + "\nconst char ballast[20 << 20] = {1};\n")
    assert large.stat().st_size > 20 << 20
    latcon("fracture", CASES / "quick.prm", *TINY, "--dry-run", *bonds(law="library", library=large, parameters=GENT))


@pytest.mark.parametrize("message, part, other, parameters", [
    ("no function `latcon_bond_law_force`", "latcon_bond_law_force", "latcon_force", GENT),
    ("it has version 2 of the interface; required: 1", "return LATCON_BOND_LAW_VERSION", "return 2", GENT),
    # The entries a, b and modulus belong to other laws.
    ("the library needs 'modulus'", '"mu Jm"', '"modulus Jm"', "Jm = 120")])
def test_unusable_libraries_are_refused(tmp_path, message, part, other, parameters):
    assert part in GENT_LAW
    refused(tmp_path, message, law="library", library=library(tmp_path, "wrong", text=GENT_LAW.replace(part, other)), parameters=parameters)


@pytest.mark.parametrize("message, parameters", [
    ("the library needs 'Jm'", "mu = 0.25 MPa"), ("has no parameter 'k'", f"{GENT}, k = 1"),
    # The chains lock before the toughened bonds break, at 9.15.
    ("it must be finite for all stretches of bonds, 0.3 to 9.15", "mu = 0.25 MPa, Jm = 30"),
    # They lock at 9.16, which a bond can reach in the step in which it breaks.
    ("than its breaking stretch before the time step ends in which it breaks", "mu = 0.25 MPa, Jm = 81.12")])
def test_unusable_parameters_are_refused(tmp_path, gent, message, parameters):
    refused(tmp_path, message, law="library", library=gent, parameters=parameters)
