"""Tests that the results of a run of the program are read as they were written."""
import itertools
import json
import math
import os
import shutil
import signal
import sys
import types

import numpy as np
import pytest

import latcon
from conftest import rows, tiny_case
from latcon.quantities import NAMES, RECORDED


def test_crack_has_values_uncertainties_and_units(crack):
    raw = json.loads((crack.directory / "crack.json").read_text())
    speed = crack.crack.speed_lagrangian
    assert (speed.value, speed.unit) == (raw["speed_lagrangian"], "m/s") and float(speed) == speed.value
    assert speed.uncertainty == raw["speed_lagrangian_uncertainty"] or math.isnan(speed.uncertainty)
    assert crack.crack["pattern"] == raw["pattern"] == crack.crack.pattern
    assert crack.crack.nearest_to_breaking.X.unit == "m"
    for name, value in raw.items():
        if value is None and not name.endswith("_uncertainty"):
            assert math.isnan(crack.crack[name].value) and str(crack.crack[name]) == "not determined"
    assert not any(name.endswith("_uncertainty") or name == "units" for name in crack.crack)
    with pytest.raises(AttributeError, match="wavelenght"):
        crack.crack.wavelenght
    assert str(latcon.Value(0.0243900138, 0.000292, "m")) == "0.02439 ± 0.00029 m"
    assert len(crack.near_tip) > 30
    path = latcon.Quantities({"wavelength": 1e-3, "wavelength_uncertainty": 1e-4, "speed_lagrangian": None})
    assert (str(path.wavelength), path.speed_lagrangian.unit) == ("0.00100 ± 0.00010 m", "m/s")


def test_recorded_quantities_are_those_of_the_files(crack):
    written = {name for file in NAMES for name in json.loads((crack.directory / f"{file}.json").read_text())}
    assert {"crack": {"side", *crack.crack}, "near_tip": set(crack.near_tip)} == {file: set(names) for file, names in NAMES.items()}
    derived = {"zeta", *(name for name in RECORDED if "_over_d" in name or name.startswith("path_") or name.endswith("_per_area"))}
    assert set(RECORDED) - derived <= written and not derived & written
    others = {"pattern", "reason", "thresholds", "nearest_to_breaking", "skip_verification", "units", "sampled_from", "sampled_to",
              "sinusoid_offset", "sinusoid_slope", "sinusoid_phase"}
    assert written - set(RECORDED) == others


def test_crack_of_the_nonlocal_continuum_is_read_alike(tmp_path):
    case = tiny_case().set("Time/integrator", "runge-kutta-chebyshev").set("Time/end", "0.05 ms")
    run = latcon.fracture(case, tmp_path / "out", skip_verification=True, report=False, progress=False, side="continuum")
    assert run.info["side"] == run.crack["side"] == "continuum"
    last = latcon.open(tmp_path / "out").frames[-1]
    assert len(last.position) == 81 * 49  # twice as fine as the lattice
    assert last.bonds.max() < len(last.position) and (last.stretch > 1).all()


@pytest.mark.parametrize("file, name", [("crack.csv", "path"), ("energy.csv", "energy"), ("broken_bonds.csv", "broken_bonds")])
def test_tables_are_the_files_to_the_last_bit(crack, file, name):
    table, written = getattr(crack, name), rows(crack.directory / file)
    assert len(table) == len(written) > 10
    assert list(table.columns) == list(written[0]) == list(table.attrs["units"])
    for column in table:
        assert (table[column].to_numpy(float) == [float(row[column]) for row in written]).all(), column
    assert table.attrs["units"]["t"] == "s"
    assert all(table[column].dtype == np.int64 for column in table if column in ("site", "other_site", "bonds_broken"))


def test_results_and_provenance(crack):
    written = json.loads((crack.directory / "results.json").read_text())["claims"]
    assert crack.results.to_dict("records")[0]["quantity"] == written[0]["quantity"]
    assert len(crack.results) == len(written) and set(crack.results["verdict"]) <= {"holds", "fails", "reported"}
    assert crack.exit_code == 0 and crack.info["skip_verification"] is True
    assert crack.case["Sheet/height"] == 0.015
    assert crack.case.resolved() == tiny_case().resolved()


