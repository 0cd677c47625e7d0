"""``latcon study`` and ``latcon batch``, with the options that the program has parsed."""
from __future__ import annotations

import os
import shutil
import sys
import time
import traceback
from collections.abc import Mapping, Sequence
from typing import Any

from .batch import write_batch
from .outcome import RunOutcome, RunState, is_begun, is_finished, read_outcome
from .output import StudyResults, plan_table, result_table, study_csv, study_json
from .plan import PlannedRun, Verification, base_changes, plan_runs
from .pool import run_processes
from .refinement import refined_runs
from .requested import RequestedStudy, read_requested_study, require_folder_of, require_no_refinement, verification_of
from .service import (BAD_INPUT, CLAIM_FAILED, DONE, INTERNAL_ERROR, INTERRUPTED, OUTPUT_FAILED, SOLVER_FAILED, InputError,
                      Interrupted, Service, ServiceEnded, Signals)
from .shard import PLAN_FILE, parse_shard, plan_difference, plan_text, runs_of_shard
from .table import judge_study

# The runs of a killed study get SIGTERM, and write a checkpoint before they end [ms].
_PATIENCE_WITH_ORPHANS = 10000
# Each shard holds the lock of the study for the time that writing its plan takes [ms].
_PATIENCE_WITH_SHARDS = 60000


def run(command: str, options: Mapping[str, Any]) -> int:
    """Runs a command and returns its exit code; run.json, log and messages agree with it."""
    signals = Signals()
    service = None
    try:
        service = Service(options)
        code = _StudyCommand(service, signals, options).run() if command == "study" else write_batch(service, options)
        signals.deferred = True
        service.finish(code)
    except ServiceEnded:
        signals.deferred = True
    except Interrupted as error:
        if service is None:
            return INTERRUPTED
        service.process.send_signal(error.number)
    except Exception as error:  # pylint: disable=broad-except
        signals.deferred = True
        if service is None:
            print(f"latcon: cannot start: {error}", file=sys.stderr)
            return INTERNAL_ERROR
        if isinstance(error, InputError):
            service.finish(BAD_INPUT, str(error))
        elif isinstance(error, OSError):
            service.finish(OUTPUT_FAILED, f"cannot write {error.filename or 'to the output directory'}: {error.strerror}")
        else:
            traceback.print_exc()
            service.finish(INTERNAL_ERROR, f"internal error: {error}")
    return INTERNAL_ERROR if service is None else service.wait()


