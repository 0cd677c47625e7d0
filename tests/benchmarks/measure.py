"""Runs programs and measures their times."""
import json
import math
import os
import pathlib
import statistics
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Open MPI refuses root, and more ranks than cores, unless told otherwise.
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                   OMPI_MCA_rmaps_base_oversubscribe="1")


class Skipped(Exception):
    """Reason why a part cannot be measured on this machine."""


class Failed(Exception):
    """A program failed."""


def run(command, environment=None, folder=None):
    """Runs a program. @return its standard output; raises Failed with the end of its output if it fails"""
    command = list(map(str, command))
    try:
        done = subprocess.run(command, capture_output=True, text=True, cwd=folder, env=environment or ENVIRONMENT)
    except FileNotFoundError as error:
        raise Skipped(f"{command[0]} is not installed") from error
    if done.returncode != 0:
        raise Failed(f"{' '.join(command)} ended with {done.returncode}: {(done.stderr or done.stdout)[-2000:]}")
    return done.stdout


def run_json(command, **keywords):
    text = run(command, **keywords)
    try:
        return json.loads(text)
    except ValueError as error:
        raise Failed(f"{command[0]} printed no JSON but {text[:200]!r}") from error


def on_ranks(ranks, command):
    return ["mpirun", "--oversubscribe", "--bind-to", "none", "-n", ranks, *command]


def interleaved(variants, rounds):
    """Calls the variants (name -> function) alternately, so that other load on the machine affects all of them.
    @return name -> results of the rounds"""
    results = {name: [] for name in variants}
    for _ in range(rounds):
        for name, call in variants.items():
            results[name].append(call())
    return results


def best(seconds):
    """The shortest of several times, since other load only lengthens them; NaN if one is NaN or there is none."""
    return min(seconds) if seconds and not any(map(math.isnan, seconds)) else math.nan


def spread(seconds):
    """Median over minimum, minus one [-]: a measure of the disturbance by other load."""
    return statistics.median(seconds) / min(seconds) - 1.
