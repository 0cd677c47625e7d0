"""Checks that an installed latcon needs neither its sources nor its build folder: the program runs, and other programs can be
built on its libraries.
"""
import json
import shutil

import pytest

from folders import BUILD, FOLDER, check_program, mentions_of_sources, python, run

PREFIX = FOLDER / "prefix"


@pytest.fixture(scope="module", autouse=True)
def once():
    run("cmake", "--install", BUILD, "--prefix", PREFIX)


def test_knows_neither_sources_nor_build():
    assert mentions_of_sources(PREFIX) == []


def test_program_runs():
    check_program(PREFIX)


def test_python_package_runs_the_program_of_its_prefix():
    assert python(PREFIX, "print(latcon.find_program(), latcon.Case('quick')['Sheet/length'])").split() == (
        [str((PREFIX / "bin/latcon").resolve()), "0.04"])


def test_example_with_laws_of_its_own_is_built_and_right():
    own = FOLDER / "own-laws"
    shutil.copytree(PREFIX / "share/doc/latcon-dev/examples/own-laws", own)
    run("cmake", "-S", own, "-B", own / "build", "-G", "Ninja", "-D", "CMAKE_BUILD_TYPE=Release",
        "-D", "CMAKE_CXX_FLAGS_RELEASE=-O0",  # faster to build
        "-D", f"CMAKE_PREFIX_PATH={PREFIX}", "-D", "CMAKE_EXPORT_COMPILE_COMMANDS=ON")
    run("cmake", "--build", own / "build", "--parallel", "2")
    assert mentions_of_sources(own) == []
    for entry in json.loads((own / "build/compile_commands.json").read_text()):
        assert str(PREFIX / "include/latcon") in entry["command"]
        assert "-ffp-contract=off" in entry["command"]
        assert "-W" not in entry["command"]  # latcon's warning flags are not exported
    assert "all agree" in run(own / "build/bond_law")
    assert "all agree" in run(own / "build/bond_memory")
    assert "they agree" in run(own / "build/gradient_energy")


def test_other_versions_are_refused():
    version = (PREFIX / "lib/cmake/latcon/latconConfigVersion.cmake").read_text()
    assert "PACKAGE_VERSION" in version
    asker = FOLDER / "asker"
    asker.mkdir()
    (asker / "CMakeLists.txt").write_text("cmake_minimum_required(VERSION 3.25)\nproject(asker LANGUAGES C CXX)\n"
                                          "find_package(latcon 99 REQUIRED)\n")
    assert "99" in run("cmake", "-S", asker, "-B", asker / "build", "-D", f"CMAKE_PREFIX_PATH={PREFIX}", fails=True)
