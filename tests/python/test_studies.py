"""Tests that sweeps return the numbers of their runs, with any executor, and that studies are read."""
import concurrent.futures
import contextlib
import itertools
import json
import time
import types

import numpy as np
import pytest

import latcon
from conftest import tiny_case

STRAINS = np.array([1.5, 1.9])


class Lazy:
    """Executor of another library: futures that know result() alone."""

    def submit(self, function, *arguments):
        return types.SimpleNamespace(result=lambda: function(*arguments))


@pytest.fixture(scope="module")
def swept(tmp_path_factory):
    """Directory of a sweep, and its dataset."""
    directory = tmp_path_factory.mktemp("sweep") / "out"
    return directory, sweep(directory, progress=False)


def sweep(directory, **options):
    return latcon.sweep(tiny_case().set("Lattice/noise seed", 5), {"Loading/strain y": STRAINS}, directory, seeds=2,
                        skip_verification=True, report=False, **options)


def test_a_sweep_has_the_numbers_of_its_runs(swept):
    directory, data = swept
    assert data["speed_lagrangian"].dims == ("strain_y", "seed") and data["speed_lagrangian"].attrs["units"] == "m/s"
    np.testing.assert_array_equal(data["strain_y"], STRAINS)
    assert data["strain_y"].attrs == {"units": "1", "long_name": "Loading/strain y"}
    for strain, seed in itertools.product(STRAINS, (1, 2)):
        at = data.sel(strain_y=strain, seed=seed)
        run = latcon.open(directory / str(at["folder"].item()))
        assert (run.case["Loading/strain y"], run.case["Lattice/noise seed"]) == (strain, seed)
        assert at["pattern"] == run.crack.pattern and at["state"] == "measured"
        assert at["speed_lagrangian"] == run.crack.speed_lagrangian.value
    table = latcon.open_study(directory).table
    assert len(table) == 4 and table.attrs["units"]["wavelength"] == "m"
    np.testing.assert_array_equal(table["speed_lagrangian"], data["speed_lagrangian"].values.ravel())


def test_a_dataset_has_the_grid_of_its_sweep_alone(tmp_path):
    sets = {"a": {"Disorder/seed": "1"}, "b": {"Disorder/seed": "2"}, "low": {"Sheet/height": "1 cm"}, "again": {"Disorder/seed": "2"}}
    seeds = [{"run": name, "seed": 1, "folder": "", "state": "measured", "pattern": "straight", "values": {"end_time": place}}
             for place, name in enumerate(sets)]
    (tmp_path / "study.json").write_text(json.dumps({
        "runs": [{"run": name, "set": own} for name, own in sets.items()], "seeds": seeds, "swept": ["Disorder/seed"],
        "units": {"end_time": "s"}, "varied": [{"entry": "Disorder/seed", "unit": "1", "values": [1, 2, 1, 2]}]}))
    data = latcon.open_study(tmp_path).to_xarray()
    assert data["end_time"].dims == ("Disorder_seed", "seed") and data["end_time"].values.tolist() == [[0], [1]]


def test_a_repeated_sweep_uses_its_runs_again(swept):
    directory, data = swept
    files = sorted(directory.glob("runs/*/crack.json"))
    times = [file.stat().st_mtime_ns for file in files]
    assert sweep(directory, progress=False).equals(data) and [file.stat().st_mtime_ns for file in files] == times


def test_any_executor_gives_the_same_numbers(swept, tmp_path):
    lines = []
    assert sweep(tmp_path / "out", executor=Lazy(), tasks=2, progress=lines.append).equals(swept[1])
    assert lines[-1] == "1 of 2 tasks"


@pytest.mark.parametrize("code, error", [(3, None), (4, None), (5, latcon.OutputFailed), (130, latcon.Interrupted)])
def test_runs_that_fail_do_not_stop_a_sweep(stand_in, tmp_path, code, error):
    stand_in(f"sys.exit({code})")
    with pytest.raises(error) if error else contextlib.nullcontext():
        latcon.studies._run_study(["study"], tmp_path, None, False, False)


def test_wrong_sweeps_are_refused_before_any_run(tmp_path):
    for values, message in (({"Sheet/heigth": [1, 2]}, "nearest: Sheet/height"), ({"Sheet/height": ["1 cm"]}, "two values or more"),
                            ({"Sheet/height": ["1 cm", "1 kg"]}, "1 kg")):
        for executor in (None, Lazy()):
            with pytest.raises(latcon.BadInput, match=message):
                latcon.sweep(tiny_case(), values, tmp_path / "out", executor=executor, progress=False)
    assert not (tmp_path / "out").exists()
    with pytest.raises(latcon.UnreadableFile, match="study.json"):
        latcon.open_study(tmp_path)


def test_an_interrupted_sweep_stops_its_runs(tmp_path):
    class Stopping(concurrent.futures.ThreadPoolExecutor):
        def submit(self, *arguments):
            future = super().submit(*arguments)
            if arguments[1][-1].startswith("1/"):
                while not list(tmp_path.glob("out/runs/*.part/crack.csv")):
                    time.sleep(0.01)
                future.result = stop
            return future

    def stop():
        raise KeyboardInterrupt
    long = tiny_case().set({"Sheet/length": "60 cm", "Time/end": "1 s"})
    with Stopping(1) as executor, pytest.raises(KeyboardInterrupt):
        latcon.sweep(long, {"Loading/strain y": STRAINS}, tmp_path / "out", executor=executor, skip_verification=True, progress=False)
    assert len(list(tmp_path.glob("out/runs/*.part/checkpoints"))) == 1
