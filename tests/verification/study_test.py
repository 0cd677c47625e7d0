"""Tests of latcon study: runs, exit codes, files, resuming, kills, and refusals."""
import json
import os
import re
import shutil
import signal
import subprocess
import time

import pytest

from program import CASES, LATCON, children, latcon, read_csv, read_json, wait_for
from studies import TINY, Studies, files_in, run, words_of, write_study
from verdicts_fixture import BUCKLED

FOLDERS = ["base-1", "base-2", "low-1", "thin-1"]
# The rubber of quick.prm itself, whose verdicts the fixture of the tests has left, for studies that verify it.
BOTH_NEIGHBOURS = {**TINY["set"], "Next-nearest neighbours/present": True}


class TestStudy(Studies):
    @pytest.fixture
    def ended(self, tiny_study):
        """Begins with the study that has run to its end, with the times of its files."""
        shutil.copytree(tiny_study, self.out)

    def study(self, *arguments, change=None, skip=True, page=False, **keywords):
        """Runs the tiny study after `change` has changed it, without its page unless `page`. @return its output"""
        return run("study", write_study(self.folder, change), "--output-dir", self.out, *["--skip-verification"] * skip,
                   *["--no-report"] * (not page), *arguments, **keywords)

    def test_a_run_whose_energies_do_not_balance_is_no_measurement(self):
        def change(document):
            document["set"].update({"Time/integrator": "runge-kutta-chebyshev", "Output/energy interval": 1})
            document["runs"] = {"fine": {}, "coarse": {"set": {"Time/step": "16 us"}}}  # four times the automatic step
            document["claims"] = [{"claim": "It runs", "rows": [{"run": "fine", "quantity": "bonds_broken", "above": 1},
                                                                {"run": "coarse", "quantity": "bonds_broken"}]}]
        printed = self.study(change=change, expect=3)
        assert re.search(r"coarse, seed 1: failed its checks: fracture: energy imbalance [^()]* \(ledger\)", printed)
        assert [line["state"] for line in read_csv(self.out / "study.csv")] == ["measured", "failed its checks"]
        claim, = json.loads(self.text("study.json"))["claims"]
        assert claim["verdict"] == "holds"  # no row needs the run that failed, but the study does
        assert [row["values"][0]["n"] for row in claim["rows"]] == [1, 0]
        assert list(json.loads(self.text("runs/coarse-1/run.json"))["failed_rows"].values()) == ["ledger"]
        times = [path.stat().st_mtime_ns for path in sorted(self.out.glob("runs/*/crack.json"))]
        self.study("--resume", change=change, expect=3)  # such a run would end alike
        assert times == [path.stat().st_mtime_ns for path in sorted(self.out.glob("runs/*/crack.json"))]

    def text(self, name):
        return (self.out / name).read_text()

    def times(self, names=FOLDERS):
        """Modification times of the runs."""
        return {name: (self.out / "runs" / name / "crack.json").stat().st_mtime_ns for name in names}

    def test_runs_everything_and_leaves_every_file(self, ended, tiny_study):
        printed = (tiny_study.parent / "printed").read_text()
        assert "[4/4]" in printed
        assert max(map(len, printed.splitlines())) <= 120
        assert not {"study.html", "pictures"} & set(os.listdir(self.out))
        # A page is drawn of runs that are finished.
        environment = {name: value for name, value in (os.environ | {"LATCON_PROGRESS": "none"}).items() if not name.startswith("OMPI_")}
        self.study("--resume", env=environment, page=True, change=lambda document: document.update(pictures=["base"]))
        assert sorted(path.name for path in (self.out / "runs").iterdir()) == FOLDERS
        assert "report.html" not in os.listdir(self.out / "runs" / "base-1")
        document = json.loads(self.text("study.json"))
        rows = document["claims"][0]["rows"]
        assert [row["verdict"] for row in rows] == ["holds", "reported", "reported"]
        assert rows[0]["values"][0]["n"] == 2
        assert (document["verification"], document["verified"]) == ("none (--skip-verification)", False)
        lines = read_csv(self.out / "study.csv")
        assert [(line["run"], line["seed"]) for line in lines] == [("base", "1"), ("base", "2"), ("low", "1"), ("thin", "1")]
        crack = json.loads(self.text("runs/base-2/crack.json"))
        assert float(lines[1]["speed_lagrangian [m/s]"]) == crack["speed_lagrangian"]
        assert json.loads(self.text("results.json"))["verdict"] == "holds"
        page = self.text("study.html")
        assert (self.out / "pictures" / "base-sheet.png").exists()
        for part in ("The crack runs", "Not verified: the only row holds", "data:image/png", "It does."):
            assert part in page
        assert 'class="banner holds"' not in page
        assert "http" not in page.replace("http://www.w3.org", "")

    def test_state_that_is_refused_is_reported(self):
        def change(document):
            document["runs"] = {"base": {"set": BUCKLED}}
            document["claims"][0]["rows"] = [{"run": "base", "quantity": "pattern"}]
        assert "refused: verification" in self.study(change=change, skip=False, expect=3)
        assert "refused: verification" in self.text("study.csv")
        (seed,) = json.loads(self.text("study.json"))["seeds"]
        assert "no crack was run" in seed["problem"]

    def test_resume_repeats_nothing_and_gives_the_same_files(self, ended):
        before, first = self.times(), {name: self.text(name) for name in ("study.json", "study.csv", "results.json")}
        assert "0 runs, 4 are finished already" in self.study("--resume")
        assert (self.times(), {name: self.text(name) for name in first}) == (before, first)

    def test_resume_keeps_the_run_of_another_command(self, ended):
        latcon("lattice", CASES / "quick.prm", "--set", "Sheet/length=10 mm", "--set", "Sheet/height=6 mm", "-o", self.out)
        others = self.text("run.json"), self.text("results.csv")
        for _ in range(2):  # the second time the run is that of the study
            assert "0 runs, 4 are finished already" in self.study("--resume")
            assert (self.text("earlier-run-2/run.json"), self.text("earlier-run-2/results.csv")) == others
        assert not (self.out / "earlier-run-3").exists()

    def test_claims_are_no_part_of_the_runs(self, ended):
        def change(document):  # a straight crack has no wavelength
            first, = document["claims"]
            first["rows"][0]["above"] = 1000
            document["claims"].append({"claim": "It has waves", "rows": [{"run": "base", "quantity": "speed_lagrangian", "above": 1},
                                                                         {"run": "base", "quantity": "wavelength", "above": 0}]})
        printed = self.study("--resume", change=change, expect=3)
        for part in ("0 runs, 4 are finished already", "does not hold", "It has waves: incomplete", "not measured in 2 of 2"):
            assert part in printed
        assert [claim["verdict"] for claim in json.loads(self.text("study.json"))["claims"]] == ["does not hold", "incomplete"]
        results = json.loads(self.text("results.json"))
        assert [row["verdict"] for row in results["claims"]] == ["fails", "holds", "fails"]
        assert (results["claims"][2]["error"], results["verdict"]) == ("nan", "fails")
        assert json.loads(self.text("run.json"))["exit_code"] == 3

    def test_folder_of_another_study_is_refused_untouched(self, ended):
        before = files_in(self.out)
        other = write_study(self.folder, lambda document: document.update(title="Another"))
        for command, *options in (("study", "--resume"), ("study", "--collect"), ("batch", "--slurm")):
            printed = run(command, other, *options, "-o", self.out, "--skip-verification", expect=2)
            assert f"{self.out} has the results of another study, 'A tiny study'; choose another folder" in printed
        assert files_in(self.out) == before

    def test_runs_are_repeated_unless_it_resumes(self, ended):
        before = self.times()["low-1"]

        def change(document):
            document["runs"] = {"low": document["runs"]["low"]}
            del document["claims"]
        self.study(change=change)
        assert self.times(["low-1"])["low-1"] != before

    def test_resume_repeats_what_would_come_out_differently(self, ended):
        before = self.times()

        info = self.out / "runs" / "thin-1" / "run.json"
        document = read_json(info)
        info.write_text(json.dumps(dict(document, program_hash="0" * 64)))
        (self.out / "runs" / "base-2" / "crack.csv").unlink()
        assert "3 runs, 1 are finished already" in self.study(
            "--resume", change=lambda document: document["runs"]["low"]["set"].update({"Sheet/height": "1.1 cm"}))
        after = self.times()
        assert [name for name in FOLDERS if after[name] != before[name]] == ["base-2", "low-1", "thin-1"]

    def start(self, *arguments, change=None, threads="1"):
        """Starts the tiny study in the background."""
        return subprocess.Popen([LATCON, "study", write_study(self.folder, change), "--output-dir", self.out, "--quiet", "--no-report",
                                 "--skip-verification", "--threads", threads, *arguments])

    def test_runs_that_are_killed_continue_from_their_checkpoints(self):
        """One that the system kills, as when memory is exhausted, stops no other; then the whole study is killed."""
        def longer(document):
            document["set"].update({"Time/end": "2 ms", "Checkpoints/steps": 256})
            document["runs"] = {"base": {"seeds": [1, 2]}}
            del document["claims"][0]["rows"][1]
        self.study(change=longer)
        whole = self.text("study.csv")
        shutil.rmtree(self.out)

        def child():
            return [child for child in children(process.pid) if any("base-1" in word for word in words_of(child))]
        process = self.start(change=longer)
        assert wait_for(lambda: list(self.out.glob("runs/base-1.part/checkpoints/*.h5")), process)
        os.kill(child()[0], signal.SIGKILL)
        assert process.wait(300) == 4
        assert [line["state"] for line in read_csv(self.out / "study.csv")] == ["failed", "measured"]
        assert "killed by signal 9" in self.text("study.json")
        process = self.start("--resume", change=longer)
        assert wait_for(child, process)
        (run,) = child()
        process.kill()
        process.wait()
        while os.path.exists(f"/proc/{run}/exe"):  # it ends with its study
            time.sleep(0.01)
        self.study("--resume", change=longer)
        assert self.text("study.csv") == whole
        assert not list(self.out.glob("runs/*.part"))
        assert "resumed_from" in json.loads(self.text("runs/base-1/run.json"))

    def test_runs_fill_the_cores_with_one_thread_each_and_with_the_base_that_it_read(self):
        base = self.folder / "base.prm"
        base.write_text((CASES / "quick.prm").read_text())
        process = self.start(threads="2", change=lambda document: document.update(base=str(base)))
        most_at_once, seen = 0, set()
        while process.poll() is None:
            runs = [words_of(child) for child in children(process.pid) if "fracture" in words_of(child)]
            if runs and not seen:
                base.write_text(base.read_text().replace("strain y = 1.8", "strain y = 1.4"))
            most_at_once = max(most_at_once, len(runs))
            seen |= {tuple(words) for words in runs}
            time.sleep(0.01)
        assert (process.returncode, most_at_once) == (0, 2)
        assert len(seen) == 4 and all(words[words.index("--threads") + 1] == "1" for words in seen)
        for name in FOLDERS:
            case = self.text(f"runs/{name}/case.prm")
            assert re.search("set strain y *= (.*)", case).group(1) == "1.8"
            assert self.text(f"cases/{name}.prm") == case

    def test_quick_study_verifies_the_base_case_once(self):
        # The row is not measured: no crack of the quick version runs far enough to have a speed.
        printed = self.study("--quick", skip=False, expect=3, change=lambda document: document.update({"set": BOTH_NEIGHBOURS}))
        assert re.search("claims: (checked now|verdicts of .*, reused)", printed)
        document = json.loads(self.text("study.json"))
        assert (document["quick"], document["left_out"]) == (True, ["thin"])
        assert "base case alone" in document["verification"]
        assert [json.loads(self.text(name))["skip_verification"] for name in ("runs/low-1/run.json", "run.json")] == [True, False]

    def test_quick_study_of_a_refused_base_runs_nothing(self):
        self.study("--quick", change=lambda document: document["set"].update(BUCKLED), skip=False, expect=3)
        assert not (self.out / "runs").exists()

    def test_dry_run_lists_the_runs(self):
        printed = self.study("--dry-run")
        for part in (*FOLDERS, "4 runs"):
            assert part in printed
        assert not self.out.exists()
        assert "fig1-15" in latcon("study", "paper", "--dry-run").stdout
