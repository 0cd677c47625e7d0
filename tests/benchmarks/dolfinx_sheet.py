"""The sheet of continuum_sheet.prm in dolfinx 0.5: the same energy, mesh, element and quadrature, with C0 interior penalty.

Newton's method with MUMPS, from zero displacement, until the residual over the free unknowns is at most --tolerance.
Prints one line of JSON. Times exclude imports; forms are compiled in advance on a mesh of 2 x 2 cells, which fills the
cache of the form compiler.
"""
import argparse
import json
import resource
import time

import numpy
import ufl
from dolfinx import fem, geometry, mesh
from dolfinx.fem import petsc
from mpi4py import MPI
from petsc4py import PETSc

WIDTH, HEIGHT = 0.1, 0.10045894683899488  # m


def parse():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cells", type=int, required=True, help="along each side of the sheet")
    parser.add_argument("--degree", type=int, required=True)
    parser.add_argument("--shear-modulus", type=float, required=True, help="Pa")
    parser.add_argument("--length", type=float, required=True, help="l_s [m]")
    parser.add_argument("--tolerance", type=float, required=True, help="of the residual [N/m]")
    parser.add_argument("--probe", type=float, nargs=2, required=True, help="where to look [m]")
    return parser.parse_args()


def prescribed(x):
    """Displacement on the edges [m]."""
    bump = numpy.where(x[1] > 0.49999 * HEIGHT, 0.01 * numpy.sin(numpy.pi * x[0] / WIDTH) ** 4, 0.0)
    return numpy.stack([0.3 * x[0], 0.5 * x[1] + bump])


class Sheet:
    """Forms and boundary conditions on a mesh of n x n cells."""

    def __init__(self, n, arguments):
        p, mu = arguments.degree, arguments.shear_modulus
        self.domain = mesh.create_rectangle(
            MPI.COMM_SELF, [[0.0, -HEIGHT / 2], [WIDTH, HEIGHT / 2]], [n, n], mesh.CellType.quadrilateral,
            ghost_mode=mesh.GhostMode.shared_facet)
        self.space = fem.VectorFunctionSpace(self.domain, ("Lagrange", p))
        self.u = fem.Function(self.space)

        facet_dimension = self.domain.topology.dim - 1
        self.domain.topology.create_connectivity(facet_dimension, facet_dimension + 1)
        edge = mesh.locate_entities_boundary(self.domain, facet_dimension, lambda x: numpy.full(x.shape[1], True))
        held = fem.Function(self.space)
        held.interpolate(prescribed)
        self.conditions = [fem.dirichletbc(held, fem.locate_dofs_topological(self.space, facet_dimension, edge))]

        quadrature = {"quadrature_degree": 2 * p + 1}  # p + 1 Gauss points in each direction
        dx = ufl.Measure("dx", domain=self.domain, metadata=quadrature)
        dS = ufl.Measure("dS", domain=self.domain, metadata=quadrature)
        constant = lambda value: fem.Constant(self.domain, PETSc.ScalarType(value))
        gradient_modulus = constant(mu * arguments.length**2)
        gamma = constant(2 * p * (p + 1))
        extent = constant(WIDTH / n), constant(HEIGHT / n)  # of cells, across a face
        c1, kappa = constant(mu / 2), constant(2 * mu)

        u, N = self.u, ufl.FacetNormal(self.domain)
        sigma = lambda n: gamma * gradient_modulus / (abs(n[0]) * extent[0] + abs(n[1]) * extent[1])
        F = ufl.Identity(2) + ufl.grad(u)
        j, f = ufl.det(F), ufl.inner(F, F)
        t = (kappa * j + ufl.sqrt((kappa * j) ** 2 + 8 * c1 * (2 * c1 + kappa * j**2))) / (2 * (2 * c1 + kappa * j**2))
        J = j * t
        W = c1 * (f + t**2 - 3 - 2 * ufl.ln(J)) + kappa / 2 * (J - 1) ** 2
        second = lambda v: ufl.grad(ufl.grad(v))
        along = lambda v, n: ufl.dot(ufl.dot(second(v), n), n)
        z = ufl.dot(ufl.grad(u)("+") - ufl.grad(u)("-"), N("+"))
        mean = (along(u("+"), N("+")) + along(u("-"), N("+"))) / 2
        energy = (W + gradient_modulus / 2 * ufl.inner(second(u), second(u))) * dx
        energy += (-gradient_modulus * ufl.inner(mean, z) + sigma(N("+")) / 2 * ufl.inner(z, z)) * dS
        residual = ufl.derivative(energy, u)
        options = {"cffi_extra_compile_args": ["-O3", "-march=native"]}
        self.energy, self.residual, self.tangent = (
            fem.form(form, jit_params=options) for form in (energy, residual, ufl.derivative(residual, u)))


