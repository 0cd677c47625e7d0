"""A fit finds parameters and their uncertainties, records every point, and continues where it stopped.

A function stands in for the crack.
"""
import fcntl
import json
import math
import pathlib

import numpy as np
import pytest

import latcon
from latcon.fit import Observation, Parameter, fit_case, search
from latcon.fit.misfit import UNDETERMINED

STRETCH, DENSITY, SEED = "Fracture/breaking stretch", "Material/density", "Lattice/noise seed"
SPEED, WAVELENGTH = "crack.speed_lagrangian", "crack.wavelength"

PARAMETERS = [Parameter(STRETCH, 2.8, 3.2), Parameter(DENSITY, np.int64(500), np.float32(1500))]
OBSERVATIONS = [Observation(SPEED, 19.0, 0.3), Observation(WAVELENGTH, 0.01, 0.0005)]
SOLUTION = {STRETCH: 3.03417, DENSITY: 1000}  # of 20 - 30 e + 20 e^2 = 19


class Crack:
    """Stands in for the pool and the program: two quantities, of which each seed has its own error; notes its runs.

    `body` is called first, with the values of the case and the directory; it returns the exit code and message of the run,
    and a third item if nothing was measured, or None. An error of the body is raised before the quantities are measured.
    """

    def __init__(self):
        self.runs = []
        self.body = None
        self.failed_rows = {}

    def pool(self, n_jobs, limit, start, ended, waiting, stop):
        for begin in range(0, n_jobs, limit):
            together = [(job, *start(job)) for job in range(begin, min(begin + limit, n_jobs))]
            for job, command, log in reversed(together):  # they end in another order
                ended(job, self.run(command[1:], pathlib.Path(log)))

    def run(self, words, log):
        assert words[0] == "fracture" and {"--no-report", "--skip-verification", "--threads"} - set(words) <= {"--skip-verification"}
        overrides = dict(word.split("=", 1) for option, word in zip(words, words[1:]) if option == "--set")
        directory = pathlib.Path(words[words.index("--output-dir") + 1])
        assert log == directory / "log.txt"
        stretch, density, seed = (float(overrides[key]) for key in (STRETCH, DENSITY, SEED))
        self.runs.append((directory.name, "--resume" in words, overrides))
        code, message, measured = 0, "", True
        if self.body:
            code, message, *rest = self.body(stretch=stretch, density=density, seed=seed, directory=directory) or (0, "")
            measured = not rest
        log.write_text(f"done\nlatcon: {message}\n")
        if not measured:
            return code
        speed = 20 - 30 * (stretch - 3) + 20 * (stretch - 3)**2 + 0.1 * (-1)**seed
        crack = {"speed_lagrangian": speed, "speed_lagrangian_uncertainty": 0.3,
                 "wavelength": density / 1e5 if density < 1150 else None,
                 "pattern": "oscillating" if density < 1200 else "straight"}
        (directory / "crack.json").write_text(json.dumps(crack))
        (directory / "run.json").write_text(json.dumps({"failed_rows": self.failed_rows}))
        return code


@pytest.fixture
def crack(monkeypatch):
    found = Crack()
    monkeypatch.setattr(search, "run_processes", found.pool)
    return found


@pytest.fixture(scope="module")
def base():
    return latcon.Case("quick")


@pytest.fixture
def small_fit(base, crack):
    def fit(directory, *, case=base, parameters=PARAMETERS, observations=OBSERVATIONS, **options):
        return fit_case(case, parameters, observations, directory,
                        **{"evaluations": 16, "batch": 4, "workers": 1, "progress": False, "seeds": [1, 2], **options})
    return fit


def lines(directory):
    return (directory / "evaluations.jsonl").read_text().splitlines()


