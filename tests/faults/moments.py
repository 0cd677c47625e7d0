"""Kills the program, or simulates a full disk, at each of the calls that change files."""
import functools
import shutil

import victims
import whole
from kills import Failure, compare


@functools.lru_cache(maxsize=None)
def counted(program, name, folder):
    """@return the contents of an uninterrupted run, and its number of such calls"""
    arguments = victims.VICTIMS[name]
    log = folder / "calls"
    out = folder / "counted"
    status, said = program.run([*arguments, "--threads", "1"], out, fault={"LATCON_FAULT": "count", "LATCON_FAULT_LOG": str(log)})
    if status not in victims.DONE:
        raise Failure(f"exit {status} when counted: {said}")
    contents = victims.contents(out)
    shutil.rmtree(out)
    return contents, int(log.read_text())


def at_moments(program, name, folder, fault, moments):
    """Injects a fault at some of the calls, selected by a function of their number. @return their number"""
    arguments = victims.VICTIMS[name]
    folder.mkdir(parents=True, exist_ok=True)
    expected, calls = counted(program, name, folder)
    out = folder / fault
    for call in moments(calls):
        shutil.rmtree(out, ignore_errors=True)
        status, said = program.run([*arguments, "--threads", "1"], out, fault={"LATCON_FAULT": fault, "LATCON_FAULT_AT": str(call)})
        if fault == "full" and status in victims.DONE:
            compare(name, out, expected)  # no call after it needed space
            continue
        if status != {"kill": -9, "full": 5}[fault]:
            raise Failure(f"{name}: exit {status} with `{fault}` at call {call} of {calls}: {said}")
        if fault == "full" and str(out) not in said:
            raise Failure(f"{name}: the message names no file with `full` at call {call}: {said}")
        whole.check(out)
        status, said = program.run([*arguments, "--resume", "--threads", "1"], out)
        if status not in victims.DONE:
            raise Failure(f"{name}: exit {status} after `{fault}` at call {call} of {calls}: {said}")
        compare(name, out, expected)
    return calls