def test_frames_hold_sites_and_bonds(crack):
    frames = crack.frames
    assert len(frames) == len(frames.times) >= 3 and frames.times[0] == 0
    first, last = frames[0], frames[-1]
    assert last.time == frames.times[-1] and [frame.time for frame in frames[1:]] == list(frames.times[1:])
    for frame in (first, last):
        reference, current = (np.linalg.norm(np.diff(place[frame.bonds], axis=1)[:, 0], axis=1)
                              for place in (frame.reference, frame.position))
        np.testing.assert_allclose(frame.stretch, current / reference, rtol=1e-12)
        assert frame.fields["velocity"].shape == frame.reference.shape
        assert frame.fields["cauchy_stress"].shape == (len(frame.reference), 2, 2)
        assert frame.units["cauchy_stress"] == "Pa" and frame.units["stretch"] == "1"
    # Broken bonds are between neighbours of the first frame, and not among the bonds of the last.
    place = {int(site): row for row, site in enumerate(last.fields["site"])}
    pairs = {frozenset(pair) for pair in last.bonds.tolist()}
    inside = crack.broken_bonds[crack.broken_bonds["t"] < last.time]
    assert len(inside) > 10
    for bond in inside.itertuples():
        ends = [place[bond.site], place[bond.other_site]]
        assert frozenset(ends) not in pairs
        np.testing.assert_allclose(last.reference[ends].mean(axis=0), [bond.X, bond.Y], atol=1e-12)
    F = np.diag([1 + crack.case["Loading/strain x"], 1 + crack.case["Loading/strain y"]])
    np.testing.assert_allclose(np.median(first.fields["deformation_gradient"], axis=0), F, atol=0.05)
    assert len(crack.motion) > 3 and len(crack.motion[-1].bonds) == 0


def test_fields_near_the_tip(crack):
    data = crack.near_tip_fields()
    assert data["velocity"].dims == ("Y", "X", "i") and data["cauchy_stress"].dims == ("Y", "X", "i", "J")
    assert data["velocity"].attrs["units"] == "m/s" and data["X"].attrs["units"] == "m"
    assert data.attrs["samples"] == crack.near_tip.samples.value
    # The window of the case: 40 spacings behind the tip.
    spacing = crack.case["Sheet/spacing"]
    assert data["X"].values[0] == pytest.approx(-40 * spacing) and np.diff(data["X"].values) == pytest.approx(spacing)
    straight_ahead = data["occupancy"].sel(Y=0, X=4 * spacing, method="nearest")
    assert straight_ahead == 1


def test_plots_show_the_data(crack):
    with pytest.MonkeyPatch.context() as system:
        system.setitem(sys.modules, "pandas", None)  # which ./run does not install
        axes = latcon.open(crack.directory).plot_path(color="red", label="own")
    (tip,) = axes.lines
    assert (tip.get_color(), tip.get_label()) == ("red", "own")
    np.testing.assert_array_equal(tip.get_xdata(), 100 * crack.path["X"])
    frame = crack.frames[0]
    for color, values in (("stretch", frame.stretch),
                          ("velocity x", frame.fields["velocity"][frame.bonds].mean(axis=1)[:, 0]),
                          ("cauchy_stress xy", frame.fields["cauchy_stress"][frame.bonds].mean(axis=1)[:, 0, 1])):
        axes = crack.plot_sheet(0, color, cmap="magma", clim=(0, 1), linewidths=2)
        lines = axes.collections[0]
        assert (lines.get_cmap().name, lines.get_clim(), lines.get_linewidths()) == ("magma", (0, 1), [2])
        np.testing.assert_array_equal(axes.collections[0].get_array(), np.sort(values))
    for color in ("mood", "velocity", "stretch x", "velocity z"):
        with pytest.raises(ValueError, match=color.split()[0]):
            crack.plot_sheet(0, color)


def test_damaged_and_missing_files_are_named(crack, tmp_path):
    copy = tmp_path / "copy"
    for file, damage, action in (
            ("crack.json", "{", lambda run: run.crack), ("crack.json", "[]", lambda run: run.crack),
            ("crack.json", None, lambda run: run.crack), ("crack.csv", "t,X\n1\n", lambda run: run.path),
            ("crack.csv", "", lambda run: run.path), ("energy.csv", "t,elastic\n0,much\n", lambda run: run.energy),
            ("lattice.pvd", "<VTK", lambda run: run.frames), ("lattice.pvd", "<V><DataSet/></V>", lambda run: run.frames),
            ("lattice-0000.vtp", "<VTKFile", lambda run: run.frames[0]), ("lattice-0000.vtp", None, lambda run: run.frames[0]),
            ("near_tip.vti", "x", lambda run: run.near_tip_fields()), ("results.json", "{}", lambda run: run.results),
            ("case.prm", None, lambda run: run.case)):
        shutil.rmtree(copy, ignore_errors=True)
        shutil.copytree(crack.directory, copy)
        (copy / file).unlink()
        if damage is not None:
            (copy / file).write_text(damage)
        with pytest.raises(latcon.UnreadableFile, match=file) as caught:
            action(latcon.open(copy))
        assert caught.value.path == copy / file
        assert damage is not None or "no such file" in caught.value.problem.lower()
    for file, action in (("lattice-0000.vtp", lambda run: run.frames[0]), ("near_tip.vti", lambda run: run.near_tip_fields())):
        whole = (crack.directory / file).read_bytes()
        damaged = [whole[:int(share * len(whole))] for share in (0.2, 0.5, 0.9, 0.999)]
        damaged += [whole[:at] + bytes(200) + whole[at + 200:] for at in (int(share * len(whole)) for share in (0.5, 0.9))]
        for content in damaged:
            (copy / file).write_bytes(content)
            with pytest.raises(latcon.UnreadableFile, match=file):
                action(latcon.open(copy))
    with pytest.raises(latcon.UnreadableFile, match="run.json: No such file"):
        latcon.open(tmp_path)


