"""One nonlinear strain-gradient problem, solved by latcon and by dolfinx: time to solution, and whether they agree.

continuum_sheet.prm and dolfinx_sheet.py state the same problem: energy, mesh, element, quadrature, and the residual at
which Newton's method ends; jumps between cells are lifted by latcon, and have an interior penalty in dolfinx. Times are wall times without
output, and for dolfinx without imports and the compilation of forms. dolfinx runs on one rank, its systems factorised by MUMPS.
"""
import csv
import json
import math
import pathlib
import sys

from measure import ENVIRONMENT, Failed, on_ranks, run

HERE = pathlib.Path(__file__).resolve().parent
CASE = HERE / "continuum_sheet.prm"

# Shear modulus of continuum_sheet.prm: (3/8) sum over shells of c psi''(1), with c = s and sqrt(3) s for an area factor s of 2/3.
SHEAR_MODULUS = 3 / 8 * (2 / 3) * (1 + math.sqrt(3)) * 3 * (0.1e6 + 0.15e6)
STATIC_LENGTH = 0.01  # m
PROBE = (0.05, 0.0)  # m, a vertex of every mesh with an even number of cells
ONE_THREAD = {**ENVIRONMENT, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}  # per rank, so that only ranks count


def sizes(quick):
    """Degrees and cells along a side: about 10^5 and 4 10^5 unknowns, halved often enough for multigrid; a small problem shows
    agreement alone."""
    return [(2, 56), (3, 36)] if quick else [(2, 112), (2, 224), (3, 72), (3, 144)]


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
    entries = {"cells x": cells, "cells y": cells, "degree": degree, "direct limit": 0}
    settings = [part for name, value in entries.items() for part in ("--set", f"Continuum/{name}={value}")]
    words = [program, "continuum", CASE, "--quiet", "--output-dir", folder, *settings]
    run(words if ranks == 1 else on_ranks(ranks, words), environment=ONE_THREAD)
    info = json.loads((folder / "run.json").read_text())
    results = {claim["quantity"]: claim["continuum"] for claim in json.loads((folder / "results.json").read_text())["claims"]}
    newton = list(csv.DictReader((folder / "newton.csv").read_text().splitlines()))
    times = info["wall_time_s"]
    unknowns = int(results["unknowns"])
    return {
        "ranks": ranks,
        "unknowns": unknowns,
        "seconds": info["wall_time_total_s"] - times["output"],
        "assembly": times["assembly"],
        "preconditioner": times["preconditioner"],
        "linear_solve": times["linear solve"],
        "krylov_iterations": [int(step["linear_iterations"]) for step in newton],  # of Newton's steps, including the predictor
        "bytes_per_unknown": ranks * info["peak_memory_bytes"] / unknowns,  # the root rank is representative
        "tolerance": float(newton[-1]["tolerance"]),
        "energy": results["elastic energy per thickness"],
        "displacement": displacement_at(folder / "continuum_0001.vtu", PROBE) if ranks == 1 else None,
    }


def dolfinx(cells, degree, tolerance):
    printed = run(["/usr/bin/python3", HERE / "dolfinx_sheet.py", "--cells", cells, "--degree", degree, "--tolerance", tolerance,
                   "--shear-modulus", repr(SHEAR_MODULUS), "--length", STATIC_LENGTH, "--probe", *PROBE], environment=ONE_THREAD)
    solution = json.loads(printed.splitlines()[-1])
    solution["bytes_per_unknown"] = solution.pop("peak_memory_bytes") / solution["unknowns"]
    return solution


def compare(program, cells, degree, folder):
    """Both solutions of a mesh; raises Failed if they differ."""
    one, two = (latcon(program, cells, degree, ranks, folder) for ranks in (1, 2))
    coarse = latcon(program, cells // 2, degree, 1, folder)
    other = dolfinx(cells, degree, one["tolerance"])
    problem = {
        "unknowns": one["unknowns"], "degree": degree, "cells": cells,
        "latcon": one, "latcon_2_ranks": two, "dolfinx": other,
        "ratio": other["seconds"] / one["seconds"],
        # From a mesh of half the cells, so without the memory of the libraries.
        "bytes_of_increase": (one["bytes_per_unknown"] * one["unknowns"] - coarse["bytes_per_unknown"] * coarse["unknowns"])
                             / (one["unknowns"] - coarse["unknowns"]),
        "energy_difference": abs(one["energy"] - other["energy"]) / abs(other["energy"]),
        "displacement_difference": math.dist(one["displacement"], other["displacement"]),
    }
    # Between ranks energies are stationary, so only the rounding of a sum over the cells remains, at worst one per cell.
    # The two discretisations differ by less than the change to a mesh of half the cells. Frames have 24 bits of a
    # displacement below 6 cm.
    rounding = 2**-24 * 0.06 * math.sqrt(2) + 1e-10 * 0.06
    if not (one["unknowns"] == two["unknowns"] == other["unknowns"]
            and problem["energy_difference"] <= abs(one["energy"] - coarse["energy"]) / one["energy"]
            and abs(one["energy"] - two["energy"]) <= sys.float_info.epsilon * cells**2 * one["energy"]
            and problem["displacement_difference"] <= rounding + math.dist(one["displacement"], coarse["displacement"])):
        raise Failed(f"latcon and dolfinx differ: {problem}")
    return problem
