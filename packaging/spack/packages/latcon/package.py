"""Spack recipe of latcon. In a clone: spack repo add packaging/spack; spack dev-build latcon@VERSION"""
from spack.package import *


class Latcon(CMakePackage):
    """Dynamic fracture of rubber on a triangular lattice of bonds, compared with the strain-gradient continuum that the lattice
    approximates."""

    license("LGPL-2.1-or-later")

    version("1.0.0")

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("ninja", type="build")
    depends_on("git", type="build")

    depends_on("mpi@3.1:")
    depends_on("dealii@9.4.1: +mpi+trilinos+p4est")
    depends_on("blas")
    depends_on("eigen@3.4:")
    depends_on("highway@1.0:")
    depends_on("vtk@9.1: +python")
    depends_on("boost@1.74:")
    depends_on("cli11@2.1:")
    depends_on("hdf5@1.10: +mpi")
    depends_on("openssl@3.0:")
    depends_on("muparser")
    depends_on("nlohmann-json@3.11:")

    # The build writes the manual page with Python; the Python package imports the others. Pages are drawn by /usr/bin/python3
    # of the system, with its packages.
    depends_on("python@3.11:", type=("build", "run"))
    depends_on("py-numpy", type="run")
    depends_on("py-scipy", type="run")
    depends_on("py-pandas", type="run")
    depends_on("py-jinja2", type="run")
    depends_on("py-matplotlib", type="run")

    generator("ninja")

    def cmake_args(self):
        off = ("BUILD_TESTING", "LATCON_BENCHMARKS", "LATCON_DOCS", "LATCON_PACKAGE")
        return [self.define("Python3_EXECUTABLE", self.spec["python"].command.path), *(self.define(option, False) for option in off)]

    def setup_run_environment(self, env):
        env.prepend_path("PYTHONPATH", join_path(self.prefix, "lib", "python3", "dist-packages"))
