"""latcon study --sweep, and what a study does where something is missing: Python, room on the disk, a folder of its own."""
import ctypes
import os
import struct
import subprocess
from pathlib import Path

import PIL
import pytest

from program import CASES, latcon, read_json
from studies import TINY, Studies, files_in, run, write_study

SMALL = [word for entry, value in TINY["set"].items() for word in ("--set", f"{entry}={str(value).lower()}")]
# Two cracks that run through in a moment.
SWEEP = ["--sweep", "Sheet/height=1 cm,1.5 cm", *SMALL[:2], *SMALL[4:]]


class Small(Studies):
    def run_study(self, *arguments, expect=0, command="study", page=False, **keywords):
        words = [command, *arguments, "--skip-verification", *["--no-report"] * (command == "study" and not page)]
        return run(*words, expect=expect, **keywords)

    def write_study(self, change=lambda document: None):
        def one_run(document):
            document["runs"] = {"low": {"set": {"Sheet/height": "1 cm"}}}
            del document["claims"]
            change(document)
        return write_study(self.folder, one_run)


CLOSE_WRITE, MOVED_TO = 0x08, 0x80  # of inotify(7)


class Events:
    """Files of a folder that are closed after writing, or moved into it, in their order."""

    def __init__(self, folder):
        self.libc = ctypes.CDLL(None, use_errno=True)
        self.folder = folder

    def __enter__(self):
        self.descriptor = self.libc.inotify_init()
        if self.libc.inotify_add_watch(self.descriptor, os.fsencode(self.folder), CLOSE_WRITE | MOVED_TO) < 0:
            raise OSError(ctypes.get_errno(), "inotify_add_watch")
        return self

    def __exit__(self, *_):
        os.close(self.descriptor)

    def read(self):
        """The events so far: [(CLOSE_WRITE or MOVED_TO, name), ...]."""
        events, found = os.read(self.descriptor, 1 << 20), []
        while events:
            _, mask, _, length = struct.unpack_from("iIII", events)
            found.append((mask, events[16:16 + length].rstrip(b"\0").decode()))
            events = events[16 + length:]
        return found


class TestSweeps(Small):
    def test_leaves_a_study_that_runs_again(self):
        printed = self.run_study("quick", *SWEEP, "--sweep", "Time/safety factor=0.5,0.9", "-o", self.out, page=True)
        assert "height-1cm_safety-factor-0.5: " in printed
        document = read_json(self.out / "study.json")
        assert [(entry["entry"], entry["unit"], entry["values"]) for entry in document["varied"]] == (
            [("Sheet/height", "m", [0.01, 0.01, 0.015, 0.015]), ("Time/safety factor", "1", [0.5, 0.9, 0.5, 0.9])])
        assert (self.out / "pictures" / "map.png").exists()
        assert (self.out / "base.prm").read_bytes() == (CASES / "quick.prm").read_bytes()
        result = (self.out / "study.json").read_bytes()
        # In its own folder by default.
        assert "0 runs, 4 are finished already" in self.run_study("sweep.json", "--resume", cwd=self.out)
        assert (self.out / "study.json").read_bytes() == result
        assert not (self.out / "output").exists()
        before = files_in(self.out)
        printed = self.run_study("quick", *SWEEP, "-o", self.out, expect=2)
        assert f"{self.out}/sweep.json differs from this sweep; to run the stored sweep: latcon study {self.out}" in printed
        assert "differs from" in self.run_study("fig1", *SWEEP, "--sweep", "Time/safety factor=0.5,0.9", "-o", self.out, expect=2)
        assert files_in(self.out) == before

    def test_is_refined_between_cases_that_differ(self):
        def change(document):  # one crack stays in its seed, the other runs
            document.update(sweep=["Loading/strain y=0.05,1.8"], refine=1, runs={"beside": {"set": {"Loading/strain y": 1.9}}})
        path = self.write_study(change)
        printed = self.run_study(path, "-o", self.out)
        assert "refinement 1: 1 cases between neighbours that differ" in printed
        document = read_json(self.out / "study.json")
        assert [(run["run"], run["level"]) for run in document["runs"]] == (
            [("strain-y-0.05", 0), ("strain-y-1.8", 0), ("beside", 0), ("strain-y-0.925", 1)])
        assert [seed["values"]["end_time"] is not None for seed in document["seeds"]] == [True] * 4
        before = (self.out / "study.json").read_bytes()
        assert "0 runs, 1 are finished already" in self.run_study(path, "-o", self.out, "--resume")
        assert (self.out / "study.json").read_bytes() == before
        assert "refined 1 time where neighbours differ" in self.run_study(path, "--dry-run")
        assert "refine = 1: a refined study does not run in shards" in (
            self.run_study(path, "-o", self.folder / "shards", "--shard", "1/2", expect=2))
        assert "does not run in shards" in self.run_study(path, "--slurm", "-o", self.folder / "shards", command="batch", expect=2)

    def test_own_study_of_this_name_does_not_run_beside_its_file(self):
        study = self.write_study().rename(self.folder / "sweep.json")
        self.run_study(study, "--quiet", cwd=self.folder)
        assert not (self.folder / "study.json").exists()
        assert (self.folder / "output" / "sweep" / "study.json").exists()

    def test_runs_in_shards(self):
        self.out.mkdir()
        with Events(self.out) as events:
            self.run_study("quick", *SWEEP, "-o", self.out, "--shard", "1/1", "--quiet")
            names = events.read()
        # While the folder is locked, since every shard removes the unfinished files of others.
        assert names.index((MOVED_TO, "sweep.json")) < names.index((CLOSE_WRITE, ".latcon.lock"))
        self.run_study(self.out / "sweep.json", "--collect", "--quiet", page=True)
        assert len(read_json(self.out / "study.json")["seeds"]) == 2
        assert (self.out / "pictures" / "sweep.png").exists()

    def test_is_a_job_array(self):
        self.run_study("quick", *SWEEP, "--seeds", "3", "--slurm", "-o", self.out, command="batch")
        script = (self.out / "batch" / "runs.sh").read_text()
        subprocess.run(["bash", "-n", self.out / "batch" / "runs.sh"], check=True)
        assert "#SBATCH --array=1-6\n" in script
        assert f" study {self.out}/sweep.json --skip-verification --output-dir {self.out} --shard" in script
        assert "--set" not in script  # the study file contains them
        assert "6 runs" in self.run_study(self.out / "sweep.json", "--dry-run")

