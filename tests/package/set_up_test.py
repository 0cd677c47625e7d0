#!/usr/bin/python3
"""Checks that cmake/set-up.sh builds in its own clone and is silent if there is nothing to build, and the exit codes of ./run.

Usage: set_up_test.py SOURCE_FOLDER BUILD_FOLDER
"""
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

from folders import SOURCE

# A project with the steps of every build of latcon: search for added files, and for the commit.
PROJECT = """\
cmake_minimum_required(VERSION 3.25)
project(small C)
option(BUILD_TESTING "" OFF)
file(GLOB sources CONFIGURE_DEPENDS *.c)
add_executable(latcon ${sources})
add_custom_target(commit
  COMMAND ${CMAKE_COMMAND} -D SOURCE=${PROJECT_SOURCE_DIR} -D HEADER=${CMAKE_BINARY_DIR}/commit.h
          -P ${PROJECT_SOURCE_DIR}/cmake/git_commit.cmake
  BYPRODUCTS ${CMAKE_BINARY_DIR}/commit.h COMMENT "" VERBATIM)
add_dependencies(latcon commit)
target_include_directories(latcon PRIVATE ${CMAKE_BINARY_DIR})
"""
PROGRAM = """\
#include <stdio.h>
#include "commit.h"
int main(void) { puts("%s"); return LATCON_GIT_COMMIT[0] == 0; }
"""
PRESETS = {"version": 6, "configurePresets": [
    {"name": "release", "generator": "Ninja", "binaryDir": "${sourceDir}/build/release",
     "cacheVariables": {"BUILD_TESTING": "ON"}}]}


class Clone(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name).resolve()
        self.clone = self.folder / "clone"
        (self.clone / "cmake").mkdir(parents=True)
        (self.clone / "build" / "paraview").mkdir(parents=True)  # so that it is not downloaded
        for name in ("set-up.sh", "git_commit.cmake"):
            shutil.copy(SOURCE / "cmake" / name, self.clone / "cmake")
        for name in ("packages.txt", "packages-tests.txt"):
            (self.clone / "cmake" / name).write_text("# none\n")

    def run_in(self, folder, *words):
        environment = {name: value for name, value in os.environ.items() if not name.startswith("CMAKE_")}
        return subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False, env=environment)


class SetUp(Clone):
    def setUp(self):
        super().setUp()
        (self.clone / "CMakeLists.txt").write_text(PROJECT)
        (self.clone / "CMakePresets.json").write_text(json.dumps(PRESETS))
        (self.clone / "main.c").write_text(PROGRAM % "first")

    def set_up(self, clone):
        result = self.run_in(self.folder, clone / "cmake" / "set-up.sh", "release", "latcon")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertEqual(result.stdout, "")
        return result.stderr

    def says(self, clone):
        return self.run_in(self.folder, clone / "build" / "release" / "latcon").stdout

    @staticmethod
    def state(folder):
        return {path: path.stat().st_mtime_ns for path in folder.rglob("*") if path.is_file()}

    def test_shows_the_steps_of_the_first_build_alone(self):
        self.assertIn("Building", self.set_up(self.clone))
        self.assertEqual(self.says(self.clone), "first\n")
        self.assertEqual(self.set_up(self.clone), "")
        (self.clone / "main.c").write_text(PROGRAM % "second")
        self.assertEqual(self.set_up(self.clone), "")
        self.assertEqual(self.says(self.clone), "second\n")

    def builds_tests(self):
        return "BUILD_TESTING:BOOL=ON" in (self.clone / "build" / "release" / "CMakeCache.txt").read_text()

    def test_builds_tests_once_they_are_asked_for(self):
        self.set_up(self.clone)
        self.assertFalse(self.builds_tests())
        for configured in (True, False):
            result = self.run_in(self.folder, self.clone / "cmake" / "set-up.sh", "--with", "tests", "release", "latcon")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(result.stderr.startswith("Configuring (release)\n"), configured)
            self.assertEqual(result.stderr == "", not configured)
            self.assertTrue(self.builds_tests())
        self.assertEqual(self.set_up(self.clone), "")
        self.assertTrue(self.builds_tests())

    def test_says_why_it_failed(self):
        (self.clone / "main.c").write_text("no program\n")
        result = self.run_in(self.folder, self.clone / "cmake" / "set-up.sh", "release", "latcon")
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("main.c", result.stderr)

    def test_a_copied_clone_builds_in_its_own_place(self):
        self.set_up(self.clone)
        copy = self.folder / "copy"
        shutil.copytree(self.clone, copy, symlinks=True)
        (copy / "main.c").write_text(PROGRAM % "copy")
        before = self.state(self.clone)
        self.assertIn("Configuring", self.set_up(copy))
        self.assertEqual(self.says(copy), "copy\n")
        self.assertEqual(self.state(self.clone), before)
        self.assertEqual(self.set_up(copy), "")

    def test_a_moved_clone_builds_in_its_own_place(self):
        self.set_up(self.clone)
        moved = self.folder / "moved"
        self.clone.rename(moved)
        (moved / "main.c").write_text(PROGRAM % "moved")
        self.set_up(moved)
        self.assertEqual(self.says(moved), "moved\n")
        self.assertFalse(self.clone.exists())

    def test_a_clone_may_have_two_names(self):
        self.set_up(self.clone)
        (self.folder / "link").symlink_to(self.clone)
        self.assertEqual(self.set_up(self.folder / "link"), "")


class Run(Clone):
    """./run with a program that ends with a given exit code."""

    def setUp(self):
        super().setUp()
        shutil.copy(SOURCE / "run", self.clone)
        (self.clone / "cmake" / "set-up.sh").write_text("#!/bin/sh\n")
        program = self.clone / "build" / "release" / "verification" / "latcon"
        program.parent.mkdir(parents=True)
        program.write_text("#!/bin/sh\necho \"$1\"\neval exit \\${$1:-0}\n")
        for path in (self.clone / "cmake" / "set-up.sh", program):
            path.chmod(0o755)

    def test_ends_with_the_status_of_its_runs_and_of_their_report(self):
        # Exit code 3 of the report may refer to other runs in the folder.
        for verify, fracture, report, status in ((0, 0, 0, 0), (3, 0, 3, 3), (0, 4, 0, 4), (0, 0, 2, 2), (0, 0, 5, 5),
                                                 (0, 0, 3, 0), (0, 3, 2, 3)):
            with self.subTest(verify=verify, fracture=fracture, report=report):
                result = self.run_in(self.clone, "env", f"verify={verify}", f"fracture={fracture}", f"report={report}",
                                     "./run")
                self.assertEqual(result.returncode, status, result.stderr)
                self.assertEqual(result.stdout.split()[-1], "report")


if __name__ == "__main__":
    unittest.main(verbosity=2)
