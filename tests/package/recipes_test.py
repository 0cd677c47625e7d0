#!/usr/bin/python3
"""Checks the recipes in packaging/ as far as possible without running them: syntax, versions, names of files, and dependencies,
which follow from cmake/packages.txt and CMakeLists.txt.

Usage: recipes_test.py SOURCE_FOLDER BUILD_FOLDER
"""
import re
import shlex
import subprocess
import sys
import tomllib
import types
import unittest
from unittest import mock

import yaml

from folders import SOURCE

PACKAGING = SOURCE / "packaging"
CMAKE = (SOURCE / "CMakeLists.txt").read_text()
PROJECT = tomllib.loads((SOURCE / "python/pyproject.toml").read_text())["project"]
VERSION = re.search(r"project\(latcon VERSION ([\d.]+)", CMAKE).group(1)
OPTIONS = set(re.findall(r"^option\((\w+)", CMAKE, re.M))
# Package names in Spack and conda-forge by those of Debian; None: not needed, for the reason given.
NAMES = {
    "cmake": ("cmake", "cmake"), "g++": ("cxx", "cxx-compiler"), "git": ("git", "git"), "ninja-build": ("ninja", "ninja"),
    "lld": None,  # links only what is configured with the presets
    "libopenmpi-dev": ("mpi", "openmpi"), "openmpi-bin": ("mpi", "openmpi"), "libdeal.ii-dev": ("dealii", "dealii"),
    "libopenblas0-pthread": ("blas", "libblas"), "libeigen3-dev": ("eigen", "eigen"), "libhwy-dev": ("highway", "libhwy"),
    "libvtk9-dev": ("vtk", "vtk-base"), "libboost-dev": ("boost", "libboost-devel"), "libcli11-dev": ("cli11", "cli11"),
    "libhdf5-openmpi-dev": ("hdf5", "hdf5"), "libssl-dev": ("openssl", "openssl"),
    "libmuparser-dev": ("muparser", "muparser"),
    "nlohmann-json3-dev": ("nlohmann-json", "nlohmann_json"), "python3": ("python", "python"),
    "python3-numpy": ("py-numpy", "numpy"), "python3-matplotlib": ("py-matplotlib", "matplotlib-base"),
    "python3-scipy": ("py-scipy", "scipy"), "python3-jinja2": ("py-jinja2", "jinja2"),
    "python3-pil": None,  # of the report, as below
    "python3-vtk9": None,  # the modules come with VTK
    "libjs-dygraphs": None,  # the report is drawn by Debian's interpreter
}
# Names by those in CMakeLists.txt, for what is required in a version.
REQUIRED = {"Eigen3": "libeigen3-dev", "hwy": "libhwy-dev", "VTK": "libvtk9-dev", "deal.II": "libdeal.ii-dev",
            "HDF5": "libhdf5-openmpi-dev", "Boost": "libboost-dev", "nlohmann_json": "nlohmann-json3-dev", "CLI11": "libcli11-dev",
            "OpenSSL": "libssl-dev", "MPI": "libopenmpi-dev"}


def listed(name):
    return [line for line in (SOURCE / f"cmake/{name}.txt").read_text().split("\n") if line and not line.startswith("#")]


def wanted(column):
    """Names that a recipe must depend on: those of packages.txt, and of the Python package."""
    python = {"py-" * (column == 0) + name for name in PROJECT["dependencies"]}
    return {NAMES[name][column] for name in listed("packages") if NAMES[name]} | python


def versions(column):
    """Least versions by name."""
    found = {NAMES[REQUIRED[name]][column]: version for name, version in re.findall(r"^find_package\((\S+) ([\d.]+)", CMAKE, re.M)}
    return found | {"cmake": re.search(r"cmake_minimum_required\(VERSION ([\d.]+)", CMAKE).group(1),
                    "python": PROJECT["requires-python"].removeprefix(">=")}


def syntax_of_shell(text):
    return subprocess.run(["bash", "-n"], input=text, capture_output=True, text=True, check=False).stderr


class Image(unittest.TestCase):
    def setUp(self):
        text = re.sub(r"^#.*\n", "", (PACKAGING / "Containerfile").read_text(), flags=re.M).replace("\\\n", " ")
        self.lines = [line.split(maxsplit=1) for line in text.split("\n") if line.strip()]

    def arguments(self, instruction):
        return [rest for word, rest in self.lines if word == instruction]

    def test_has_known_instructions_and_stages_on_debian_12(self):
        self.assertLessEqual({word for word, _ in self.lines}, {"FROM", "COPY", "WORKDIR", "RUN", "ARG", "ENV", "ENTRYPOINT"})
        stages = [rest.split() for rest in self.arguments("FROM")]
        self.assertEqual({words[0] for words in stages}, {"debian:12"})
        names = {words[2] for words in stages if len(words) == 3 and words[1] == "AS"}
        for rest in self.arguments("COPY"):
            *sources, _ = shlex.split(rest)
            if sources[0].startswith("--from="):
                self.assertIn(sources[0].removeprefix("--from="), names)
            else:
                self.assertTrue(all((SOURCE / source).exists() for source in sources), rest)

    def test_commands_are_whole_and_use_what_is_there(self):
        for command in self.arguments("RUN"):
            self.assertEqual(syntax_of_shell(command), "", command)
        commands = "\n".join(self.arguments("RUN"))
        self.assertIn("/latcon/cmake/set-up.sh --with tests\n", commands)
        self.assertIn("./test $TESTS", commands)
        default = re.search(r"set -- (\S+) '(.*)'$", (SOURCE / "test").read_text(), re.M)  # of ./test without arguments
        self.assertEqual(self.arguments("ARG"), [f'TESTS="{default[1]} {default[2]}"'])
        for words in re.findall(r"apt-get install ([^&]*)", commands):
            names = {word for word in words.split() if not word.startswith(("-", "/"))}
            self.assertLessEqual(names, {*listed("packages"), *listed("packages-tests")})