def newton(sheet, arguments, seconds):
    """Solves for sheet.u; returns the number of steps and the residual [N/m]. Accumulates the times of the parts."""
    clock = time.perf_counter
    start = clock()
    K = petsc.create_matrix(sheet.tangent)
    r = petsc.create_vector(sheet.residual)
    step = K.createVecRight()
    solver = PETSc.KSP().create(MPI.COMM_SELF)
    solver.setOperators(K)
    solver.setType("preonly")
    solver.getPC().setType("cholesky")
    solver.getPC().setFactorSolverType("mumps")
    K.setOption(PETSc.Mat.Option.SYMMETRIC, True)
    x = sheet.u.vector
    seconds["set-up"] += clock() - start
    for n_steps in range(20):
        start = clock()
        with r.localForm() as local:
            local.set(0.0)
        petsc.assemble_vector(r, sheet.residual)
        petsc.apply_lifting(r, [sheet.tangent], [sheet.conditions], [x], -1.0)
        r.ghostUpdate(addv=PETSc.InsertMode.ADD, mode=PETSc.ScatterMode.REVERSE)
        petsc.set_bc(r, sheet.conditions, x, -1.0)
        size = r.norm()
        seconds["assembly"] += clock() - start
        if n_steps > 0 and size <= arguments.tolerance:
            return n_steps, size
        start = clock()
        K.zeroEntries()
        petsc.assemble_matrix(K, sheet.tangent, sheet.conditions)
        K.assemble()
        seconds["assembly"] += clock() - start
        start = clock()
        solver.solve(r, step)
        x.axpy(-1.0, step)
        seconds["linear_solve"] += clock() - start
    raise SystemExit(f"no convergence: residual {size} N/m")


def main():
    arguments = parse()
    start = time.perf_counter()
    Sheet(2, arguments)
    compilation = time.perf_counter() - start

    seconds = {"set-up": 0.0, "assembly": 0.0, "linear_solve": 0.0}
    start = time.perf_counter()
    sheet = Sheet(arguments.cells, arguments)
    seconds["set-up"] += time.perf_counter() - start
    n_steps, residual = newton(sheet, arguments, seconds)
    total = time.perf_counter() - start

    point = numpy.array([[*arguments.probe, 0.0]])
    candidates = geometry.compute_collisions(geometry.BoundingBoxTree(sheet.domain, 2), point)
    cell = geometry.compute_colliding_cells(sheet.domain, candidates, point).links(0)[:1]
    displacement = sheet.u.eval(point, cell)
    unknowns = sheet.space.dofmap.index_map.size_global * sheet.space.dofmap.index_map_bs
    print(json.dumps({
        "unknowns": unknowns, "degree": arguments.degree,
        "seconds": total, "set-up": seconds["set-up"], "assembly": seconds["assembly"],
        "linear_solve": seconds["linear_solve"], "compilation": compilation, "newton_steps": n_steps,
        "residual": residual, "energy": fem.assemble_scalar(sheet.energy), "displacement": displacement.ravel().tolist(),
        "peak_memory_bytes": 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss}))


if __name__ == "__main__":
    main()
