"""A dry run estimates memory and time. What it refuses: refusals_test.py."""
import re

from program import CASES, latcon, latcon_on_ranks, read_json, settings


# Dry runs estimate memory and time, and runs that exceed the memory of the machine are refused.
def memory(*arguments):
    """Estimated peak memory and the part that the program uses before the run, both in bytes."""
    run = latcon(*arguments, "--dry-run")
    line, = re.findall("^# memory: .*$", run.stdout, re.M)
    peak, own = re.fullmatch(r"# memory: about (\d+) bytes .* itself takes (\d+) bytes; available: .*", line).groups()
    return int(peak), int(own)


def assert_foreseen(out, *arguments):
    """Checks the estimate to a factor of two, without the memory of the libraries."""
    peak, own = memory(*arguments)
    latcon(*arguments, "--output-dir", out, "--quiet", expect=(0, 3))
    taken = read_json(out / "run.json")["peak_memory_bytes"]
    assert taken - own > 5e7  # large enough for a meaningful difference
    assert 0.5 * (taken - own) < peak - own < 2. * (taken - own)


def test_memory_of_lattices(out):
    fine = settings("Sheet/spacing=0.1 mm", "Time/end=2e-8", "Time/step=1e-8")
    for command in [["lattice", CASES / "quick.prm", *settings("Lattice/solution=motion")],
                    ["fracture", CASES / "quick.prm", "--skip-verification", "--no-report"]]:
        assert_foreseen(out, *command, *fine)


def test_memory_of_finite_elements(out):
    gradient = settings("Continuum/gradient=lattice")
    for cells, *entries in [(24, *gradient), (48, *gradient, *settings("Continuum/direct limit=0")), (64,)]:
        assert_foreseen(out, "continuum", CASES / "quick.prm", *entries,
                        *settings(f"Continuum/cells x={cells}", f"Continuum/cells y={cells}"))


def test_what_does_not_fit_is_refused_with_its_number(out):
    for command, *entries in [("lattice", "Sheet/length=40 m", "Sheet/height=25 m"),
                              ("fracture", "Sheet/length=40 m", "Sheet/height=25 m"),
                              ("continuum", "Continuum/cells x=8192", "Continuum/cells y=8192")]:
        for mode in [[], ["--dry-run"]]:
            run = latcon(command, CASES / "quick.prm", "--output-dir", out, *settings(*entries), *mode, expect=2)
            assert re.search(r"not enough memory: .* about \d{11,} bytes", run.stderr)
            assert not out.exists()
            assert ("# memory: about" in run.stdout) == bool(mode)


def test_ranks_say_it_once():
    run = latcon_on_ranks(2, "continuum", CASES / "quick.prm", "--dry-run", "--threads", 1)
    for line in ("subsection Sheet", "# time: about", "# memory: about"):
        assert run.stdout.count(line) == 1


def test_dry_run_says_the_time_at_most():
    """A crack that does not run takes all steps, a thousand times as many as one that runs."""
    run = latcon("fracture", CASES / "quick.prm", "--dry-run", "--threads", 1, "--set", "Time/end=10 s")
    steps = re.search(r"s, (\S+) steps at most, (\S+) if the crack is as fast", run.stdout)
    seconds = re.search(r"^# time: about (\S+) s on 1 threads of each rank, at most (\S+) s if", run.stdout, re.M)
    ratio = float(steps[1]) / float(steps[2])
    assert ratio > 1000.
    # Both times are rounded up to whole seconds.
    assert float(seconds[1]) * ratio * (1. + 1e-4) >= float(seconds[2]) - 1.
    assert float(seconds[2]) > (float(seconds[1]) - 1.) * ratio


def test_sizes_steps_and_time_are_there():
    run = latcon("fracture", CASES / "quick.prm", "--dry-run", "--threads", 1)
    for wanted in [r"^# lattice: 3032 sites, 17572 bonds, 6064 unknowns", r"^# time step: .* s, \d+ steps at most",
                   r"^# time: about \d+ s on 1 threads"]:
        assert re.search(re.compile(wanted, re.M), run.stdout)
    run = latcon("continuum", CASES / "quick.prm", "--dry-run", *settings("Continuum/solution=motion"))
    for wanted in [r"^# continuum: 96 cells, 1850 unknowns", r"^# motion: time step .* s, \d+ steps", r"^# time: about"]:
        assert re.search(re.compile(wanted, re.M), run.stdout)