def test_finds_the_minimum_and_its_uncertainties(small_fit, crack, tmp_path):
    parameters = [PARAMETERS[0], Parameter(DENSITY, "0.5 g/cm^3", "1500 kg/m^3")]
    result = small_fit(tmp_path / "fit", parameters=parameters, evaluations=24)
    table = result.parameters
    assert list(table.index) == [STRETCH, DENSITY] and list(table["unit"]) == ["1", "kg/m^3"]
    assert list(table["lower"]) == [2.8, 500]
    for key, value in SOLUTION.items():
        assert table.loc[key, "estimate"] == pytest.approx(value, abs=0.1 * table.loc[key, "uncertainty"])
        assert table.loc[key, "determined"]
    # The scatter 0.1 sqrt(2) of two seeds adds to the uncertainty of the observed speed; 28.6 is the slope.
    assert result.observations.loc[SPEED, "scatter"] == pytest.approx(0.1 * math.sqrt(2) / math.sqrt((1 - 2 / 9)**3))
    total = math.hypot(0.3, result.observations.loc[SPEED, "scatter"] / math.sqrt(2))
    assert table.loc[STRETCH, "uncertainty"] == pytest.approx(total / 28.63, rel=0.02)
    assert table.loc[DENSITY, "uncertainty"] == pytest.approx(0.0005 * 1e5, rel=0.03)  # 1 / sqrt(12) of the box adds 1.5 %
    assert result.misfit < 0.1 and result.best[DENSITY] == pytest.approx(1000, rel=0.02)
    assert result.case[DENSITY] == result.best[DENSITY]
    assert set(result.points["stage"]) == {"sobol", "tpe", "local"} and len(result.points) == 24
    near = result.near_equal["misfit"]
    assert near.is_monotonic_increasing and near.iloc[0] == result.misfit and near.iloc[-1] <= result.misfit + 5.992
    assert len(near) == (result.points["misfit"] <= result.misfit + 5.991).sum()
    assert not list((tmp_path / "fit" / "runs").iterdir())


def test_shows_what_is_not_determined(small_fit, crack, tmp_path):
    result = small_fit(tmp_path / "one", observations=OBSERVATIONS[:1])
    assert list(result.parameters["determined"]) == [True, False]
    directions = result.directions
    assert list(directions["determined"]) == [True, False]
    assert abs(directions[STRETCH][0]) > 0.99 and abs(directions[DENSITY][1]) > 0.99
    assert directions["uncertainty"][0] == pytest.approx(result.parameters.loc[STRETCH, "uncertainty"] / 0.4, rel=0.03)
    assert result.describe_directions() == [f"{DENSITY} is not determined"] and f"{DENSITY} is not determined" in str(result)
    # Only a product is observed: a trade-off.
    product = Observation("product", 3000.0, 30.0, measure=lambda run: 1e5 * run.crack.wavelength.value * stretch_of(run))
    result = small_fit(tmp_path / "two", observations=[product], parameters=[PARAMETERS[0], Parameter(DENSITY, 900, 1100)])
    assert list(result.parameters["determined"]) == [False, False]
    assert list(result.directions["determined"]) == [True, False]
    (text,) = result.describe_directions()
    assert "trade-off" in text and STRETCH in text and DENSITY in text
    assert result.parameters.loc[DENSITY, "fixed_others"] < 0.5 * result.parameters.loc[DENSITY, "uncertainty"]


def stretch_of(run):
    offset = (20 - run.crack.speed_lagrangian.value) / 30
    return 3 + offset + 20 / 30 * offset**2


def test_words_are_compared_with_the_fraction_of_seeds(small_fit, crack, tmp_path):
    words = [Observation("crack.pattern", "oscillating"), Observation(SPEED, 20.0, 0.1)]
    result = small_fit(tmp_path / "fit", observations=words)
    points = result.points
    assert (points["crack.pattern"] == (points[DENSITY] < 1200)).all()
    straight = points["crack.pattern"] == 0
    assert straight.any() and (points.loc[straight, "misfit"] >= 25).all()  # (1 / 0.2)^2
    assert result.best[DENSITY] < 1200 and result.parameters.loc[STRETCH, "estimate"] == pytest.approx(3, abs=2e-3)


