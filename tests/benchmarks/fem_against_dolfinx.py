#!/usr/bin/env python3
"""One nonlinear strain-gradient problem, solved by latcon and by dolfinx: time to solution, and whether they agree.

continuum_sheet.prm and dolfinx_sheet.py state the same problem: energy, mesh, element, quadrature, and the residual at
which Newton's method ends; jumps between cells are lifted by latcon, and have an interior penalty in dolfinx. Times are wall times without output, and for dolfinx without imports and the
compilation of forms. dolfinx runs on one rank, its systems solved by MUMPS, factorised as symmetric and, if asked, as
general matrices too. Exit code 1 if the answers differ.
"""
import argparse
import csv
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

import page

HERE = pathlib.Path(__file__).resolve().parent
PYTHON = "/usr/bin/python3"  # the one that sees Debian's packages
CASE = HERE / "continuum_sheet.prm"

# Shear modulus of continuum_sheet.prm: (3/8) sum over shells of c psi''(1), with c = s and sqrt(3) s for an area factor s of 2/3.
SHEAR_MODULUS = 3 / 8 * (2 / 3) * (1 + math.sqrt(3)) * 3 * (0.1e6 + 0.15e6)
STATIC_LENGTH = 0.01  # m
PROBE = (0.05, 0.0)  # m, a vertex of every mesh with an even number of cells

# Cells along a side by degree: about 10^5 and 4 10^5 unknowns; halved often enough for multigrid.
SIZES = {2: [112, 224], 3: [72, 144]}
QUICK_SIZES = {2: [56], 3: [36]}


def parse():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--output", type=pathlib.Path, help="JSON file to write")
    parser.add_argument("--quick", action="store_true", help="a small problem alone, which shows agreement and no ratio")
    parser.add_argument("--degrees", type=int, nargs="+", choices=[2, 3], default=[2, 3])
    parser.add_argument("--latcon", type=pathlib.Path, default=HERE.parents[1] / "build/release/verification/latcon")
    parser.add_argument("--lu", action="store_true", help="time dolfinx with general matrices too")
    return parser.parse_args()


def environment():
    """Environment with one thread per rank, so that only ranks count, and with root allowed for Open MPI."""
    return {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1",
            "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


def run(command, folder):
    done = subprocess.run(command, cwd=folder, env=environment(), text=True, capture_output=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}\nended with {done.returncode}:\n{done.stdout}{done.stderr}")
    return done.stdout


def rows(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def displacement_at(path, point):
    """Displacement of the node of a frame nearest to `point` [m]; frames are in single precision."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    frame = reader.GetOutput()
    node = frame.FindPoint(*point, 0.0)
    return vtk_to_numpy(frame.GetPointData().GetArray("displacement"))[node][:2].tolist()


def latcon(program, cells, degree, ranks, folder):
    folder = folder / f"latcon_{degree}_{cells}_{ranks}"
    launch = [] if ranks == 1 else ["mpirun", "--oversubscribe", "-np", str(ranks)]
    entries = {"cells x": cells, "cells y": cells, "degree": degree, "direct limit": 0}
    settings = [part for name, value in entries.items() for part in ("--set", f"Continuum/{name}={value}")]
    run([*launch, program, "continuum", CASE, "--quiet", "--output-dir", folder, *settings], folder.parent)
    info = json.loads((folder / "run.json").read_text())
    results = {claim["quantity"]: claim["continuum"] for claim in json.loads((folder / "results.json").read_text())["claims"]}
    newton = rows(folder / "newton.csv")
    times = info["wall_time_s"]
    unknowns = int(results["unknowns"])
    return {
        "ranks": ranks,
        "unknowns": unknowns,
        "seconds": info["wall_time_total_s"] - times["output"],
        "assembly": times["assembly"],
        "preconditioner": times["preconditioner"],
        "linear_solve": times["linear solve"],
        "newton_steps": len(newton),  # including the predictor
        "krylov_iterations": [int(step["linear_iterations"]) for step in newton],
        "bytes_per_unknown": ranks * info["peak_memory_bytes"] / unknowns,  # the root rank is representative
        "tolerance": float(newton[-1]["tolerance"]),
        "energy": results["elastic energy per thickness"],
        "displacement": displacement_at(folder / "continuum_0001.vtu", PROBE) if ranks == 1 else None,
    }


def dolfinx(cells, degree, tolerance, factorisation, folder):
    command = [PYTHON, HERE / "dolfinx_sheet.py", "--cells", cells, "--degree", degree, "--tolerance", tolerance,
               "--shear-modulus", repr(SHEAR_MODULUS), "--length", STATIC_LENGTH, "--probe", *PROBE,
               "--factorisation", factorisation]
    solution = json.loads(run(list(map(str, command)), folder).splitlines()[-1])
    solution["bytes_per_unknown"] = solution.pop("peak_memory_bytes") / solution["unknowns"]
    return solution


def compare(program, cells, degree, lu, folder):
    one, two = (latcon(program, cells, degree, ranks, folder) for ranks in (1, 2))
    coarse = latcon(program, cells // 2, degree, 1, folder)
    other = dolfinx(cells, degree, one["tolerance"], "cholesky", folder)
    problem = {
        "unknowns": one["unknowns"], "degree": degree, "cells": cells,
        "latcon": one, "latcon_2_ranks": two, "dolfinx": other,
        "ratio": other["seconds"] / one["seconds"],
        "energy_difference": abs(one["energy"] - other["energy"]) / abs(other["energy"]),
        "displacement_difference": math.dist(one["displacement"], other["displacement"]),
    }
    if lu:
        problem["dolfinx_lu"] = dolfinx(cells, degree, one["tolerance"], "lu", folder)
        problem["ratio_lu"] = problem["dolfinx_lu"]["seconds"] / one["seconds"]
    # Between ranks energies are stationary, so only the rounding of a sum over the cells remains, at worst one per cell.
    # The two discretisations differ by less than the change to a mesh of half the cells. Frames have 24 bits of a
    # displacement below 6 cm.
    rounding = 2**-24 * 0.06 * math.sqrt(2) + 1e-10 * 0.06
    problem["energy_tolerance"] = abs(one["energy"] - coarse["energy"]) / one["energy"]
    problem["agrees"] = (
        one["unknowns"] == two["unknowns"] == other["unknowns"]
        and problem["energy_difference"] <= problem["energy_tolerance"]
        and abs(one["energy"] - two["energy"]) <= sys.float_info.epsilon * cells**2 * one["energy"]
        and problem["displacement_difference"] <= rounding + math.dist(one["displacement"], coarse["displacement"]))
    return problem


def main():
    arguments = parse()
    sizes = QUICK_SIZES if arguments.quick else SIZES
    with tempfile.TemporaryDirectory() as folder:
        problems = [compare(arguments.latcon.resolve(), cells, degree, arguments.lu, pathlib.Path(folder))
                    for degree in arguments.degrees for cells in sizes[degree]]
    print(page.fem_table({"problems": problems})[0].text())
    for problem in problems:
        if "ratio_lu" in problem:
            print(f"{problem['unknowns']} unknowns, LU: {problem['dolfinx_lu']['seconds']:.2f} s, ratio {problem['ratio_lu']:.2f}")
    if arguments.output:
        arguments.output.write_text(json.dumps({"problems": problems}, indent=2) + "\n")
    return 0 if all(problem["agrees"] for problem in problems) else 1


if __name__ == "__main__":
    sys.exit(main())