class TestTroubles(Small):
    @pytest.mark.usefixtures("needs_mount")
    def test_node_without_packages_lacks_the_page_alone(self):
        study, bare = self.write_study(), self.folder / "bare"
        without = ["unshare", "-m", "sh", "-c", 'mount --bind /dev/null "$(readlink -f /usr/bin/python3)" && exec "$@"', "sh"]
        printed = self.run_study(study, "-o", bare, launcher=without, expect=5)
        assert "cannot start /usr/bin/python3; install python3" in printed
        assert not bare.exists()
        # An interpreter without a package of the report.
        hidden = str(Path(PIL.__file__).parent)
        without = ["unshare", "-m", "sh", "-c", f'mount -t tmpfs none {hidden} && exec "$@"', "sh"]
        printed = self.run_study(study, "-o", bare, "--quiet", launcher=without, page=True)
        assert "apt-get install python3-pil" in printed
        assert "repeat the command with --resume" in printed
        assert {"study.json", "study.csv", "results.json"} <= set(os.listdir(bare))
        assert not (bare / "study.html").exists()
        assert "0 runs, 1 are finished already" in self.run_study(study, "-o", bare, "--resume", page=True)
        assert (bare / "study.html").exists()
        # A page of an earlier run would contradict the tables.
        assert f"{bare}/study.html" not in self.run_study(study, "-o", bare, "--resume", launcher=without, page=True).splitlines()
        assert not (bare / "study.html").exists()

    @pytest.mark.usefixtures("needs_mount")
    def test_full_disk_loses_nothing(self):
        study = self.write_study(lambda document: document["runs"].update(high={}))
        self.run_study(study, "-o", self.out, "--quiet", "--threads", "1")
        expected = (self.out / "study.csv").read_bytes()
        high, low = (sum(-(-len(content) // 4096) * 4 for content in files_in(self.out / "runs" / name).values())
                     for name in ("high-1", "low-1"))  # in pages, as tmpfs counts [KiB]
        disk, kept = self.folder / "disk", self.folder / "kept"
        disk.mkdir()
        # Room for the first run, which is the more expensive one, for its case and lists, and for half of the other.
        script = (f"mount -t tmpfs -o size={high + low // 2 + 100}k none {disk} || exit 77; \"$@\"; status=$?; "
                  f"cp -r {disk}/out {kept}; exit $status")
        full = latcon("study", study, "-o", disk / "out", "--skip-verification", "--no-report", "--quiet", "--threads", "1", expect=5,
                      launcher=["unshare", "-m", "sh", "-c", script, "sh"])
        assert "No space left on device" in full.stderr
        measured = list(kept.glob("runs/*-1/crack.json"))
        assert len(measured) == 1
        assert "1 runs, 1 are finished already" in self.run_study(study, "-o", kept, "--resume", "--threads", "1")
        assert (kept / "study.csv").read_bytes() == expected