def test_refused_failed_and_undetermined_points_are_recorded_and_worse(small_fit, crack, tmp_path):
    crack.body = lambda stretch, seed, **_: ((2, "too stretched", "nothing") if stretch > 3.1 else
                                             (4, "blew up", "nothing") if stretch < 2.85 and seed == 2 else None)
    result = small_fit(tmp_path / "fit", evaluations=24)
    points = result.points
    refused, failed = points[STRETCH] > 3.1, points[STRETCH] < 2.85
    assert refused.any() and failed.any()
    assert (points.loc[refused, ["ended", "message"]] == ["refused", "too stretched"]).all(axis=None)
    assert (points.loc[failed, ["ended", "message"]] == ["failed", "blew up"]).all(axis=None)
    assert np.isinf(points.loc[refused | failed, "misfit"]).all() and np.isfinite(points.loc[~refused & ~failed, "misfit"]).all()
    undetermined = ~refused & ~failed & (points[DENSITY] >= 1150)
    assert undetermined.any() and points.loc[undetermined, WAVELENGTH].isna().all()
    assert (points.loc[undetermined, "misfit"] >= UNDETERMINED).all()
    assert result.parameters.loc[DENSITY, "estimate"] == pytest.approx(1000, abs=5)
    assert f"{refused.sum()} refused" in str(result) and f"{failed.sum()} failed" in str(result)


def test_a_crack_that_misses_its_reference_values_is_measured(small_fit, crack, tmp_path):
    crack.body = lambda **_: (3, "the wavelength differs")
    crack.failed_rows = {"fracture: wavelength": "reference"}
    assert set(small_fit(tmp_path / "fit", evaluations=4).points["ended"]) == {"done"}


def test_a_crack_whose_energies_do_not_balance_is_not_measured(small_fit, crack, tmp_path):
    crack.body = lambda stretch, **_: (3, "") if stretch > 3.1 else None
    crack.failed_rows = {"fracture: wavelength": "reference", "fracture: energy imbalance": "ledger"}
    points = small_fit(tmp_path / "fit", evaluations=16).points
    lost = points[STRETCH] > 3.1
    assert lost.any() and not lost.all()
    assert (points.loc[lost, ["ended", "message"]] ==
            ["refused", "failed its checks: fracture: energy imbalance (ledger)"]).all(axis=None)
    assert np.isinf(points.loc[lost, "misfit"]).all() and (points.loc[~lost, "ended"] == "done").all()


@pytest.mark.parametrize("code", [2, 3])
def test_a_first_batch_without_result_is_an_error(small_fit, crack, tmp_path, code):
    crack.body = lambda **_: (code, "no rubber", "nothing")
    with pytest.raises(latcon.LatconError, match="no run of the first 4 points is done; the first was refused: no rubber"):
        small_fit(tmp_path / "fit")
    assert len(crack.runs) == 8


@pytest.mark.parametrize("code, kind", [(5, latcon.OutputFailed), (130, latcon.Interrupted), (137, latcon.errors.ProgramError)])
def test_a_full_disk_or_a_signal_stops_the_fit_and_a_later_call_continues_it(small_fit, crack, tmp_path, code, kind):
    crack.body = lambda directory, **_: (code, "disk full", "nothing") if directory.name.startswith("00005") else None
    with pytest.raises(kind, match="00005-.: killed by signal 9" if code == 137 else "disk full"):
        small_fit(tmp_path / "fit")
    assert len(lines(tmp_path / "fit")) == 5
    crack.body = None
    assert len(small_fit(tmp_path / "fit").points) == 16


