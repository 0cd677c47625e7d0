"""The commands of the program that are Python, with the options that the program has parsed."""
from __future__ import annotations

import dataclasses
import os
import signal
import time
import traceback
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..compare import compare
from ..errors import BAD_INPUT, CLAIM_FAILED, DONE, INTERNAL_ERROR, INTERRUPTED, OUTPUT_FAILED, SOLVER_FAILED, LatconError
from ..folder import FolderLock, is_listed, prepare_run, remove, require_in_place, write_atomically, write_file
from .batch import write_batch
from .explain import explain, init
from .outcome import RunOutcome, RunState, is_begun, read_outcome
from .output import StudyResults, plan_table, result_table, study_csv, study_json
from .plan import (PLAN_FILE, PlannedRun, Verification, base_text, default_folder, parse_shard, plan_difference, plan_runs, plan_text,
                   read_requested_study, require_folder_of, require_no_refinement, runs_of_shard, verification_of)
from .pool import run_processes
from .program import Ended, InputError, Interrupted, Program, Signals, read_input
from .record import Printed, Progress, Record, draw_page, output_is_lost, report, say_error
from .study_file import Study, StudyRun
from .sweep import MAX_NAME_LENGTH, combination_name, plain_number
from .table import judge_study

# Each shard holds the lock of the study for the time that writing its plan takes [s].
_PATIENCE_WITH_SHARDS = 60.0
_COMMANDS = {"batch": write_batch, "compare": compare, "entries": explain, "help": explain, "init": init, "report": report}


def run(command: str, options: Mapping[str, Any]) -> int:
    """Runs a command and returns its exit code; run.json, log and messages agree with it."""
    printed = Printed(options["quiet"])
    program = None
    signals = Signals()
    try:
        signals.unblock()
        if options["overrides"] and command not in ("study", "batch"):
            raise InputError(f"latcon {command} has no case that --set could change")
        program = Program(options)
        if command in ("study", "batch"):
            options = {**options, "output_dir": options["output_dir"] or default_folder(options["study"], bool(options["sweeps"]))}
        if command == "study":
            code = _StudyCommand(program, printed, signals, options).run()
        else:
            code = _COMMANDS[command](program, printed, options)
        message = ""
        if code == DONE and output_is_lost(printed):
            code, message = OUTPUT_FAILED, "cannot write standard output: it is closed or full"
        signals.deferred = True
    except BaseException as error:  # pylint: disable=broad-except
        signals.deferred = True
        code, message = _failure(error)
    if message and not message.startswith("latcon: "):
        message = f"latcon: {message}\n"
        say_error(message)
    try:
        if printed.record:
            printed.record.write(code, message)
            printed.record.release()
    except OSError:
        pass  # most likely a full disk, which is then the failure itself
    if program:
        program.close()
    return code


def _failure(error: BaseException) -> tuple[int, str]:
    """Returns exit code and message; a message that has been printed begins with the name of the program."""
    if isinstance(error, Ended):
        return error.exit_code, error.message
    if isinstance(error, Interrupted):
        return INTERRUPTED, f"interrupted by {signal.Signals(error.args[0]).name}"
    if isinstance(error, LatconError):
        return BAD_INPUT, str(error)
    if isinstance(error, OSError):
        return OUTPUT_FAILED, f"cannot write {error.filename or 'to the output directory'}: {error.strerror}"
    traceback.print_exc()
    return INTERNAL_ERROR, f"internal error: {error}"


