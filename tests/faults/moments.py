"""Kills the program, or simulates a full disk, at each of the calls that change files."""
import functools
import pathlib
import shutil
import tempfile

import victims
import whole


class Failure(Exception):
    """Results were lost or differ."""


def compare(name, out, expected):
    different = victims.differences(victims.contents(out), expected)
    if different:
        raise Failure(f"{name}: not what the undisturbed run wrote: {', '.join(different)}")


@functools.lru_cache(maxsize=None)
def counted(name):
    """@return the contents of an uninterrupted run, the number of such calls, and the numbers of those that rename or delete"""
    arguments = victims.VICTIMS[name]
    with tempfile.TemporaryDirectory() as folder:
        log, out = pathlib.Path(folder, "calls"), pathlib.Path(folder, "out")
        status, said = victims.run_with_fault([*arguments, "--threads", "1"], out, {"LATCON_FAULT": "count", "LATCON_FAULT_LOG": str(log)})
        if status not in victims.DONE:
            raise Failure(f"exit {status} when counted: {said}")
        calls, *names = map(int, log.read_text().split())
        return victims.contents(out), calls, names


def at_moments(name, folder, fault, moments):
    """Injects a fault at some of the calls, selected by a function of their number and of those that rename or delete. @return statistics"""
    arguments = victims.VICTIMS[name]
    expected, calls, names = counted(name)
    told = {"calls": calls, "faults": 0, "files_read": 0}
    out = folder / fault
    for call in moments(calls, names):
        shutil.rmtree(out, ignore_errors=True)
        status, said = victims.run_with_fault([*arguments, "--threads", "1"], out, {"LATCON_FAULT": fault, "LATCON_FAULT_AT": str(call)})
        if fault == "full" and status in victims.DONE:
            compare(name, out, expected)  # no call after it needed space
            continue
        if status != {"kill": -9, "full": 5}[fault]:
            raise Failure(f"{name}: exit {status} with `{fault}` at call {call} of {calls}: {said}")
        if fault == "full" and str(out) not in said:
            raise Failure(f"{name}: the message names no file with `full` at call {call}: {said}")
        told["faults"] += 1
        told["files_read"] += whole.check(out) if out.exists() else 0
        status, said = victims.run_with_fault([*arguments, "--resume", "--threads", "1"], out)
        if status not in victims.DONE:
            raise Failure(f"{name}: exit {status} after `{fault}` at call {call} of {calls}: {said}")
        compare(name, out, expected)
    return told
