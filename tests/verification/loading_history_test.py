"""Strains of the edges that change in time: a crack that is unloaded and loaded again, from a case."""
from program import CASES, latcon, read_csv

STRIP = ["fracture", CASES / "quick.prm", "--skip-verification", "--no-report", "--quiet", "--set", "Sheet/length=2.5 cm", "--set",
         "Sheet/height=1.25 cm", "--set", "Near tip/interval=0", "--set", "Time/end=1 ms"]
HISTORY = ["--set", "Loading/history times=0.1 ms, 0.3 ms, 0.4003 ms, 0.7 ms", "--set", "Loading/history strain y=1.8, 0.6, 0.6, 1.8"]


def test_crack_stops_and_goes_on(out):
    sheet = [*STRIP, *HISTORY, "--set", "Top edge/displacement x=free"]
    run = latcon(*sheet, "--output-dir", out)
    assert run.returncode in (0, 3), run.stderr
    times = [float(row["t"]) for row in read_csv(out / "crack.csv")]
    assert not any(3e-4 < time < 5e-4 for time in times) and min(times[1:]) < 2e-4 and max(times) > 7e-4
    ledger = read_csv(out / "energy.csv")
    work = [float(row["boundary_work"]) for row in ledger]
    assert work[0] == work[1] == 0 != work[-1] == work[-2]  # only while the edges move
    assert abs(float(ledger[-1]["imbalance"])) < 5e-3 * float(ledger[-1]["viscous"])
