#!/usr/bin/python3
"""latcon study --shard and --collect, and latcon batch: files, exit codes, signals, and a job array of a real Slurm.

Usage: shards_test.py PATH_OF_LATCON [--full]     --full: also in a real Slurm, and with claims that are checked
"""
import copy
import functools
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

sys.dont_write_bytecode = True
from program import CASES, LATCON, TemporaryFolder, latcon
from slurm import Slurm, missing
from study_test import TINY

FULL = "--full" in sys.argv
RUNS = 4  # of TINY: base twice, low, thin


def result(folder):
    """Results of a study, as bytes."""
    return [(folder / name).read_bytes() for name in ("study.json", "study.csv", "results.csv")]


@functools.cache
def undisturbed():
    """Results of TINY without shards."""
    with tempfile.TemporaryDirectory() as folder:
        study, out = pathlib.Path(folder) / "tiny.json", pathlib.Path(folder) / "out"
        study.write_text(json.dumps(TINY))
        run = latcon("study", study, "--output-dir", out, "--skip-verification", "--no-report")
        assert run.returncode == 0, run.stdout + run.stderr
        return result(out)


class Shards(TemporaryFolder):
    def write_study(self, document=None):
        path = self.folder / "tiny.json"
        path.write_text(json.dumps(document or TINY))
        return path

    def words(self, *arguments, study=None, out=None, command="study"):
        return [command, str(study or self.write_study()), "--output-dir", str(out or self.out), "--skip-verification",
                *arguments]

    def study(self, *arguments, expect=0, **choices):
        run = latcon(*self.words(*arguments, **choices))
        self.assertEqual(run.returncode, expect, run.stdout + run.stderr)
        return run.stdout + run.stderr

    def files(self):
        return {path: path.read_bytes() for path in self.out.rglob("*") if path.is_file()}

    def test_shards_leave_what_the_whole_study_leaves(self):
        shards = [subprocess.Popen([LATCON, *self.words("--shard", f"{i}/3", "--threads", "1")], text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT) for i in (1, 2, 3)]
        for shard in shards:
            printed, _ = shard.communicate(timeout=600)
            self.assertEqual(shard.returncode, 0, printed)
        self.assertFalse((self.out / "study.json").exists())
        self.assertEqual(json.loads((self.out / "shards/2-of-3/run.json").read_text())["exit_code"], 0)
        self.study("--collect")
        self.assertEqual(result(self.out), undisturbed())
        self.assertTrue((self.out / "study.html").exists())

    @unittest.skipUnless(FULL, "in full only")
    def test_runs_side_by_side_verify_a_rubber_once(self):
        document = dict(TINY, runs={"base": {"seeds": [1, 2]}}, claims=[dict(TINY["claims"][0], rows=TINY["claims"][0]["rows"][:1])])
        study = str(self.write_study(document))
        shards = [subprocess.Popen([LATCON, "study", study, "--output-dir", self.out, "--shard", f"{i}/2", "--threads", "2"],
                                   text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT) for i in (1, 2)]
        for shard in shards:
            printed, _ = shard.communicate(timeout=600)
            self.assertEqual(shard.returncode, 0, printed)
        checks = [json.loads((self.out / "runs" / name / "run.json").read_text())["verification"]
                  for name in ("base-1", "base-2")]
        self.assertEqual(len({check["hash"] for check in checks}), 1)
        self.assertEqual(sum(not check["reused"] for check in checks), 1)
        self.assertFalse(list(pathlib.Path(os.environ["XDG_CACHE_HOME"]).rglob("*.checking")))

    def test_stopped_shard_continues(self):
        shard = subprocess.Popen([LATCON, *self.words("--shard", "1/1", "--threads", "1")], stdout=subprocess.DEVNULL)
        end = time.monotonic() + 300
        while not list((self.out / "runs").glob("*[0-9]")) and time.monotonic() < end:
            time.sleep(0.02)
        shard.send_signal(signal.SIGTERM)
        self.assertEqual(shard.wait(120), 130)
        measured = [path for path in (self.out / "runs").glob("*[0-9]")]
        self.assertIn(len(measured), range(1, RUNS))
        before = measured[0].stat().st_mtime_ns
        printed = self.study("--collect", expect=2)
        self.assertIn(f"{RUNS - len(measured)} of {RUNS} runs have not been run to their end", printed)
        self.assertFalse((self.out / "study.json").exists())
        self.study("--shard", "1/1")
        self.assertEqual(measured[0].stat().st_mtime_ns, before)
        self.study("--collect")
        self.assertEqual(result(self.out), undisturbed())

    def test_folder_of_another_plan_is_refused_untouched(self):
        self.study("--shard", "1/4", "--quiet")
        before = self.files()
        other = copy.deepcopy(TINY)
        other["title"] = "Another study"
        fewer = copy.deepcopy(TINY)
        del fewer["runs"]["thin"]
        edited = copy.deepcopy(TINY)
        edited["set"]["Sheet/length"] = "2.6 cm"
        self.assertIn("begun with 4 shards", self.study("--shard", "1/2", expect=2))
        self.assertIn("give --collect", self.study(expect=2))
        for document, reason in ((other, "another study, 'A tiny study'"), (fewer, "4 runs, now there are 3"),
                                 (edited, "the case of run base-1 differs")):
            for choice in (["--shard", "2/4"], ["--collect"]):
                printed = self.study(*choice, study=self.write_study(document), expect=2)
                self.assertIn(reason, printed)
                self.assertIn("--output-dir", printed)
        self.assertEqual(self.files(), before)

    def test_collect_without_shards_and_wrong_shards_are_bad_input(self):
        self.assertIn("no shard", self.study("--collect", expect=2))
        for text in ("0/2", "3/2", "1", "1/0", "a/b", "1/2/3", "-1/2", "1.5/2", "/", "1/1000000"):
            self.assertIn("I/N", self.study(f"--shard={text}", expect=2), text)
        self.assertIn("without --shard", self.study("--collect", "--shard", "1/2", expect=2))
        self.assertFalse(self.out.exists())

    def test_batch_writes_scripts_that_a_shell_understands(self):
        study = self.write_study()
        run = latcon(*self.words("--slurm", "--tasks", "2", "--cpus-per-task", "2", "--time", "0:30:00", "--set",
                                 "Sheet/length=2.4 cm", study=study, command="batch"))
        self.assertEqual(run.returncode, 0, run.stderr)
        for name in ("runs.sh", "collect.sh"):
            script = self.out / "batch" / name
            subprocess.run(["bash", "-n", script], check=True)
            self.assertIn("--set 'Sheet/length=2.4 cm'", script.read_text())
            self.assertIn(str(script), run.stdout)
        self.assertIn("#SBATCH --array=1-2\n", (self.out / "batch/runs.sh").read_text())

    def test_batch_refuses_what_would_break_a_script(self):
        for words, reason in ((["--time", "1h"], "--time"), (["--time", "0:01:00"], "5 minutes"), (["--time", "4:59"], "5 minutes"), (["--partition", "a b"], "--partition"),
                              (["--tasks", "0"], "--tasks")):
            run = latcon(*self.words("--slurm", *words, command="batch"))
            self.assertEqual(run.returncode, 2, words)
            self.assertIn(reason, run.stderr)
        run = latcon(*self.words("--slurm", command="batch", out=self.folder / "with blank"))
        self.assertEqual(run.returncode, 2)
        self.assertIn("--slurm", latcon(*self.words(command="batch")).stderr)

    def test_batch_without_slurm_says_so(self):
        empty = self.folder / "bin"
        empty.mkdir()
        run = latcon(*self.words("--slurm", "--submit", command="batch"), env={**os.environ, "PATH": str(empty)})
        self.assertEqual(run.returncode, 2)
        self.assertIn("no sbatch on this machine", run.stderr)
        self.assertTrue((self.out / "batch/runs.sh").exists())

    def test_task_that_nears_its_time_limit_is_requeued_and_continues(self):
        def longer(document):  # so that the signal arrives during a run
            document["set"].update({"Sheet/length": "4 cm", "Time/end": "3 ms"})
            document["runs"] = {"base": {}}
            document["claims"][0]["rows"] = [{"run": "base", "quantity": "pattern"}]
        document = copy.deepcopy(TINY)
        longer(document)
        study = self.write_study(document)
        self.study(study=study, out=self.folder / "undisturbed")
        run = latcon(*self.words("--slurm", study=study, command="batch"))
        self.assertEqual(run.returncode, 0, run.stderr)
        tools = self.folder / "bin"
        tools.mkdir()
        (tools / "scontrol").write_text(f'#!/bin/sh\necho "$@" >>{self.folder}/requeued\n')
        (tools / "scontrol").chmod(0o755)
        environment = {**os.environ, "PATH": f"{tools}:{os.environ['PATH']}", "SLURM_ARRAY_JOB_ID": "42",
                       "SLURM_ARRAY_TASK_ID": "1"}
        part = self.out / "runs" / "base-1.part"
        with subprocess.Popen(["bash", self.out / "batch/runs.sh"], env=environment) as task:
            end = time.monotonic() + 300
            while not (part / "lattice-0000.vtp").exists() and time.monotonic() < end:
                time.sleep(0.01)
            task.send_signal(signal.SIGUSR1)  # as Slurm does, to the script alone
            self.assertEqual(task.wait(120), 130)
        self.assertEqual((self.folder / "requeued").read_text(), "requeue 42_1\n")
        self.assertTrue(list((part / "checkpoints").iterdir()))
        subprocess.run(["bash", self.out / "batch/runs.sh"], env=environment, check=True, timeout=300)
        self.assertIn("resumed_from", json.loads((self.out / "runs/base-1/run.json").read_text()))
        self.assertEqual((self.folder / "requeued").read_text(), "requeue 42_1\n")  # once
        subprocess.run(["bash", self.out / "batch/collect.sh"], check=True, timeout=300)
        self.assertEqual(result(self.out), result(self.folder / "undisturbed"))

    @unittest.skipUnless(FULL, "in full only")
    @unittest.skipIf(missing() or os.geteuid() != 0, "needs Slurm and root, which slurmd requires")
    def test_array_cancelled_half_way_continues_in_slurm(self):
        with Slurm(self.folder / "slurm") as cluster:
            def submit():
                run = latcon(*self.words("--slurm", "--submit", "--tasks", "2", "--time", "10", command="batch"),
                             env=cluster.environment)
                self.assertEqual(run.returncode, 0, run.stdout + run.stderr)

            runs = self.out / "runs"
            submit()
            cluster.wait_for(lambda: list(runs.glob("*[0-9]")), "the first run", limit=300)
            cluster.run("scancel", "--user=root")
            cluster.wait_for(lambda: not cluster.jobs(), "the end of the cancelled jobs", limit=120)
            self.assertIn(len(list(runs.glob("*[0-9]"))), range(1, RUNS))
            self.assertFalse((self.out / "study.json").exists())
            submit()
            cluster.wait_for(lambda: not cluster.jobs(), "the end of the jobs", limit=600)
            self.assertEqual(result(self.out), undisturbed(), (self.out / "batch/collect.log").read_text())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
