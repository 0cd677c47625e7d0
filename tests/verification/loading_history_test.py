"""Strains of the edges that change in time: a crack that is unloaded and loaded again, from a case."""
from program import CASES, latcon, numbers, settings

STRIP = ["fracture", CASES / "quick.prm", "--skip-verification", "--no-report", "--quiet",
         *settings("Sheet/length=2.5 cm", "Sheet/height=1.25 cm", "Near tip/interval=0", "Time/end=1 ms", "Top edge/displacement x=free",
                   "Loading/history times=0.1 ms, 0.3 ms, 0.4003 ms, 0.7 ms", "Loading/history strain y=1.8, 0.6, 0.6, 1.8")]


def test_crack_stops_and_goes_on(out):
    latcon(*STRIP, "--output-dir", out, expect=(0, 3))
    times = numbers(out / "crack.csv")["t"].tolist()
    assert not any(3e-4 < time < 5e-4 for time in times) and min(times[1:]) < 2e-4 and max(times) > 7e-4
    ledger = numbers(out / "energy.csv")
    work = ledger["boundary_work"]
    assert work[0] == work[1] == 0 != work[-1] == work[-2]  # only while the edges move
    assert abs(ledger["imbalance"][-1]) < 5e-3 * ledger["viscous"][-1]
