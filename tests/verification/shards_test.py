"""latcon study --shard and --collect, and latcon batch: files, exit codes, signals."""
import os
import signal
import subprocess

from program import CASES, LATCON, latcon, read_json, wait_for
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
        latcon("lattice", CASES / "quick.prm", "--set", "Sheet/length=10 mm", "--set", "Sheet/height=6 mm", "-o", self.out)
        shards = [subprocess.Popen([LATCON, *self.words("--shard", f"{i}/2", "--threads", "1")], text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT) for i in (1, 2)]
        for shard in shards:
            printed, _ = shard.communicate(timeout=600)
            assert shard.returncode == 0, printed
        assert not (self.out / "study.json").exists()
        assert read_json(self.out / "shards/2-of-2/run.json")["exit_code"] == 0
        for _ in range(2):
            self.study("--collect", "--no-report")
            assert result(self.out) == result(tiny_study)
        assert {path.parent for path in self.out.rglob("lattice.pvd")} - set(self.out.glob("runs/*")) == {self.out / "earlier-run"}

    def test_stopped_shard_continues(self, tiny_study):
        shard = subprocess.Popen([LATCON, *self.words("--shard", "1/1", "--threads", "1")], stdout=subprocess.DEVNULL)
        assert wait_for(lambda: list((self.out / "runs").glob("*[0-9]")), shard)
        shard.send_signal(signal.SIGTERM)
        assert shard.wait(120) == 130
        measured = list((self.out / "runs").glob("*[0-9]"))
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
        printed = self.study("--shard", "2/4", study=other, expect=2)
        assert "the case of run base-1 differs" in printed and "--output-dir" in printed
        assert files_in(self.out) == before

    def test_batch_writes_scripts_that_a_shell_understands(self):
        study = write_study(self.folder)
        run = latcon(*self.words("--slurm", "--tasks", "2", "--cpus-per-task", "2", "--time", "0:30:00", "--set",
                                 "Sheet/length=2.4 cm", study=study, command="batch"))
        for name in ("runs.sh", "collect.sh"):
            script = self.out / "batch" / name
            subprocess.run(["bash", "-n", script], check=True)
            assert "--set 'Sheet/length=2.4 cm'" in script.read_text()
            assert str(script) in run.stdout
        directives = [line.split()[1] for line in (self.out / "batch/runs.sh").read_text().splitlines() if line.startswith("#SBATCH ")]
        assert directives == ["--job-name=latcon-runs", "--ntasks=1", "--time=0:30:00", f"--output={self.out}/batch/runs-%a.log",
                              "--open-mode=append", "--array=1-2", "--cpus-per-task=2", "--requeue", "--signal=B:USR1@120"]

    def test_batch_submits_the_verdict_after_the_runs(self):
        asked, sbatch = self.folder / "asked", self.folder / "sbatch"
        sbatch.write_text(f'#!/bin/sh\necho "$@" >>{asked}\necho "a warning\n$(wc -l <{asked})"\n')
        sbatch.chmod(0o755)
        run = latcon(*self.words("--slurm", "--submit", command="batch"), env={**os.environ, "PATH": f"{self.folder}:{os.environ['PATH']}"})
        assert asked.read_text().splitlines() == [f"--parsable {self.out}/batch/runs.sh", f"--parsable --dependency=afterany:1 {self.out}/batch/collect.sh"]
        assert "4 runs in 4 tasks: job 1\nthen the verdict: job 2\n" in run.stdout

    def test_batch_without_slurm_says_so(self):
        empty = self.folder / "bin"
        empty.mkdir()
        run = latcon(*self.words("--slurm", "--submit", command="batch"), env={**os.environ, "PATH": str(empty)}, expect=2)
        assert "no sbatch on this machine" in run.stderr
        assert (self.out / "batch/runs.sh").exists()

    def test_task_that_nears_its_time_limit_is_requeued_and_continues(self):
        def longer(document):  # so that the signal arrives during a run
            document["set"]["Time/end"] = "2 ms"
            document["runs"] = {"base": {}}
            document["claims"][0]["rows"] = [{"run": "base", "quantity": "pattern"}]
        study = write_study(self.folder, longer)
        self.study("--no-report", study=study, out=self.folder / "undisturbed")
        latcon(*self.words("--slurm", study=study, command="batch"))
        tools = self.folder / "bin"
        tools.mkdir()
        (tools / "scontrol").write_text(f'#!/bin/sh\necho "$@" >>{self.folder}/requeued\n')
        (tools / "scontrol").chmod(0o755)
        environment = {**os.environ, "PATH": f"{tools}:{os.environ['PATH']}", "SLURM_ARRAY_JOB_ID": "42", "SLURM_ARRAY_TASK_ID": "1"}
        part = self.out / "runs" / "base-1.part"
        with subprocess.Popen(["bash", self.out / "batch/runs.sh"], env=environment) as task:
            assert wait_for((part / "lattice-0000.vtp").exists, task)
            task.send_signal(signal.SIGUSR1)  # as Slurm does, to the script alone
            assert task.wait(120) == 130
        assert (self.folder / "requeued").read_text() == "requeue 42_1\n"
        assert list((part / "checkpoints").iterdir())
        subprocess.run(["bash", self.out / "batch/runs.sh"], env=environment, check=True, timeout=300)
        assert "resumed_from" in read_json(self.out / "runs/base-1/run.json")
        assert (self.folder / "requeued").read_text() == "requeue 42_1\n"  # once
        subprocess.run(["bash", self.out / "batch/collect.sh"], check=True, timeout=300)
        assert result(self.out) == result(self.folder / "undisturbed")