class _StudyCommand:
    def __init__(self, program: Program, printed: Printed, signals: Signals, options: Mapping[str, Any]) -> None:
        self.program, self.printed, self.signals, self.options = program, printed, signals, options
        self.record: Record | None = None
        self.directory: str = options["output_dir"]
        self.n_cores: int = options["threads"] or program.cores
        self.resume: bool = options["resume"]

    def run(self) -> int:
        """Plans, runs and judges the study; returns the exit code."""
        program, options = self.program, self.options
        if options["collect"] and options["shard"]:
            raise InputError("--collect judges the runs of all shards; give it without --shard")
        index, count = parse_shard(options["shard"]) if options["shard"] else (1, 1)
        self.requested = requested = read_requested_study(program, options)
        if options["collect"] or options["shard"]:
            require_no_refinement(requested.study)
        self.verification = verification_of(options)
        self.results = results = StudyResults(requested.study, [], options["quick"], self.verification)
        self.add_runs(plan_runs(program, requested.study, self.verification))
        plan = results.plan
        if options["dry_run"]:
            self.printed.say(plan_table(requested.study, plan, self.n_cores))
        needs = sorted((one.memory for one in plan), reverse=True)[:self.n_cores]
        memory = program.ask(memory=needs)
        if options["dry_run"]:
            self.printed.say(memory["text"].rstrip())
            return DONE

        require_folder_of(requested.study, self.directory)
        text = plan_text(requested.study.title, plan, options["skip_verification"], 0 if options["collect"] else count)
        selected = runs_of_shard(plan, index, count)
        own_directory = self.directory
        if options["shard"]:
            self.share_plan(text)
            own_directory += f"/shards/{index}-of-{count}"  # a shard has a record and a lock of its own
            self.resume = True
        elif options["collect"]:
            self.require_plan(text)
            self.collect()
            self.resume = True
            selected = []
        elif os.path.exists(os.path.join(self.directory, PLAN_FILE)):
            raise InputError(f"{self.directory} has the runs of a study in shards; give --collect, or another folder (--output-dir)")
        record = self.record = Record(program, self.printed, own_directory, options, self.resume,
                                      skip_verification=options["skip_verification"], study=requested.study.title)
        if not options["shard"]:
            requested.write_sweep()
        if self.verification is Verification.BASE_CASE and not options["collect"]:
            record.verify(program, base_text(program, requested.study),
                          any(one.on_continuum for one in requested.study.runs))
        self.signals.deferred = True  # from here on a signal ends the runs, and the results are written
        complete = self.signals.pending is None and (options["collect"] or self.run_children(selected) and self.refine())
        if options["shard"]:
            return record.end([], self.exit_code() if complete else INTERRUPTED)
        return self.judge(record, complete)

    def add_runs(self, plan: Sequence[PlannedRun]) -> list[int]:
        """Adds planned runs to the results, and returns their indices."""
        results = self.results
        begin = len(results.plan)
        results.plan += plan
        results.outcomes += [RunOutcome(one.run, one.seed) for one in plan]
        return list(range(begin, len(results.plan)))

    def case(self, planned: PlannedRun) -> str:
        """File with the resolved case of a run."""
        return f"{self.directory}/cases/{planned.folder}.prm"

    def folder(self, planned: PlannedRun) -> str:
        """Output directory of a run once it has ended; until then it has the ending `.part`."""
        return f"{self.directory}/runs/{planned.folder}"

    def run_children(self, selected: Sequence[int]) -> bool:
        """Runs the selected runs that are not measured yet. Returns whether all of them ended."""
        begin = time.monotonic()
        program, plan, outcomes = self.program, self.results.plan, self.results.outcomes
        skip = self.verification is not Verification.EVERY_RUN  # of the runs
        jobs = []
        for place in ("cases", "runs"):
            os.makedirs(f"{self.directory}/{place}", exist_ok=True)
        for i in selected:
            folder = self.folder(plan[i])
            write_file(self.case(plan[i]), plan[i].text(program))
            is_usable = self.resume and is_begun(program, plan[i], folder, self.case(plan[i]), skip)
            found = read_outcome(program, plan[i], folder) if is_usable else outcomes[i]
            if found.state in (RunState.MEASURED, RunState.REJECTED):  # another run would end alike
                outcomes[i] = found
            else:
                jobs.append(i)
        self.printed.say(f"{len(jobs)} runs, {len(selected) - len(jobs)} are finished already")
        total = sum(plan[i].seconds for i in jobs)
        done, n_ended, progress = 0.0, 0, Progress(not self.options["quiet"])

        def start(job: int) -> tuple[list[str], str]:
            planned = plan[jobs[job]]
            whole = self.folder(planned)
            part = whole + ".part"
            require_in_place(part)
            # A run that failed, as on a full disk, may have checkpoints.
            if self.resume and not os.path.exists(part) and is_begun(program, planned, whole, self.case(planned), skip):
                os.rename(whole, part)
            continues = prepare_run(part, lambda: self.resume and is_begun(program, planned, part, self.case(planned), skip))
            command = [program.executable, "fracture", self.case(planned), "--side", planned.side, "--output-dir", part,
                       "--threads", "1", "--no-report"]
            command += ["--skip-verification"] * skip + ["--resume"] * continues + ["--yes"] * self.options["yes"]
            return command, part + "/log.txt"

        def ended(job: int, status: int) -> None:
            nonlocal done, n_ended
            planned = plan[jobs[job]]
            whole = self.folder(planned)
            require_in_place(whole)
            remove(whole)
            os.rename(whole + ".part", whole)
            outcome = outcomes[jobs[job]] = read_outcome(program, planned, whole, status)
            n_ended += 1
            done += planned.seconds
            result = outcome.pattern if outcome.state is RunState.MEASURED else f"{outcome.state.value}: {outcome.problem}"
            self.printed.say(f"[{n_ended}/{len(jobs)}] {planned.folder}: {result}, {round(outcome.wall_time)} s")

        def waiting(running: Sequence[int]) -> None:
            if progress.is_due():
                names = ", ".join(plan[jobs[job]].folder for job in running)
                progress.show(f"{n_ended}/{len(jobs)} runs, now {names}, {round(time.monotonic() - begin)} s so far",
                              done / total if total else 0.0)

        complete = run_processes(len(jobs), self.n_cores, start, ended, waiting, lambda: self.signals.pending is not None)
        progress.clear()
        assert self.record
        self.record.add_time("runs", time.monotonic() - begin)
        return complete

    def refine(self) -> bool:
        """Runs the points between neighbours of the sweep that differ, level by level. Returns whether all runs ended."""
        study, results = self.results.study, self.results
        for level in range(1, study.refine + 1):
            added = refined_runs(study, results.plan, results.outcomes, level)
            study.runs += added
            plan = plan_runs(self.program, study, self.verification, added)
            self.printed.say(f"refinement {level}: {len(added)} cases between neighbours that differ")
            if not self.run_children(self.add_runs(plan)):
                return False
        return True

    def exit_code(self) -> int:
        states = {outcome.state for outcome in self.results.outcomes}
        if RunState.FAILED in states:
            return SOLVER_FAILED
        return CLAIM_FAILED if states & {RunState.REFUSED, RunState.REJECTED} else DONE

    def judge(self, record: Record, complete: bool) -> int:
        """Judges the runs, writes the tables and the page; returns the exit code."""
        program, results = self.program, self.results
        results.claims = judge_study(results.study, results.plan, results.outcomes)
        if is_listed(self.directory, "study.html"):  # of earlier tables
            remove(self.directory + "/study.html")
        write_file(self.directory + "/study.json", study_json(program, results))
        write_file(self.directory + "/study.csv", study_csv(program, results))
        rows = [row.result(claim.claim.claim) for claim in results.claims for row in claim.rows]
        self.printed.say(result_table(program, results))
        code = record.end([row for row in rows if row is not None], self.exit_code() if complete else INTERRUPTED)
        if complete:  # a page takes a while
            self.signals.resume()
        if complete and not self.options["no_report"] and draw_page(
                "study", self.directory, "study.html", "repeat the command with --resume, or with --collect after shards,"):
            self.printed.say(f"{self.directory}/study.html")
        return code

    def share_plan(self, text: str) -> None:
        """Records the plan of a study that runs in shards, and its sweep, unless they are recorded."""
        os.makedirs(self.directory, exist_ok=True)
        # Shards start at the same moment, and each removes unfinished files once it has the lock.
        with FolderLock(self.directory, _PATIENCE_WITH_SHARDS):
            file = os.path.join(self.directory, PLAN_FILE)
            if not os.path.exists(file):
                write_atomically(file, text)  # not listed: it stays where files of another command are moved aside
            self.require_plan(text)
            self.requested.write_sweep()

    def require_plan(self, text: str) -> None:
        """Checks that a plan is the recorded one of the study whose shards run in the directory."""
        file = os.path.join(self.directory, PLAN_FILE)
        stored, problem = read_input(file)
        if problem:
            raise InputError(f"{file} cannot be read: no shard of this study was run in {self.directory}")
        if difference := plan_difference(stored.decode("utf-8", "replace"), text):
            raise InputError(f"{self.directory} belongs to the runs of another plan: {difference}; choose another folder "
                             "(--output-dir)")

    def collect(self) -> None:
        """Reads the outcomes of all runs. They must have ended."""
        skip = self.verification is not Verification.EVERY_RUN
        missing = []
        for i, planned in enumerate(self.results.plan):
            folder = self.folder(planned)
            # A run that ended before it wrote its record has failed.
            unrecorded = os.path.exists(folder) and not os.path.exists(f"{folder}/run.json")
            if unrecorded or is_begun(self.program, planned, folder, self.case(planned), skip):
                self.results.outcomes[i] = read_outcome(self.program, planned, folder)
            else:
                missing.append(planned.folder)
        if missing:
            named = ", ".join(missing[:8]) + (", ..." if len(missing) > 8 else "")
            raise InputError(f"--collect: {len(missing)} of {len(self.results.plan)} runs have not been run to their end by this "
                             f"program: {named}; run their shards again")