def test_an_interrupted_fit_continues_with_the_same_bits(small_fit, crack, tmp_path):
    small_fit(tmp_path / "whole")
    expected, count = lines(tmp_path / "whole"), len(crack.runs)
    assert count == 32 and [json.loads(line)["number"] for line in expected] == list(range(16))
    seen = []

    def interrupt(line):
        seen.append(line)
        if len(seen) in (3, 7):
            raise KeyboardInterrupt
    for _ in range(2):
        with pytest.raises(KeyboardInterrupt):
            small_fit(tmp_path / "cut", progress=interrupt)
    with open(tmp_path / "cut" / "evaluations.jsonl", "a") as file:
        file.write('{"number":7,"st')  # a killed process leaves part of a line
    result = small_fit(tmp_path / "cut", progress=seen.append)
    assert lines(tmp_path / "cut") == expected
    assert seen[-1].startswith("16 of 16 points, least misfit ") and len(seen) == 16
    assert len(crack.runs) <= count + 32 + 4  # a run that was stopped runs again, no other does
    assert result.points.equals(small_fit(tmp_path / "whole").points)
    assert len(crack.runs) <= count + 32 + 4
    more = small_fit(tmp_path / "cut", evaluations=20)
    assert len(more.points) == 20 and lines(tmp_path / "cut")[:16] == expected


def test_points_do_not_depend_on_the_number_of_workers(small_fit, crack, tmp_path):
    small_fit(tmp_path / "one", evaluations=64)
    small_fit(tmp_path / "four", evaluations=64, workers=4)
    assert sorted(lines(tmp_path / "four"), key=lambda line: json.loads(line)["number"]) == lines(tmp_path / "one")


def test_a_stopped_fit_continues_and_a_folder_with_another_case_is_removed(small_fit, crack, tmp_path):
    def stop(directory, **_):
        if directory.name == "00001-1":
            (directory / "case.prm").write_text("another case")
            raise KeyboardInterrupt
    crack.body = stop
    with pytest.raises(KeyboardInterrupt):
        small_fit(tmp_path / "fit")
    crack.body = None
    small_fit(tmp_path / "fit", evaluations=4)
    assert [resume for name, resume, _ in crack.runs if name == "00001-1"] == [False, False]
    assert len(lines(tmp_path / "fit")) == 4


def test_a_run_that_a_killed_fit_left_is_waited_for_and_continued(small_fit, crack, base, tmp_path, monkeypatch):
    small_fit(tmp_path / "fit", evaluations=4)
    kept = lines(tmp_path / "fit")
    (tmp_path / "fit" / "evaluations.jsonl").write_text("\n".join(kept[:3]) + "\n")
    values = json.loads(kept[3])["values"]
    case = base.set(STRETCH, values[STRETCH]).set(DENSITY, values[DENSITY]).set(SEED, 1)
    folder = tmp_path / "fit" / "runs" / "00003-1"
    folder.mkdir()
    (folder / "case.prm").write_text(case.text())
    held = open(folder / ".latcon.lock", "w")
    fcntl.flock(held, fcntl.LOCK_EX)
    before = len(crack.runs)
    free = []
    crack.body = lambda **_: free.append(held.closed)
    lock, refused = fcntl.flock, []

    def lock_until_refused_twice(file, operation):
        try:
            lock(file, operation)
        except BlockingIOError:
            refused.append(file)
            if len(refused) == 2:
                held.close()  # the run ends
            raise
    monkeypatch.setattr(fcntl, "flock", lock_until_refused_twice)
    small_fit(tmp_path / "fit", evaluations=4)
    assert free == [True, True] and lines(tmp_path / "fit") == kept
    assert [(name, resume) for name, resume, _ in crack.runs[before:]] == [("00003-1", True), ("00003-2", False)]