class Spack(unittest.TestCase):
    def setUp(self):
        """Runs the recipe with recorders in place of Spack's directives."""
        self.called = called = []
        stand_in = types.ModuleType("spack.package")
        for name in ("version", "depends_on", "license", "generator"):
            setattr(stand_in, name, lambda *words, directive=name, **options: called.append((directive, *words, options)))
        stand_in.CMakePackage = type("CMakePackage", (), {"define": staticmethod(lambda option, value: (option, value))})
        path = PACKAGING / "spack/packages/latcon/package.py"
        self.recipe = types.ModuleType("recipe")
        with mock.patch.dict(sys.modules, {"spack": types.ModuleType("spack"), "spack.package": stand_in}):
            exec(compile(path.read_text(), path, "exec"), self.recipe.__dict__)
        self.text = path.read_text()

    def values(self, directive):
        return [call[1] for call in self.called if call[0] == directive]

    def test_has_version_and_licence_of_the_project(self):
        self.assertEqual(self.values("version"), [VERSION])
        self.assertIn(f"latcon@{VERSION}", self.text)
        self.assertEqual(self.values("license"), [PROJECT["license"]["text"]])
        self.assertEqual(yaml.safe_load((PACKAGING / "spack/repo.yaml").read_text()), {"repo": {"namespace": "latcon"}})

    def test_depends_on_what_the_build_needs(self):
        needs = {re.match(r"[a-z0-9-]+", spec)[0]: spec for spec in self.values("depends_on")}
        self.assertEqual(set(needs), wanted(0) | {"c"})
        for name, version in versions(0).items():
            self.assertRegex(needs[name], rf"^{re.escape(name)}@{re.escape(version)}:( |$)")

    def test_python_modules_come_with_vtk(self):
        self.assertIn("+python", next(spec for spec in self.values("depends_on") if spec.startswith("vtk@")))

    def test_options_are_those_of_the_build(self):
        package = self.recipe.Latcon()
        package.spec = {"python": types.SimpleNamespace(command=types.SimpleNamespace(path="/spack/python3"))}
        options = dict(package.cmake_args())
        self.assertEqual(options.pop("Python3_EXECUTABLE"), "/spack/python3")
        self.assertLessEqual(set(options), OPTIONS)
        self.assertIn("BUILD_TESTING", options)


class Conda(unittest.TestCase):
    def setUp(self):
        self.recipe = yaml.safe_load((PACKAGING / "conda/meta.yaml").read_text())
        self.script = (PACKAGING / "conda/build.sh").read_text()

    def test_has_version_and_licence_of_the_project(self):
        self.assertLessEqual(set(self.recipe), {"package", "source", "build", "requirements", "test", "about"})
        self.assertEqual(self.recipe["package"], {"name": "latcon", "version": VERSION})
        self.assertEqual(self.recipe["about"]["license"], PROJECT["license"]["text"])
        self.assertTrue((SOURCE / self.recipe["about"]["license_file"]).is_file())
        self.assertTrue((PACKAGING / "conda" / self.recipe["source"]["path"]).resolve().samefile(SOURCE))

    def test_depends_on_what_the_build_needs(self):
        needs = {}
        for stage in ("build", "host", "run"):
            for line in self.recipe["requirements"][stage]:
                name, _, constraint = line.partition(" ")
                self.assertIn(needs.setdefault(name, constraint), (constraint, ""), line)
        # For the compiler of C, which CMake's search for MPI needs, and for pip.
        self.assertEqual(set(needs), wanted(1) | {"c-compiler", "pip", "setuptools"})
        for name, version in versions(1).items():
            if name != "openmpi":  # version of the standard
                self.assertEqual(needs[name].split()[0], f">={version}", name)

    def test_script_builds_the_program_and_the_package(self):
        self.assertEqual(syntax_of_shell(self.script), "")
        self.assertIn('-D Python3_EXECUTABLE="$PYTHON"', self.script)
        given = set(re.findall(r"-D (\w+)=", self.script)) - {"CMAKE_BUILD_TYPE", "CMAKE_INSTALL_PREFIX", "CMAKE_PREFIX_PATH",
                                                              "Python3_EXECUTABLE"}
        self.assertLessEqual(given, OPTIONS)
        self.assertIn("BUILD_TESTING", given)
        self.assertTrue((SOURCE / re.search(r"--no-index \./(\S+)", self.script)[1] / "pyproject.toml").is_file())
        for name in self.recipe["test"]["imports"]:
            self.assertTrue((SOURCE / "python" / name.replace(".", "/") / "__init__.py").is_file(), name)
        for command in self.recipe["test"]["commands"]:
            self.assertEqual(command.split()[0], "latcon")


if __name__ == "__main__":
    unittest.main()
