"""Strains of the edges that change in time: a crack that is unloaded and loaded again, from a case."""
import pytest

from program import CASES, expect_same, files, latcon, read_csv

STRIP = ["fracture", CASES / "quick.prm", "--skip-verification", "--no-report", "--quiet", "--set", "Sheet/length=2.5 cm", "--set",
         "Sheet/height=1.25 cm", "--set", "Near tip/interval=0", "--set", "Checkpoints/steps=100", "--set", "Time/end=1 ms"]
HISTORY = ["--set", "Loading/history times=0.1 ms, 0.3 ms, 0.4003 ms, 0.7 ms", "--set", "Loading/history strain y=1.8, 0.6, 0.6, 1.8"]


def test_crack_stops_and_goes_on_also_when_resumed(out):
    sheet = [*STRIP, *HISTORY, "--set", "Top edge/displacement x=free"]
    run = latcon(*sheet, "--output-dir", out)
    assert run.returncode in (0, 3), run.stderr
    times = [float(row["t"]) for row in read_csv(out / "crack.csv")]
    assert not any(3e-4 < time < 5e-4 for time in times) and min(times[1:]) < 2e-4 and max(times) > 7e-4
    ledger = read_csv(out / "energy.csv")
    work = [float(row["boundary_work"]) for row in ledger]
    assert work[0] == work[1] == 0 != work[-1] == work[-2]  # only while the edges move
    assert abs(float(ledger[-1]["imbalance"])) < 5e-3 * float(ledger[-1]["viscous"])
    expected = files(out)
    checkpoints = sorted((out / "checkpoints").glob("*.h5"))
    checkpoints[-1].unlink()  # the one before is within the last ramp, or the run would not have changed since
    run = latcon(*sheet, "--resume", "--output-dir", out)
    assert run.returncode in (0, 3), run.stderr
    expect_same(out, expected)


@pytest.mark.parametrize("entry, value, problem", [
    ("history times", "0.1 ms, 0.3 ms, 0.2 ms, 0.7 ms", "each time must be later than the one before"),
    ("history times", "0.1 ms", "one strain is needed for each of the 1 history times, not 4"),
    ("history strain y", "", "a history needs strains at its times"),
    ("history strain x", "1", "one strain is needed for each of the 4 history times, not 1"),
    ("history strain y", "1, 1, 1, -1", "> -1"),
])
def test_bad_histories_are_refused_with_their_place(out, tmp_path, entry, value, problem):
    case = tmp_path / "a.prm"
    entries = dict(text.removeprefix("Loading/").split("=") for text in HISTORY[1::2]) | {entry: value}
    lines = [f"  set {name} = {text}\n" for name, text in entries.items()]
    case.write_text((CASES / "quick.prm").read_text() + "subsection Loading\n" + "".join(lines) + "end\n")
    run = latcon("fracture", case, "--skip-verification", "--output-dir", out)
    assert run.returncode == 2 and f"{case}:" in run.stderr and problem in run.stderr, run.stderr
    assert not out.exists()


def test_what_has_one_loading_says_so(out):
    run = latcon(*STRIP, *HISTORY, "--set", "Fracture/right end=free", "--output-dir", out)
    assert run.returncode == 2 and "with a history, give held" in run.stderr, run.stderr