class _StudyCommand:
    def __init__(self, service: Service, signals: Signals, options: Mapping[str, Any]) -> None:
        self.service, self.signals, self.options = service, signals, options
        self.directory: str = options["output_dir"]
        self.n_cores: int = options["threads"] or service.cores
        self.is_verbose = not options["quiet"]
        self.resume: bool = options["resume"]

    def run(self) -> int:
        """Plans, runs and judges the study; returns the exit code."""
        service, options = self.service, self.options
        if options["collect"] and options["shard"]:
            raise InputError("--collect judges the runs of all shards; give it without --shard")
        index, count = parse_shard(service, options["shard"]) if options["shard"] else (1, 1)
        self.requested = requested = read_requested_study(service, options)
        if options["collect"] or options["shard"]:
            require_no_refinement(requested.study)
        self.verification = verification_of(options)
        self.results = results = StudyResults(requested.study, [], options["quick"], self.verification)
        self.add_runs(plan_runs(service, requested.study, requested.overrides, self.verification))
        plan = results.plan
        if options["dry_run"] and self.is_verbose:
            service.print(plan_table(requested.study, plan, self.n_cores))
        needs = sorted((one.memory for one in plan), reverse=True)[:self.n_cores]
        service.ask("memory", needs=needs, prints=options["dry_run"] and self.is_verbose)
        if options["dry_run"]:
            return DONE

        require_folder_of(service, requested.study, self.directory)
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
        service.ask("open", output_dir=own_directory, resume=self.resume)
        if not options["shard"]:
            requested.write_sweep(service)
        service.ask("record", key="skip_verification", value=options["skip_verification"])
        service.ask("record", key="study", value=requested.study.title)
        if self.verification is Verification.BASE_CASE and not options["collect"]:
            service.ask("verify", changes=base_changes(requested.study, requested.overrides),
                        on_continuum=any(one.on_continuum for one in requested.study.runs))
        self.signals.deferred = True  # from here on a signal ends the runs, and the results are written
        complete = self.signals.pending is None and (options["collect"] or self.run_children(selected) and self.refine())
        if complete:
            self.signals.resume()
        if options["shard"]:
            return service.ask("end", rows=[], exit_code=self.exit_code() if complete else INTERRUPTED)
        return self.judge(complete)

    def add_runs(self, plan: Sequence[PlannedRun]) -> list[int]:
        """Adds planned runs to the results, and returns their indices."""
        results = self.results
        begin = len(results.plan)
        results.plan += plan
        results.outcomes += [RunOutcome(one.run, one.seed) for one in plan]
        return list(range(begin, len(results.plan)))

    def say(self, text: str) -> None:
        if self.is_verbose:
            self.service.print(text + "\n")

    def folder(self, planned: PlannedRun) -> str:
        """Output directory of a run once it has ended; until then it has the ending `.part`."""
        return f"{self.directory}/runs/{planned.folder}"

    def run_children(self, selected: Sequence[int]) -> bool:
        """Runs the selected runs that are not measured yet. Returns whether all of them ended."""
        begin = time.monotonic()
        service, plan, outcomes = self.service, self.results.plan, self.results.outcomes
        skip = self.verification is not Verification.EVERY_RUN  # of the runs
        jobs = []
        for i in selected:
            folder = self.folder(plan[i])
            if self.resume and is_finished(service, plan[i], folder, skip):
                outcomes[i] = read_outcome(service, plan[i], folder)
            else:
                jobs.append(i)
        self.say(f"{len(jobs)} runs, {len(selected) - len(jobs)} are finished already")
        for folder in ("cases", "runs"):
            os.makedirs(f"{self.directory}/{folder}", exist_ok=True)
        cases = [plan[i].request() | {"file": f"{self.directory}/cases/{plan[i].folder}.prm"} for i in selected]
        for _ in service.ask_in_parts("write cases", cases):
            pass
        total = sum(plan[i].seconds for i in jobs)
        done, n_ended, shown = 0.0, 0, 0.0

        def start(job: int) -> tuple[list[str], str]:
            planned = plan[jobs[job]]
            whole = self.folder(planned)
            part = whole + ".part"
            service.ask("in place", file=part)
            # A run that failed, as on a full disk, may have checkpoints.
            if self.resume and not os.path.exists(part) and is_begun(service, planned, whole, skip):
                os.rename(whole, part)
            if os.path.exists(part):  # released at once: the run locks it for itself
                service.ask("lock", directory=part, milliseconds=_PATIENCE_WITH_ORPHANS)
                service.ask("unlock")
            continues = self.resume and is_begun(service, planned, part, skip)
            if not continues:
                _remove(part)
            os.makedirs(part, exist_ok=True)
            # The program of the service, even if its file has been replaced since it was started.
            command = [f"/proc/{service.process.pid}/exe", "fracture", f"{self.directory}/cases/{planned.folder}.prm", "--side",
                       planned.side, "--output-dir", part, "--threads", "1", "--no-report"]
            command += ["--skip-verification"] * skip + ["--resume"] * continues + ["--yes"] * self.options["yes"]
            return command, part + "/log.txt"

        def ended(job: int, status: int) -> None:
            nonlocal done, n_ended
            planned = plan[jobs[job]]
            whole = self.folder(planned)
            service.ask("in place", file=whole)
            _remove(whole)
            os.rename(whole + ".part", whole)
            outcome = outcomes[jobs[job]] = read_outcome(service, planned, whole, status)
            n_ended += 1
            done += planned.seconds
            result = outcome.pattern if outcome.state is RunState.MEASURED else f"{outcome.state.value}: {outcome.problem}"
            self.say(f"[{n_ended}/{len(jobs)}] {planned.folder}: {result}, {round(outcome.wall_time)} s")

        def waiting(running: Sequence[int]) -> None:
            nonlocal shown
            now = time.monotonic()
            if self.is_verbose and now - shown > 0.2:
                shown = now
                names = ", ".join(plan[jobs[job]].folder for job in running)
                service.ask("progress", text=f"{n_ended}/{len(jobs)} runs, now {names}, {round(now - begin)} s so far",
                            done=done / total if total else 0.0)

        complete = run_processes(len(jobs), self.n_cores, start, ended, waiting, lambda: self.signals.pending is not None)
        service.ask("progress")
        service.ask("record", key="runs", value=time.monotonic() - begin, seconds=True)
        return complete

    def refine(self) -> bool:
        """Runs the points between neighbours of the sweep that differ, level by level. Returns whether all runs ended."""
        study, results = self.results.study, self.results
        for level in range(1, study.refine + 1):
            added = refined_runs(study, results.plan, results.outcomes, level)
            everything, claims = study.runs, study.claims
            study.runs, study.claims = added, []
            plan = plan_runs(self.service, study, self.requested.overrides, self.verification)
            study.runs, study.claims = everything + added, claims
            self.say(f"refinement {level}: {len(added)} cases between neighbours that differ")
            if not self.run_children(self.add_runs(plan)):
                return False
        return True

    def exit_code(self) -> int:
        states = {outcome.state for outcome in self.results.outcomes}
        if RunState.FAILED in states:
            return SOLVER_FAILED
        return CLAIM_FAILED if states & {RunState.REFUSED, RunState.REJECTED} else DONE

    def judge(self, complete: bool) -> int:
        """Judges the runs, writes the tables and the page; returns the exit code."""
        service, results = self.service, self.results
        results.claims = judge_study(results.study, results.plan, results.outcomes)
        service.ask("write", file=self.directory + "/study.json", text=study_json(service, results))
        service.ask("write", file=self.directory + "/study.csv", text=study_csv(service, results))
        rows = [row.result(claim.claim.claim) for claim in results.claims for row in claim.rows]
        if self.is_verbose:
            service.print(result_table(service, results))
        code = service.ask("end", rows=[row for row in rows if row is not None],
                           exit_code=self.exit_code() if complete else INTERRUPTED)
        # A page of an earlier run may remain.
        if complete and not self.options["no_report"] and service.ask("page", directory=self.directory):
            self.say(f"{self.directory}/study.html")
        return code

    def share_plan(self, text: str) -> None:
        """Records the plan of a study that runs in shards, and its sweep, unless they are recorded."""
        os.makedirs(self.directory, exist_ok=True)
        # Shards start at the same moment, and each removes unfinished files once it has the lock.
        self.service.ask("lock", directory=self.directory, milliseconds=_PATIENCE_WITH_SHARDS)
        file = os.path.join(self.directory, PLAN_FILE)
        if not os.path.exists(file):
            self.service.ask("write", file=file, text=text)
        self.require_plan(text)
        self.requested.write_sweep(self.service)
        self.service.ask("unlock")

    def require_plan(self, text: str) -> None:
        """Checks that a plan is the recorded one of the study whose shards run in the directory."""
        file = os.path.join(self.directory, PLAN_FILE)
        try:
            with open(file, encoding="utf-8", errors="replace") as stream:
                stored = stream.read()
        except OSError:
            raise InputError(f"{file} cannot be read: no shard of this study was run in {self.directory}") from None
        if difference := plan_difference(self.service, stored, text):
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
            if unrecorded or is_begun(self.service, planned, folder, skip):
                self.results.outcomes[i] = read_outcome(self.service, planned, folder)
            else:
                missing.append(planned.folder)
        if missing:
            named = ", ".join(missing[:8]) + (", ..." if len(missing) > 8 else "")
            raise InputError(f"--collect: {len(missing)} of {len(self.results.plan)} runs have not been run to their end by this "
                             f"program: {named}; run their shards again")


def _remove(folder: str) -> None:
    if os.path.islink(folder) or os.path.isfile(folder):
        os.remove(folder)
    elif os.path.exists(folder):
        shutil.rmtree(folder)