def test_a_run_is_read_where_the_program_is_not(crack, monkeypatch):
    values, text = crack.case.resolved(), crack.case.text()
    monkeypatch.setenv("LATCON", "/no/latcon")
    run = latcon.open(crack.directory)
    assert set(run.case.resolved()) == set(values)
    assert all(run.case[key] == value or isinstance(value, (list, str)) for key, value in values.items())
    assert run.case.text() == text
    assert len(run.frames[-1].bonds) > 1000 and len(run.path) > 10 and run.crack.speed_lagrangian.value > 0
    page = run.to_html()
    assert run.plot_path() and page == run.directory / "report.html" and "<html" in page.read_text()
    with pytest.raises(latcon.ProgramNotFound):
        run.case.set("Sheet/height", 1)


def test_a_page_shows_rows_that_fail(crack, tmp_path):
    run = shutil.copytree(crack.directory, tmp_path / "run")
    results = json.loads((run / "results.json").read_text())
    results["claims"][0].update(error=2, tolerance=1, verdict="fails")
    (run / "results.json").write_text(json.dumps(results))
    assert "Fails" in latcon.open(run).to_html().read_text()


def library(monkeypatch, name, **functions):
    monkeypatch.setitem(sys.modules, name, types.SimpleNamespace(**functions))


def test_frames_of_both_sides_are_those_of_other_libraries(crack, tmp_path, monkeypatch):
    sheet = tiny_case().set({"Continuum/cells x": 6, "Continuum/cells y": 4})
    continuum = latcon.continuum(sheet, tmp_path / "continuum", progress=False).frames[-1]
    lattice = crack.frames[-1]
    assert len(continuum.cells) >= 24 and len(continuum.bonds) == 0 == len(lattice.cells) and continuum.units["displacement"] == "m"
    corners = continuum.reference[continuum.cells[:, :4]]
    area = 0.5 * sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0] for a, b in ((corners[:, i - 1], corners[:, i]) for i in range(4)))
    assert area.sum() == pytest.approx(np.prod(np.ptp(continuum.reference, axis=0)))
    for frame, converter in itertools.product((lattice, continuum), ("pyvista", "meshio", "ase")):
        monkeypatch.setitem(sys.modules, converter, None)
        with pytest.raises(latcon.LatconError, match=f"to_{converter} needs the Python package {converter}"):
            getattr(frame, f"to_{converter}")()
    library(monkeypatch, "meshio", Mesh=lambda *arguments: arguments)
    library(monkeypatch, "pyvista", wrap=lambda data: data)
    fields = {}
    library(monkeypatch, "ase", Atoms=lambda **options: types.SimpleNamespace(
        set_array=lambda name, values: fields.update({name: values}), **options))
    atoms = lattice.to_ase()
    np.testing.assert_array_equal(atoms.positions[:, :2], 1e10 * lattice.position)
    assert set(fields) == set(lattice.fields) and atoms.info == {"time": lattice.time} and not atoms.positions[:, 2].any()
    for frame, kind, parts in ((lattice, "line", lattice.bonds), (continuum, "VTK_LAGRANGE_QUADRILATERAL", continuum.cells)):
        points, ((name, cells),), fields, of_bonds = frame.to_meshio()
        assert points is frame.reference and cells is parts and name in (kind, "quad") and fields == frame.fields
        assert list(of_bonds) == list(frame.bond_fields)
        assert frame.to_pyvista().GetNumberOfCells() == (len(frame.cells) or len(frame.reference) + len(frame.bonds))
        write = tmp_path / ("frame.vtu" if len(frame.cells) else "frame.vtp")
        latcon.frames.write_frame(write, frame)
        with pytest.raises(FileNotFoundError):
            latcon.frames.write_frame(tmp_path / "missing" / write.name, frame)
        read = latcon.frames.read_frame(write, frame.time)
        assert read.units == {name: unit for name, unit in frame.units.items() if name in (*frame.fields, *frame.bond_fields)}
        for one, same in ((frame.cells, read.cells), (frame.bonds, read.bonds), (frame.position, read.position),
                          (frame.stretch, read.stretch), *((frame.fields[name], read.fields[name]) for name in frame.fields)):
            np.testing.assert_array_equal(one, same)


