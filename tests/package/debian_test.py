#!/usr/bin/python3
"""Tests of the Debian packages: their dependencies, and that their contents run where they are unpacked.

Usage: debian_test.py SOURCE_FOLDER BUILD_FOLDER
"""
import re
import unittest

from folders import BUILD, FOLDER, SOURCE, check_program, files_below, mentions_of_sources, modules, python, run


def field(package, name):
    return run("dpkg-deb", "--field", package, name).strip()


def names(dependencies):
    return set(re.findall(r"(?:^|, |\| )([a-z0-9.+-]+)", dependencies))


class Packages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        # Fastest compression.
        run("cpack", "--config", BUILD / "CPackConfig.cmake", "-B", FOLDER / "packages", "-D",
            "CPACK_DEBIAN_COMPRESSION_TYPE=gzip")
        cls.program, cls.libraries, cls.python = (next((FOLDER / "packages").glob(f"{name}_*_*.deb"))
                                                  for name in ("latcon", "latcon-dev", "python3-latcon"))

    def test_name_their_version(self):
        project = re.search(r"project\(latcon VERSION ([\d.]+)", (SOURCE / "CMakeLists.txt").read_text()).group(1)
        for package in (self.program, self.libraries, self.python):
            self.assertEqual(field(package, "Version"), project)

    def test_ask_for_what_they_need(self):
        runtime = names(field(self.program, "Depends"))
        self.assertLessEqual({"libc6", "libdeal.ii-9.4.1", "libhwy1", "libopenmpi3", "libvtk9.1", "libjs-dygraphs", "python3-matplotlib",
                              "python3-numpy", "python3-pil", "python3-vtk9"}, runtime)
        listed = set((SOURCE / "cmake/packages.txt").read_text().split("\n"))
        by_hand = {name for name in runtime if name.startswith(("libjs", "python3"))} | names(field(self.program, "Recommends"))
        self.assertLessEqual(by_hand | names(field(self.libraries, "Depends")), listed)
        # Third-party modules that the report imports.
        imported = {module for path in [*SOURCE.glob("verification/report/*.py"), *SOURCE.glob("verification/claims/*/*.py")]
                    for module in re.findall(r"^\s*(?:import|from) (\w+)", path.read_text(), re.M)}
        packages = {"matplotlib": "python3-matplotlib", "numpy": "python3-numpy", "vtkmodules": "python3-vtk9",
                    "vtk": "python3-vtk9", "PIL": "python3-pil", "h5py": "python3-h5py"}
        self.assertLessEqual({packages[module] for module in imported & set(packages)}, runtime)

    def test_program_runs_where_it_is_unpacked(self):
        root = FOLDER / "root"
        run("dpkg-deb", "--extract", self.program, root)
        self.assertEqual(mentions_of_sources(root), [])
        for name in ("share/man/man1/latcon.1.gz", "share/bash-completion/completions/latcon",
                     "share/doc/latcon/copyright"):
            self.assertTrue((root / "usr" / name).is_file(), name)
        check_program(self, root / "usr")

    def test_python_package_asks_for_what_it_imports_and_runs_the_program(self):
        version = field(self.program, "Version")
        depends, recommends = (field(self.python, name) for name in ("Depends", "Recommends"))
        self.assertIn(f"latcon (= {version})", depends)
        self.assertEqual(field(self.python, "Architecture"), "all")
        listed = {line for name in ("packages", "packages-tests")
                  for line in (SOURCE / f"cmake/{name}.txt").read_text().split("\n")}
        self.assertLessEqual((names(depends) | names(recommends)) - {"latcon"}, listed)
        packages = {"matplotlib": "python3-matplotlib", "numpy": "python3-numpy", "pandas": "python3-pandas",
                    "vtkmodules": "python3-vtk9", "xarray": "python3-xarray"}
        for path in (SOURCE / "python/latcon").rglob("*.py"):
            for indent, module in re.findall(r"^(\s*)(?:import|from) (\w+)", path.read_text(), re.M):
                if module in packages:
                    self.assertIn(packages[module], names(recommends if indent.strip("\n") else depends), path)
        root = FOLDER / "root-python"
        for package in (self.program, self.python):
            run("dpkg-deb", "--extract", package, root)
        self.assertEqual(mentions_of_sources(root), [])
        self.assertEqual(modules(root / "usr/lib/python3/dist-packages/latcon"), modules(SOURCE / "python/latcon"))
        self.assertEqual(python(root / "usr", "import latcon.fit; print(latcon.Case('quick')['Sheet/length'], latcon.find_program())").split(),
                         ["0.04", str(root / "usr/bin/latcon")])

    def test_libraries_hold_every_header(self):
        root = FOLDER / "root-dev"
        run("dpkg-deb", "--extract", self.libraries, root)
        self.assertEqual(mentions_of_sources(root), [])
        for side in ("support", "lattice", "continuum"):
            self.assertEqual({path.name for path in files_below(root / "usr/include/latcon" / side)},
                             {path.name for pattern in ("*.h", "*.inc") for path in (SOURCE / side).rglob(pattern)})


if __name__ == "__main__":
    unittest.main()
