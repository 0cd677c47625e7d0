"""latcon study --shard and --collect, and latcon batch: files, exit codes, signals, and a job array of a real Slurm."""
import json
import os
import signal
import subprocess
import time

import pytest

from program import FULL, LATCON, latcon
from slurm import Slurm, missing
from studies import Studies, files_in, run, write_study

RUNS = 4  # of TINY: base twice, low, thin


def result(folder):
    """Results of a study, as bytes."""
    return [(folder / name).read_bytes() for name in ("study.json", "study.csv", "results.csv")]


class TestShards(Studies):
    def words(self, *arguments, study=None, out=None, command="study"):
        return [command, str(study or write_study(self.folder)), "--output-dir", str(out or self.out), "--skip-verification", *arguments]

    def study(self, *arguments, expect=0, **choices):
        return run(*self.words(*arguments, **choices), expect=expect)

    def test_shards_leave_what_the_whole_study_leaves(self, tiny_study):
        shards = [subprocess.Popen([LATCON, *self.words("--shard", f"{i}/3", "--threads", "1")], text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT) for i in (1, 2, 3)]
        for shard in shards:
            printed, _ = shard.communicate(timeout=600)
            assert shard.returncode == 0, printed
        assert not (self.out / "study.json").exists()
        assert json.loads((self.out / "shards/2-of-3/run.json").read_text())["exit_code"] == 0
        self.study("--collect", "--no-report")
        assert result(self.out) == result(tiny_study)

    def test_stopped_shard_continues(self, tiny_study):
        shard = subprocess.Popen([LATCON, *self.words("--shard", "1/1", "--threads", "1")], stdout=subprocess.DEVNULL)
        end = time.monotonic() + 300
        while not list((self.out / "runs").glob("*[0-9]")) and time.monotonic() < end:
            time.sleep(0.02)
        shard.send_signal(signal.SIGTERM)
        assert shard.wait(120) == 130
        measured = [path for path in (self.out / "runs").glob("*[0-9]")]
        assert len(measured) in range(1, RUNS)
        before = measured[0].stat().st_mtime_ns
        printed = self.study("--collect", expect=2)
        assert f"{RUNS - len(measured)} of {RUNS} runs have not been run to their end" in printed
        assert not (self.out / "study.json").exists()
        self.study("--shard", "1/1")
        assert measured[0].stat().st_mtime_ns == before
        self.study("--collect", "--no-report")
        assert result(self.out) == result(tiny_study)

    def test_folder_of_another_plan_is_refused_untouched(self):
        self.study("--shard", "1/4", "--quiet")
        before = files_in(self.out)
        assert "begun with 4 shards" in self.study("--shard", "1/2", expect=2)
        assert "give --collect" in self.study(expect=2)
        # Other differences: tests/python/test_study_files.py.
        other = write_study(self.folder, lambda document: document["set"].update({"Sheet/length": "2.6 cm"}))
        for words in (["--shard", "2/4"], ["--collect"]):
            printed = self.study(*words, study=other, expect=2)
            assert "the case of run base-1 differs" in printed and "--output-dir" in printed
        assert files_in(self.out) == before

    def test_collect_without_shards_and_wrong_shards_are_bad_input(self):
        assert "no shard" in self.study("--collect", expect=2)
        assert "without --shard" in self.study("--collect", "--shard", "1/2", expect=2)
        assert not self.out.exists()

    def test_batch_writes_scripts_that_a_shell_understands(self):
        study = write_study(self.folder)
        run = latcon(*self.words("--slurm", "--tasks", "2", "--cpus-per-task", "2", "--time", "0:30:00", "--set",
                                 "Sheet/length=2.4 cm", study=study, command="batch"))
        assert run.returncode == 0, run.stderr
        for name in ("runs.sh", "collect.sh"):
            script = self.out / "batch" / name
            subprocess.run(["bash", "-n", script], check=True)
            assert "--set 'Sheet/length=2.4 cm'" in script.read_text()
            assert str(script) in run.stdout
        assert "#SBATCH --array=1-2\n" in (self.out / "batch/runs.sh").read_text()

    def test_batch_refuses_what_would_break_a_script(self):
        for words, reason in ((["--time", "1h"], "--time"), (["--time", "0:01:00"], "5 minutes"), (["--time", "4:59"], "5 minutes"), (["--partition", "a b"], "--partition"),
                              (["--tasks", "0"], "--tasks")):
            run = latcon(*self.words("--slurm", *words, command="batch"))
            assert run.returncode == 2, words
            assert reason in run.stderr
        run = latcon(*self.words("--slurm", command="batch", out=self.folder / "with blank"))
        assert run.returncode == 2
        assert "--slurm" in latcon(*self.words(command="batch")).stderr

    def test_batch_without_slurm_says_so(self):
        empty = self.folder / "bin"
        empty.mkdir()
        run = latcon(*self.words("--slurm", "--submit", command="batch"), env={**os.environ, "PATH": str(empty)})
        assert run.returncode == 2
        assert "no sbatch on this machine" in run.stderr
        assert (self.out / "batch/runs.sh").exists()

    def test_task_that_nears_its_time_limit_is_requeued_and_continues(self):
        def longer(document):  # so that the signal arrives during a run
            document["set"].update({"Sheet/length": "4 cm", "Time/end": "3 ms"})
            document["runs"] = {"base": {}}
            document["claims"][0]["rows"] = [{"run": "base", "quantity": "pattern"}]
        study = write_study(self.folder, longer)
        self.study("--no-report", study=study, out=self.folder / "undisturbed")
        run = latcon(*self.words("--slurm", study=study, command="batch"))
        assert run.returncode == 0, run.stderr
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
            assert task.wait(120) == 130
        assert (self.folder / "requeued").read_text() == "requeue 42_1\n"
        assert list((part / "checkpoints").iterdir())
        subprocess.run(["bash", self.out / "batch/runs.sh"], env=environment, check=True, timeout=300)
        assert "resumed_from" in json.loads((self.out / "runs/base-1/run.json").read_text())
        assert (self.folder / "requeued").read_text() == "requeue 42_1\n"  # once
        subprocess.run(["bash", self.out / "batch/collect.sh"], check=True, timeout=300)
        assert result(self.out) == result(self.folder / "undisturbed")

    @pytest.mark.skipif(not FULL, reason="in full only")
    @pytest.mark.skipif(missing() or os.geteuid() != 0, reason="needs Slurm and root, which slurmd requires")
    def test_array_cancelled_half_way_continues_in_slurm(self, tiny_study):
        with Slurm(self.folder / "slurm") as cluster:
            def submit():
                run = latcon(*self.words("--slurm", "--submit", "--tasks", "2", "--time", "10", command="batch"),
                             env=cluster.environment)
                assert run.returncode == 0, run.stdout + run.stderr

            runs = self.out / "runs"
            submit()
            cluster.wait_for(lambda: list(runs.glob("*[0-9]")), "the first run", limit=300)
            cluster.run("scancel", "--user=root")
            cluster.wait_for(lambda: not cluster.jobs(), "the end of the cancelled jobs", limit=120)
            assert len(list(runs.glob("*[0-9]"))) in range(1, RUNS)
            assert not (self.out / "study.json").exists()
            submit()
            cluster.wait_for(lambda: not cluster.jobs(), "the end of the jobs", limit=600)
            assert result(self.out) == result(tiny_study), (self.out / "batch/collect.log").read_text()
