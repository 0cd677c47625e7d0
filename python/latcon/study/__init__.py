"""Studies: sweeps of cracks, their statistics, and verdicts on what a source states."""