def test_a_directory_holds_one_fit_at_a_time(small_fit, crack, base, tmp_path):
    small_fit(tmp_path / "fit", evaluations=4)
    for change, what in ((dict(seeds=[1, 3]), "seeds"), (dict(skip_verification=True), "skip_verification"),
                         (dict(parameters=PARAMETERS[:1]), "parameters"), (dict(observations=OBSERVATIONS[:1]), "quantities")):
        with pytest.raises(latcon.LatconError, match=f"holds another fit; different: {what}; choose another directory"):
            small_fit(tmp_path / "fit", evaluations=4, **change)
    with pytest.raises(latcon.LatconError, match="different: case"):
        small_fit(tmp_path / "fit", case=base.set("Sheet/height", "2 cm"))
    held = open(tmp_path / "fit" / ".latcon.lock")
    fcntl.flock(held, fcntl.LOCK_EX)
    with pytest.raises(latcon.LatconError, match="fit is in use by another process"):
        small_fit(tmp_path / "fit", evaluations=4)
    held.close()
    assert len(crack.runs) == 8
    # Other observed values are another misfit of the same points.
    other = small_fit(tmp_path / "fit", evaluations=4, observations=[Observation(SPEED, 1.0, 0.3), OBSERVATIONS[1]])
    assert other.misfit > 1000 and len(crack.runs) == 8
    (tmp_path / "fit" / "evaluations.jsonl").write_text('{"number": 0}\n')
    with pytest.raises(latcon.UnreadableFile, match="line 1 is no evaluated point"):
        small_fit(tmp_path / "fit", evaluations=4)
    for name in ("run.json", "case.prm"):  # of a run, and of the user
        folder = tmp_path / name.partition(".")[0]
        folder.mkdir()
        (folder / name).write_text("{}")
        with pytest.raises(latcon.LatconError, match="holds a case.prm, which would be replaced"):
            small_fit(folder)
        assert (folder / name).read_text() == "{}" and not (folder / "fit.json").exists()


def test_wrong_arguments_are_refused_before_anything_runs(small_fit, crack, tmp_path):
    for change, message in (
            (dict(parameters=[]), "at least one parameter"), (dict(observations=[]), "at least one observation"),
            (dict(parameters=[PARAMETERS[0], PARAMETERS[0]]), "given twice"), (dict(evaluations=0), "evaluations = 0"),
            (dict(parameters=[Parameter(STRETCH, 3, 2)]), "must increase"), (dict(seeds=[]), "seeds"), (dict(seeds=[1, 1]), "seeds"),
            (dict(parameters=[Parameter("Viscosity/law", 1, 2)]), "unknown"),
            (dict(parameters=[Parameter("Contact/present", 0, 1)]), "only numbers"),
            (dict(parameters=[Parameter(STRETCH, 0.0, 2, True)]), "be positive"),
            (dict(parameters=[Parameter(STRETCH, "3 kg", 4)]), "3 kg"), (dict(parameters=[Parameter(SEED, 1, 4)], seeds=None), "over seeds"),
            (dict(observations=[Observation("speed", 1, 1)]), "crack.NAME"), (dict(command="verify"), "must be one of"),
            (dict(observations=[Observation("crack.sped_lagrangian", 1, 1)]), "no quantity 'sped_lagrangian'; nearest: speed_lagrangian"),
            (dict(observations=[Observation("crack.wedge_angle", 1, 1)]), "known: speed_lagrangian, "),
            (dict(observations=[Observation("crack.pattern", "oscilating")]), "no pattern 'oscilating'; nearest: oscillating"),
            (dict(observations=[Observation(SPEED, 1)]), "positive uncertainty"),
            (dict(observations=[Observation(SPEED, math.nan, 1)]), "finite value"),
            (dict(command="lattice"), "crack.NAME or near_tip.NAME of a crack")):
        with pytest.raises(ValueError, match=message):
            small_fit(tmp_path / "fit", **change)
    assert not crack.runs and not (tmp_path / "fit").exists()
    for observation, message in ((Observation("crack.side", 1, 1), "no quantity 'crack.side'"),
                                 (Observation("crack.pattern", 1, 1), "'oscillating'|'straight'"),
                                 (Observation(SPEED, "fast"), "the observed value is 'fast'")):
        with pytest.raises(ValueError, match=message):
            small_fit(tmp_path / observation.quantity, observations=[observation])


