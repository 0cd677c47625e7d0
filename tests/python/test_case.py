"""Tests of cases: they are read by the program, and are immutable."""
import numpy as np
import pytest

import latcon


def test_values_are_in_si_and_typed():
    case = latcon.Case("fig1.prm")
    assert case["Sheet/spacing"] == 0.625e-3
    assert case["Time/step"] is None
    assert case["Contact/present"] is True
    assert case["Lattice/noise seed"] == 1 and isinstance(case["Lattice/noise seed"], int)
    assert case["Sheet/orientation"] == "rows-along-crack"


def test_shipped_cases_have_names_and_files_have_paths(tmp_path, monkeypatch):
    assert latcon.Case("fig1").file == latcon.Case("fig1.prm").file
    own = tmp_path / "quick.prm"
    own.write_text(latcon.Case("quick").file.read_text().replace("length = 4 cm", "length = 3 cm"))
    assert latcon.Case(own)["Sheet/length"] == 0.03
    monkeypatch.chdir(tmp_path)
    assert latcon.Case("quick.prm").file == own  # a file of the user takes precedence
    with pytest.raises(latcon.BadInput, match=r"fig2\.prm: no such case file; .*\bfig1\b"):
        latcon.Case("fig2.prm")
    for name in latcon.schema().cases:
        assert set(latcon.Case(name).resolved()) == set(latcon.schema())


def test_set_returns_another_case():
    base = latcon.Case("quick")
    first, second = base.set("Sheet/height", "2 cm"), base.set("Lattice/noise seed", 7)
    assert (base["Sheet/height"], first["Sheet/height"], second["Sheet/height"]) == (0.025, 0.02, 0.025)
    assert (first["Lattice/noise seed"], second["Lattice/noise seed"]) == (1, 7)
    assert first.set("Sheet/height", "3 cm")["Sheet/height"] == 0.03  # the last value counts
    assert base.overrides == {}


def test_cases_are_compared_by_their_values_and_made_of_a_dictionary():
    base = latcon.Case("quick")
    changed = base.set({"Sheet/height": "2 cm", "Time/step": 1e-8})
    assert changed == base.set("Sheet/height", 0.02).set("Time/step", "10 ns") != base and changed != "quick"
    assert base.diff(changed) == {"Sheet/height": (0.025, 0.02), "Time/step": (None, 1e-8)} and base.diff(base) == {}
    assert latcon.Case.from_dict(changed.resolved()) == changed
    with pytest.raises(latcon.UnknownEntry, match="Sheet/height"):
        base.set({"Sheet/length": 1, "Sheet/heigth": 1})
    for wrong in (("Sheet/height",), ({"Sheet/height": 1}, 2)):
        with pytest.raises(TypeError, match="mapping"):
            base.set(*wrong)


@pytest.mark.parametrize("key, value, read", [
    ("Sheet/height", 0.03, 0.03), ("Sheet/height", np.float64(0.1) * 0.3, 0.1 * 0.3), ("Lattice/noise seed", np.int64(3), 3),
    ("Contact/present", False, False), ("Contact/present", np.bool_(False), False), ("Time/step", None, None),
    ("Sheet/orientation", "rows-across-crack", "rows-across-crack"), ("Fracture/breaking stretch", 1 / 3 + 3, 1 / 3 + 3)])
def test_values_keep_every_bit(key, value, read):
    assert latcon.Case("quick").set(key, value)[key] == read


def test_unknown_entries_are_refused_with_the_nearest():
    case = latcon.Case("quick")
    for action in (lambda: case.set("Sheet/heigth", 1), lambda: case["Sheet/heigth"]):
        with pytest.raises(latcon.UnknownEntry, match="nearest known key: Sheet/height") as caught:
            action()
        assert isinstance(caught.value, KeyError) and caught.value.exit_code == 2
    with pytest.raises(TypeError, match="Sheet/height"):
        case.set("Sheet/height", object())
    with pytest.raises(TypeError, match="iterable"):
        list(case)


def test_bad_values_are_reported_by_the_program_all_at_once():
    case = latcon.Case("quick").set("Sheet/height", "1 kg").set("Material/density", -1)
    with pytest.raises(latcon.BadInput) as caught:
        case.resolved()
    assert caught.value.exit_code == 2 and "latcon: " not in caught.value.message
    assert all(part in caught.value.message for part in ("Sheet/height = 1 kg", "Material/density = -1"))


def test_a_written_case_is_the_case(tmp_path):
    case = latcon.Case("quick").set("Sheet/height", "2 cm").set("Time/safety factor", 1 / 3)
    written = latcon.Case(case.write(tmp_path / "own.prm"))
    assert written.resolved() == case.resolved()
    assert set(written.resolved()) == set(latcon.schema())
    assert [path.name for path in tmp_path.iterdir()] == ["own.prm"]
    with pytest.raises(latcon.BadInput):
        case.set("Sheet/height", "1 mm").write(tmp_path / "own.prm")
    assert latcon.Case(tmp_path / "own.prm")["Sheet/height"] == 0.02
    with pytest.raises(ValueError, match="json"):
        case.write(tmp_path / "own.json")


def test_a_file_that_changes_is_read_again(tmp_path):
    path = latcon.Case("quick").write(tmp_path / "own.prm")
    case = latcon.Case(path)
    assert case["Lattice/noise seed"] == 1
    case.set("Lattice/noise seed", 12).write(path)
    assert case["Lattice/noise seed"] == 12
    path.unlink()
    with pytest.raises(latcon.BadInput, match="own.prm"):
        case["Lattice/noise seed"]