def test_errors_of_the_program_are_raised(tmp_path):
    with pytest.raises(latcon.BadInput, match="Sheet/height = 1 kg") as caught:
        latcon.fracture(tiny_case().set("Sheet/height", "1 kg"), tmp_path / "out", progress=False)
    assert caught.value.directory == tmp_path / "out" and not (tmp_path / "out").exists()
    with pytest.raises(latcon.BadInput, match="name of the folder is empty"):
        latcon.lattice(tiny_case().set("Sheet/height", "1 kg"), "", progress=False)
    (tmp_path / "file").touch()
    with pytest.raises(latcon.OutputFailed):
        latcon.lattice(tiny_case(), tmp_path / "file" / "out", progress=False)


def test_each_command_passes_the_confirmation_on(stand_in, tmp_path, monkeypatch):
    words = tmp_path / "words"
    case = tiny_case()
    stand_in(f"pathlib.Path({str(words)!r}).write_text(' '.join(sys.argv[1:])); sys.exit(2)")
    for command in (latcon.fracture, latcon.lattice, latcon.continuum):
        for yes in (False, True):
            with pytest.raises(latcon.BadInput):
                command(case, tmp_path / "out", yes=yes, progress=False)
            assert (words.read_text().split()[0], "--yes" in words.read_text().split()) == (command.__name__, yes)


@pytest.mark.usefixtures("needs_mount")
def test_without_the_packages_of_the_report_a_run_keeps_its_results_and_says_what_to_install(stand_in, tmp_path, crack):
    bare = f'mount -t tmpfs none /usr/lib/python3/dist-packages/vtkmodules || exit 77; exec {latcon.find_program()} "$@"'
    stand_in(f"import os\nos.execvp('unshare', ['unshare', '-m', 'sh', '-c', {bare!r}, 'sh', *sys.argv[1:]])")
    with pytest.raises(latcon.OutputFailed, match="install.*python3-vtk9") as caught:
        latcon.fracture(tiny_case(), tmp_path / "out", skip_verification=True, progress=False)
    assert "Traceback" not in caught.value.message and "so far" not in caught.value.message
    assert latcon.open(caught.value.directory).path.equals(crack.path)


def test_ctrl_c_leaves_a_checkpoint_from_which_the_run_continues(crack, tmp_path):
    lines = []

    def interrupt(line):
        lines.append(line)
        if len(lines) == 1:
            os.kill(os.getpid(), signal.SIGINT)
    case = tiny_case()
    with pytest.raises(latcon.Interrupted) as caught:
        latcon.fracture(case, tmp_path, skip_verification=True, report=False, progress=interrupt)
    assert caught.value.exit_code == 130
    stopped = latcon.open(tmp_path)
    assert stopped.exit_code == 130 and list((tmp_path / "checkpoints").glob("*.h5"))
    assert stopped.path["t"].iloc[-1] < crack.path["t"].iloc[-1]
    resumed = latcon.fracture(case, tmp_path, skip_verification=True, report=False, resume=True, progress=False)
    assert resumed.path.equals(crack.path) and "resumed_from" in resumed.info


def test_other_commands(tmp_path):
    case = tiny_case()
    relaxed = latcon.lattice(case, tmp_path / "lattice", threads=3, progress=False)
    assert list(relaxed.frames.times) == [0, 1] and relaxed.info["threads"] == 3
    sheet = case.set("Continuum/cells x", 4).set("Continuum/cells y", 2).set("Continuum/refinements", 0)
    assert latcon.continuum(sheet, tmp_path / "continuum", progress=False).energy.attrs["units"]["elastic"] == "J/m"
    verified = latcon.verify("intrinsic-length", directory=tmp_path / "verify", case=case, quick=True, progress=False)
    assert set(verified.results["claim"]) == {"intrinsic-length"} and "fails" not in set(verified.results["verdict"])
