"""Kills the program at random times, resumes it, and compares its results with those of the uninterrupted run."""
import time

import victims
import whole


class Failure(Exception):
    """Results were lost or differ."""


def kill_at_random(program, name, folder, rng, kills, ranks=(1,)):
    """@return number of kills, and of those before the first checkpoint"""
    arguments = victims.RUNS[name]
    expected, duration = victims.undisturbed(program, arguments, folder / "killed", name)  # pages name their folder
    out = folder / "killed"
    victims.renew(name, out)
    told = dict.fromkeys(("killed", "asked to stop", "done"), 0)
    without_checkpoint = 0
    while told["killed"] < kills:
        how = advance(program, arguments, out, rng, duration, ranks)
        told[how] += 1
        whole.check(out)
        if how == "done":
            compare(name, out, expected)
            victims.renew(name, out)
        without_checkpoint += how == "killed" and not list(out.glob("checkpoints/*.h5"))
    status, said = program.run(victims.resumed(arguments), out)
    if status not in victims.DONE:
        raise Failure(f"{name}: exit {status} after the last kill: {said}")
    compare(name, out, expected)
    print(name, told)
    return told["killed"], without_checkpoint


def advance(program, arguments, out, rng, duration, ranks):
    """Resumes the run and kills it, or occasionally sends SIGTERM. @return "killed", "asked to stop" or "done" before"""
    on = rng.choice(ranks)
    before = victims.time_of_change(out / "run.json")
    process = program.start(victims.on_threads(victims.resumed(arguments), rng.choice((1, 2))), out, ranks=on)
    # Most kills are after the start, when there is more to lose; some are during the start.
    if arguments[0] != "report" and rng.random() < 0.9:
        victims.wait_until_it_runs(process, out, before)
    end = time.monotonic() + rng.uniform(0., duration)
    while time.monotonic() < end and process.poll() is None:
        time.sleep(0.005)
    # A signal that mpirun receives before it has started the ranks does not concern latcon.
    if process.poll() is None and on == 1 and rng.random() < 0.1:
        process.terminate()
        _, said = process.communicate(timeout=120)
        # It may end before it checks for signals; before the handlers are installed a signal simply ends it.
        if process.returncode not in (130, -15, *victims.DONE):
            raise Failure(f"exit {process.returncode} when asked to stop: {said}")
    elif process.poll() is None:
        victims.kill(process)
        return "killed"
    else:
        _, said = process.communicate()
        if process.returncode not in victims.DONE:
            raise Failure(f"exit {process.returncode}: {said}")
    return "done" if process.returncode in victims.DONE else "asked to stop"


def compare(name, out, expected):
    different = victims.differences(victims.contents(out), expected)
    if different:
        raise Failure(f"{name}: not what the undisturbed run wrote: {', '.join(different)}")
