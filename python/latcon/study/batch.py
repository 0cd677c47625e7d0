"""``latcon batch``: a study as a job array of Slurm."""
from __future__ import annotations

import os
import re
import shlex
import subprocess
from collections.abc import Mapping, Sequence
from typing import Any

from ..errors import DONE
from ..folder import FolderLock, write_file
from .output import plan_table
from .plan import plan_runs, read_requested_study, require_folder_of, require_no_refinement, verification_of
from .program import InputError, Program, printable
from .record import Printed

_MAX_DEFAULT_TASKS = 1000  # MaxArraySize of Slurm is 1001 unless configured

_DIRECTIVES = """\
#!/bin/bash
#SBATCH --job-name={name}
#SBATCH --ntasks=1
#SBATCH --time={time}
#SBATCH --output={log}
#SBATCH --open-mode=append
{partition}"""

_ARRAY = """\
#SBATCH --array=1-{n_tasks}
#SBATCH --cpus-per-task={cpus_per_task}
#SBATCH --requeue
#SBATCH --signal=B:USR1@120

# Two minutes before the time limit the runs write checkpoints, and the task is requeued to continue from them.
requeue=no
trap 'requeue=yes; kill -TERM "$runs"' USR1
trap 'kill -TERM "$runs"' TERM
{command} --shard "$SLURM_ARRAY_TASK_ID/{n_tasks}" --threads {cpus_per_task} --quiet &
runs=$!
# A signal ends `wait` before the program ends.
wait "$runs"
while kill -0 "$runs" 2>/dev/null; do
  wait "$runs"
done
wait "$runs"
code=$?
if [ "$requeue" = yes ] && [ "$code" -eq 130 ]; then
  scontrol requeue "${{SLURM_ARRAY_JOB_ID}}_$SLURM_ARRAY_TASK_ID"
fi
exit "$code"
"""


def write_batch(program: Program, printed: Printed, options: Mapping[str, Any]) -> int:
    """Writes the scripts of a study, and submits them if wanted. Returns the exit code."""
    time, partition = options["time"], options["partition"]
    if not re.fullmatch(r"([0-9]+-)?[0-9]+(:[0-9]{2}){0,2}", time):
        raise InputError(f"--time '{printable(time)}': expected [days-]hours:minutes:seconds, for example 1-00:00:00")
    if _seconds_of(time) < 300:
        raise InputError(f"--time '{time}': a run writes its checkpoint two minutes before the limit; give at least 5 minutes")
    if not re.fullmatch(r"[A-Za-z0-9_.,-]*", partition):
        raise InputError(f"--partition '{printable(partition)}': expected a name")
    requested = read_requested_study(program, options)
    require_no_refinement(requested.study)
    plan = plan_runs(program, requested.study, verification_of(options))
    n_tasks = min(len(plan), options["tasks"] or _MAX_DEFAULT_TASKS)
    if options["dry_run"]:
        printed.say(plan_table(requested.study, plan, n_tasks * options["cpus_per_task"]))
        return DONE
    directory = options["output_dir"]
    folder = os.path.join(os.path.abspath(directory), "batch")
    if not re.fullmatch(r"[^\s%\\'\"]+", folder):
        raise InputError(f"--output-dir '{printable(folder)}': sbatch does not support folders with blanks, quotes, % or \\ "
                         "for its log files")
    require_folder_of(requested.study, directory)
    # The same choices, from any folder.
    study = requested.file if requested.kept else options["study"]
    words = [options["program"], "study", os.path.abspath(study) if requested.kept or os.path.isfile(study) else study]
    if not requested.kept:  # the study file of a sweep has them
        words += [word for text in options["overrides"] for word in ("--set", text)]
    words += [f"--{name.replace('_', '-')}" for name in ("quick", "skip_verification", "no_report", "yes") if options[name]]
    command = shlex.join([*words, "--output-dir", os.path.abspath(directory)])
    runs, collect = os.path.join(folder, "runs.sh"), os.path.join(folder, "collect.sh")
    os.makedirs(directory, exist_ok=True)
    with FolderLock(directory):
        os.makedirs(folder, exist_ok=True)
        requested.write_sweep()
        write_file(runs, _directives(options, "latcon-runs", f"{folder}/runs-%a.log") + _ARRAY.format(
            n_tasks=n_tasks, cpus_per_task=options["cpus_per_task"], command=command))
        write_file(collect, _directives(options, "latcon-collect", f"{folder}/collect.log") + f"\nexec {command} --collect\n")
    counts = f"{len(plan)} runs in {n_tasks} tasks"
    if not options["submit"]:
        printed.say(f"{counts}. To submit them:\n  runs=$(sbatch --parsable {shlex.quote(runs)})\n"
                    f"  sbatch --dependency=afterany:$runs {shlex.quote(collect)}")
        return DONE
    array = _submit([runs])
    printed.say(f"{counts}: job {array}")
    printed.say(f"then the verdict: job {_submit([f'--dependency=afterany:{array}', collect])}")
    return DONE


def _directives(options: Mapping[str, Any], name: str, log: str) -> str:
    partition = f"#SBATCH --partition={options['partition']}\n" if options["partition"] else ""
    return _DIRECTIVES.format(name=name, time=options["time"], log=log, partition=partition)


def _submit(arguments: Sequence[str]) -> str:
    """Submits a script and returns the number of the job."""
    try:
        ended = subprocess.run(["sbatch", "--parsable", *arguments], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, text=True, errors="replace", check=False)
    except OSError:
        raise InputError("--submit: there is no sbatch on this machine; copy the scripts to one with Slurm, or submit them "
                         "there") from None
    printed = ended.stdout.strip()
    if ended.returncode != 0:
        raise InputError(f"--submit: sbatch ended with {ended.returncode}: {printable(printed, 300)}")
    return printed.rpartition("\n")[2]  # warnings come first


def _seconds_of(limit: str) -> float:
    """Returns a time limit of Slurm: minutes[:seconds], hours:minutes:seconds, days-hours[:minutes[:seconds]]."""
    days, dash, rest = limit.rpartition("-")
    parts = [float(part) for part in rest.split(":")]
    if not dash and len(parts) < 3:
        parts.insert(0, 0.0)
    hours, minutes, seconds = (parts + [0.0, 0.0])[:3]
    return (24 * float(days or 0) + hours) * 3600 + minutes * 60 + seconds