def refined_runs(study: Study, plan: Sequence[PlannedRun], outcomes: Sequence[RunOutcome], level: int) -> list[StudyRun]:
    """Returns the runs half way between neighbours of a swept grid with different patterns.

    They bracket the boundary between two patterns at half the distance. Neighbours are points at the spacing of this level,
    from 1, along one swept entry, with the same values of the others: the spacing of the grid for level 1, half of it for level
    2, and so on; values between those of the grid are interpolated. Two points differ unless all seeds of both have the same
    pattern, where ``undecided`` is a pattern. A point without a measured seed differs from none. The values of the sweep are
    numbers; the study has the runs of the earlier levels, with a seed each in `plan`, and `outcomes` in the same order.
    """
    swept = {run.name: run for run in study.runs if run.is_swept}
    planned = {run.run: run for run in plan if run.run in swept}
    def value(run: PlannedRun, entry: str) -> float:
        number = run.value(entry)
        assert number is not None, f"{entry} is not a number"
        return number

    axes = [sorted({value(run, entry) for run in planned.values() if swept[run.run].level == 0}) for entry in study.swept]
    per_interval = 2**level  # points of this level are at odd indices
    # The closest indices of this level, since values are written with twelve digits.
    points = {tuple(round(per_interval * float(np.interp(value(run, entry), axis, range(len(axis)))))
                    for entry, axis in zip(study.swept, axes)): name for name, run in planned.items()}
    patterns: dict[str, set[str]] = {}
    for outcome in outcomes:
        if outcome.state is RunState.MEASURED:
            patterns.setdefault(outcome.run, set()).add(outcome.pattern)
    found: dict[tuple[int, ...], StudyRun] = {}
    for at, name in sorted(points.items()):
        for i in range(len(axes)):
            middle, following = (at[:i] + (at[i] + shift,) + at[i + 1:] for shift in (1, 2))
            if following not in points or middle in points:
                continue
            seen = patterns.get(name, set()), patterns.get(points[following], set())
            if not all(seen) or seen[0] == seen[1] and len(seen[0]) == 1 or middle in found:
                continue
            values = [plain_number(float(np.interp(index / per_interval, range(len(axis)), axis)))
                      for axis, index in zip(axes, middle)]
            own = dict(zip(study.swept, values))
            run = swept[name]
            found[middle] = dataclasses.replace(run, name=combination_name(study.swept, values), level=level, own=run.own | own,
                                                all=run.all | own)
    names = {run.name for run in study.runs}
    refined = [run for _, run in sorted(found.items())]
    for number, run in enumerate(refined, 1):
        if len(run.name) > MAX_NAME_LENGTH or run.name in names:
            run.name = f"level-{level}-{number}"
    return refined
