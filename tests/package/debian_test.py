"""Tests of the Debian packages: their dependencies, and that their contents run where they are unpacked."""
import json
import re
import shlex
import types

import pytest

from folders import BUILD, FOLDER, SOURCE, VERSION, check_program, files_below, mentions_of_sources, modules, python, run


def field(package, name):
    return run("dpkg-deb", "--field", package, name).strip()


def names(dependencies):
    return set(re.findall(r"(?:^|, |\| )([a-z0-9.+-]+)", dependencies))


@pytest.fixture(scope="module")
def once():
    # Fastest compression.
    made = types.SimpleNamespace()
    run("cpack", "--config", BUILD / "CPackConfig.cmake", "-B", FOLDER / "packages", "-D", "CPACK_DEBIAN_COMPRESSION_TYPE=gzip")
    made.program, made.libraries, made.python = (next((FOLDER / "packages").glob(f"{name}_*_*.deb"))
                                              for name in ("latcon", "latcon-dev", "python3-latcon"))
    return made


def test_name_their_version(once):
    assert [field(package, "Version") for package in (once.program, once.libraries, once.python)] == [VERSION] * 3


def test_ask_for_what_they_need(once):
    runtime = names(field(once.program, "Depends"))
    assert {"libc6", "libdeal.ii-9.4.1", "libhwy1", "libopenmpi3", "libvtk9.1", "libjs-dygraphs", "python3-matplotlib",
                          "python3-numpy", "python3-pil", "python3-vtk9"} <= runtime
    listed = set((SOURCE / "cmake/packages.txt").read_text().split("\n"))
    by_hand = {name for name in runtime if name.startswith(("libjs", "python3"))} | names(field(once.program, "Recommends"))
    assert by_hand | names(field(once.libraries, "Depends")) <= listed
    # Third-party modules that the report imports.
    imported = {module for path in [*SOURCE.glob("python/latcon/report/*.py"), *SOURCE.glob("verification/claims/*/*.py")]
                for module in re.findall(r"^\s*(?:import|from) (\w+)", path.read_text(), re.M)}
    packages = {"matplotlib": "python3-matplotlib", "numpy": "python3-numpy", "vtkmodules": "python3-vtk9",
                "vtk": "python3-vtk9", "PIL": "python3-pil", "jinja2": "python3-jinja2", "h5py": "python3-h5py"}
    assert {packages[module] for module in imported & set(packages)} <= runtime


def test_program_runs_where_it_is_unpacked(once):
    root = FOLDER / "root"
    run("dpkg-deb", "--extract", once.program, root)
    assert mentions_of_sources(root) == []
    for name in ("share/man/man1/latcon.1.gz", "share/bash-completion/completions/latcon", "share/doc/latcon/copyright"):
        assert (root / "usr" / name).is_file(), name
    check_program(root / "usr")


def test_shipped_cases_wait_for_no_claims(once):
    root = FOLDER / "root-verdicts"
    run("dpkg-deb", "--extract", once.program, root)
    assert {path.stat().st_mode & 0o777 for path in (root / "usr/share/latcon/verdicts").glob("*.json")} == {0o644}
    for case, reused in (("quick", True), ("spectrum", True), ("quick --set Loading/strain\ y=1.84", False)):
        out = FOLDER / "shipped"
        run(root / "usr/bin/latcon", "fracture", *shlex.split(case), "--set", "Time/end=1 us", "--no-report", "--output-dir", out)
        record = json.loads((out / "run.json").read_text())
        assert record["verification"]["reused"] is reused, case
        assert record["verification_of_program"]["reused"], case


def test_python_package_asks_for_what_it_imports_and_runs_the_program(once):
    version = field(once.program, "Version")
    depends, recommends = (field(once.python, name) for name in ("Depends", "Recommends"))
    assert f"latcon (= {version})" in depends
    assert field(once.python, "Architecture") == "all"
    listed = {line for name in ("packages", "packages-tests") for line in (SOURCE / f"cmake/{name}.txt").read_text().split("\n")}
    assert (names(depends) | names(recommends)) - {"latcon"} <= listed
    packages = {"matplotlib": "python3-matplotlib", "numpy": "python3-numpy", "pandas": "python3-pandas",
                "vtkmodules": "python3-vtk9", "xarray": "python3-xarray"}
    for path in (SOURCE / "python/latcon").rglob("*.py"):
        for indent, module in re.findall(r"^(\s*)(?:import|from) (\w+)", path.read_text(), re.M):
            if module in packages:
                needed = names(depends) | names(field(once.program, "Depends"))
                assert packages[module] in (needed | names(recommends) if indent.strip("\n") else needed), path
    root = FOLDER / "root-python"
    for package in (once.program, once.python):
        run("dpkg-deb", "--extract", package, root)
    assert mentions_of_sources(root) == []
    assert modules(root / "usr/lib/python3/dist-packages/latcon") == modules(SOURCE / "python/latcon")
    assert python(root / "usr", "import latcon.fit; print(latcon.Case('quick')['Sheet/length'], latcon.find_program())").split() == (
        ["0.04", str(root / "usr/bin/latcon")])


def test_libraries_hold_every_header(once):
    root = FOLDER / "root-dev"
    run("dpkg-deb", "--extract", once.libraries, root)
    assert mentions_of_sources(root) == []
    for side in ("support", "lattice", "continuum"):
        assert {path.name for path in files_below(root / "usr/include/latcon" / side)} == (
            {path.name for pattern in ("*.h", "*.inc") for path in (SOURCE / side).rglob(pattern)})