def test_page_has_tables_and_pictures(small_fit, crack, tmp_path):
    crack.body = lambda stretch, **_: (2, "<stretched>", "nothing") if stretch > 3.1 else None
    result = small_fit(tmp_path / "fit")
    page = result.to_html()
    text = page.read_text()
    assert page == tmp_path / "fit" / "fit.html" and text.count("data:image/png;base64,") == 2
    assert all(part in text for part in (STRETCH, DENSITY, SPEED, "Points without result", "&lt;stretched&gt;"))
    assert "<stretched>" not in text
    one = small_fit(tmp_path / "one", parameters=[PARAMETERS[0], Parameter(DENSITY, 900, 900.1)], evaluations=4)
    assert one.model is None and one.parameters["estimate"].isna().all() and "too few points" in str(one)
    assert one.to_html(tmp_path / "own.html").read_text().count("<img") == 2


def test_integers_and_logarithmic_parameters(small_fit, crack, tmp_path):
    parameters = [*PARAMETERS[:1], Parameter(DENSITY, 100, 10000, True), Parameter("Fracture/seed sites", 4, 9)]
    result = small_fit(tmp_path / "fit", parameters=parameters, keep_runs=True, evaluations=8)
    points = result.points
    assert set(points["Fracture/seed sites"]) <= set(range(4, 10)) and len(set(points["Fracture/seed sites"])) > 2
    assert (points[DENSITY] < 1000).sum() in (3, 4, 5)  # half of a logarithmic range
    kept = sorted(path.name for path in (tmp_path / "fit" / "runs").iterdir())
    assert kept[:2] == ["00000-1", "00000-2"] and len(kept) == 16
    overrides = next(found for name, _, found in crack.runs if name == "00000-1")
    assert overrides["Fracture/seed sites"] == f"{points['Fracture/seed sites'][0]:.0f}"


def test_entries_are_made_of_parameters_that_are_none(small_fit, crack, tmp_path):
    """The product of modulus and relaxation time of a branch, and a factor of two entries."""
    def entries(values):
        return {DENSITY: 1000 * values["scale"], "Nearest neighbours/branch moduli": [values["branch viscosity"] / 1e-4],
                "Nearest neighbours/relaxation times": [1e-4]}
    parameters = [PARAMETERS[0], Parameter("scale", 0.5, 1.5, unit="1"), Parameter("branch viscosity", 1, 10, True, "Pa s")]
    result = small_fit(tmp_path / "fit", parameters=parameters, entries=entries, evaluations=24)
    table = result.parameters
    assert list(table["unit"]) == ["1", "1", "Pa s"] and list(table["determined"]) == [True, True, False]
    assert table.loc["scale", "estimate"] == pytest.approx(1, abs=0.1 * table.loc["scale", "uncertainty"])
    overrides = crack.runs[0][2]
    assert float(overrides["Nearest neighbours/branch moduli"]) == pytest.approx(result.points["branch viscosity"][0] / 1e-4)
    assert result.case[DENSITY] == 1000 * result.best["scale"]
    # Continued with the same function, refused with another.
    count = len(crack.runs)
    small_fit(tmp_path / "fit", parameters=parameters, entries=entries, evaluations=24)
    assert len(crack.runs) == count
    with pytest.raises(latcon.LatconError, match="different: entries"):
        small_fit(tmp_path / "fit", parameters=parameters, entries=lambda values: {**entries(values), DENSITY: 900 * values["scale"]})


def test_parameters_that_are_no_entries_are_checked(small_fit, crack, tmp_path):
    scale = Parameter("scale", 0.5, 1.5, unit="1")
    for change, message in ((dict(parameters=[scale]), "`entries` must make"),
                            (dict(parameters=[Parameter(STRETCH, 2.8, 3.2, unit="1")]), "leave out `unit`"),
                            (dict(parameters=[Parameter("scale", "1 mm", "2 mm", unit="m")]), "must be numbers in m")):
        with pytest.raises(ValueError, match=message):
            small_fit(tmp_path / "fit", **change)
    for made, error in (({"Material/weight": 1}, latcon.UnknownEntry), ({DENSITY: -1}, latcon.BadInput)):
        with pytest.raises(error):
            small_fit(tmp_path / "fit", parameters=[scale], entries=lambda _, made=made: made)
    assert not crack.runs and not (tmp_path / "fit").exists()
