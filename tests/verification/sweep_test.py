#!/usr/bin/python3
"""latcon study --sweep, and what a study does where something is missing: Python, room on the disk, a folder of its own.

Usage: sweep_test.py PATH_OF_LATCON
"""
import copy
import ctypes
import json
import os
import signal
import struct
import subprocess
import sys
import unittest
from pathlib import Path

import PIL

sys.dont_write_bytecode = True
from program import CASES, LATCON, TemporaryFolder, children, latcon, wait_for
from study_test import TINY, words_of

SMALL = [word for entry, value in TINY["set"].items() for word in ("--set", f"{entry}={str(value).lower()}")]
# Two cracks that run through in a moment.
SWEEP = ["--sweep", "Sheet/height=1 cm,1.5 cm", *SMALL[:2], *SMALL[4:]]
CAN_MOUNT = os.geteuid() == 0 and subprocess.run(["unshare", "-m", "mount", "-t", "tmpfs", "none", "/mnt"],
                                                 capture_output=True, check=False).returncode == 0


class Folder(TemporaryFolder):
    def run_study(self, *arguments, expect=0, command="study", launcher=(), **keywords):
        words = [command, *arguments, "--skip-verification"]
        run = (subprocess.run([*launcher, LATCON, *map(str, words)], capture_output=True, text=True, timeout=600, check=False)
               if launcher else latcon(*words, **keywords))
        self.assertEqual(run.returncode, expect, run.stdout + run.stderr)
        return run.stdout + run.stderr

    def write_study(self, change=lambda document: None):
        document = copy.deepcopy(TINY)
        document["runs"] = {"low": {"set": {"Sheet/height": "1 cm"}}}
        del document["claims"]
        change(document)
        path = self.folder / "tiny.json"
        path.write_text(json.dumps(document))
        return path

    def files(self, folder=None):
        return {path: path.read_bytes() for path in (folder or self.out).rglob("*") if path.is_file()}


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


class Sweeps(Folder):
    def test_leaves_a_study_that_runs_again(self):
        printed = self.run_study("quick", *SWEEP, "--sweep", "Time/safety factor=0.5,0.9", "-o", self.out)
        self.assertIn("height-1cm_safety-factor-0.5: ", printed)
        document = json.loads((self.out / "study.json").read_text())
        self.assertEqual([(entry["entry"], entry["unit"], entry["values"]) for entry in document["varied"]],
                         [("Sheet/height", "m", [0.01, 0.01, 0.015, 0.015]),
                          ("Time/safety factor", "1", [0.5, 0.9, 0.5, 0.9])])
        self.assertTrue((self.out / "pictures" / "map.png").exists())
        self.assertEqual((self.out / "base.prm").read_bytes(), (CASES / "quick.prm").read_bytes())
        result = (self.out / "study.json").read_bytes()
        # In its own folder by default.
        printed = self.run_study(self.out / "sweep.json", "--resume")
        self.assertIn("0 runs, 4 are finished already", printed)
        self.assertEqual((self.out / "study.json").read_bytes(), result)
        printed = self.run_study("sweep.json", "--resume", cwd=self.out)
        self.assertIn("0 runs, 4 are finished already", printed)
        self.assertFalse((self.out / "output").exists())

        before = self.files()
        printed = self.run_study("quick", *SWEEP, "-o", self.out, expect=2)
        self.assertIn(f"{self.out}/sweep.json differs from this sweep; to run the stored sweep: latcon study {self.out}", printed)
        printed = self.run_study("fig1", *SWEEP, "--sweep", "Time/safety factor=0.5,0.9", "-o", self.out, expect=2)
        self.assertIn("differs from", printed)
        self.assertEqual(self.files(), before)

    def test_is_refined_between_cases_that_differ(self):
        def change(document):  # one crack stays in its seed, the other runs
            document.update(sweep=["Loading/strain y=0.05,1.8"], refine=1, runs={"beside": {"set": {"Loading/strain y": 1.9}}})
        path = self.write_study(change)
        printed = self.run_study(path, "-o", self.out)
        self.assertIn("refinement 1: 1 cases between neighbours that differ", printed)
        document = json.loads((self.out / "study.json").read_text())
        self.assertEqual([(run["run"], run["level"]) for run in document["runs"]],
                         [("strain-y-0.05", 0), ("strain-y-1.8", 0), ("beside", 0), ("strain-y-0.925", 1)])
        self.assertEqual([seed["values"]["end_time"] is not None for seed in document["seeds"]], [True] * 4)
        before = (self.out / "study.json").read_bytes()
        self.assertIn("0 runs, 1 are finished already", self.run_study(path, "-o", self.out, "--resume"))
        self.assertEqual((self.out / "study.json").read_bytes(), before)
        self.assertIn("refined 1 time where neighbours differ", self.run_study(path, "--dry-run"))
        for words in (["--shard", "1/2"], ["--collect"]):
            self.assertIn("refine = 1: a refined study does not run in shards",
                          self.run_study(path, "-o", self.folder / "shards", *words, expect=2))
        self.assertIn("does not run in shards", self.run_study(path, "--slurm", "-o", self.folder / "shards", command="batch", expect=2))

    def test_own_study_of_this_name_does_not_run_beside_its_file(self):
        study = self.write_study().rename(self.folder / "sweep.json")
        self.run_study(study, "--quiet", cwd=self.folder)
        self.assertFalse((self.folder / "study.json").exists())
        self.assertTrue((self.folder / "output" / "sweep" / "study.json").exists())

    def test_runs_in_shards(self):
        self.out.mkdir()
        with Events(self.out) as events:
            self.run_study("quick", *SWEEP, "-o", self.out, "--shard", "1/1", "--quiet")
            names = events.read()
        # While the folder is locked, since every shard removes the unfinished files of others.
        self.assertLess(names.index((MOVED_TO, "sweep.json")), names.index((CLOSE_WRITE, ".latcon.lock")))
        self.run_study(self.out / "sweep.json", "--collect", "--quiet")
        self.assertEqual(len(json.loads((self.out / "study.json").read_text())["seeds"]), 2)
        self.assertTrue((self.out / "pictures" / "sweep.png").exists())

    def test_is_a_job_array(self):
        self.run_study("quick", *SWEEP, "--seeds", "3", "--slurm", "-o", self.out, command="batch")
        script = (self.out / "batch" / "runs.sh").read_text()
        subprocess.run(["bash", "-n", self.out / "batch" / "runs.sh"], check=True)
        self.assertIn("#SBATCH --array=1-6\n", script)
        self.assertIn(f" study {self.out}/sweep.json --skip-verification --output-dir {self.out} --shard", script)
        self.assertNotIn("--set", script)  # the study file contains them
        self.assertIn("6 runs", self.run_study(self.out / "sweep.json", "--dry-run"))

    def test_bad_sweeps_are_named_and_write_nothing(self):
        for words, reason in ((["Sheet/hight=1:2:3"], "nearest: Sheet/height"),
                              (["Sheet/height=1 cm:2 cm:0"], "COUNT '0'"),
                              (["Sheet/height=1 cm:2 cm:100", "--seeds", "1001"], "more than 100000 runs, with 1001 seeds"),
                              (["Sheet/height=1 mm,2 cm"], "runs/height-1mm: --set: Sheet/height = 1 mm"),
                              (["Sheet/height=1 cm,2 cm", "--set", "Sheet/height=3 cm"], "is also an entry of --sweep"),
                              (["Sheet/height=1 cm,2 cm", "--set", "Sheet/lenght=3 cm"], "nearest: Sheet/length")):
            printed = self.run_study("quick", "--sweep", *words, "-o", self.out, expect=2)
            self.assertIn(reason, printed)
        self.assertIn("nearest shipped case: quick", self.run_study("quikc", *SWEEP, "-o", self.out, expect=2))
        self.assertIn("--seeds is an option of --sweep", self.run_study("patterns", "--seeds", "2", expect=2))
        self.assertFalse(self.out.exists())


class Troubles(Folder):
    def test_folder_of_another_study_is_refused_untouched(self):
        self.run_study(self.write_study(), "-o", self.out, "--quiet")
        before = self.files()
        other = self.write_study(lambda document: document.update(title="Another"))
        for command, *options in (("study",), ("study", "--resume"), ("study", "--shard", "1/2"), ("study", "--collect"),
                                  ("batch", "--slurm")):
            printed = self.run_study(other, *options, "-o", self.out, expect=2, command=command)
            self.assertIn(f"{self.out} has the results of another study, 'A tiny study'; choose another folder", printed)
        self.assertEqual(self.files(), before)

    @unittest.skipUnless(CAN_MOUNT, "nothing can be mounted here")
    def test_node_without_packages_lacks_the_page_alone(self):
        study = self.write_study()
        self.run_study(study, "-o", self.out, "--quiet")
        expected = {name: (self.out / name).read_bytes() for name in ("study.json", "study.csv", "results.json")}
        bare = self.folder / "bare"
        without = ["unshare", "-m", "sh", "-c", 'mount --bind /dev/null "$(readlink -f /usr/bin/python3)" && exec "$@"', "sh"]
        printed = self.run_study(study, "-o", bare, launcher=without, expect=5)
        self.assertIn("cannot start /usr/bin/python3; install python3", printed)
        self.assertFalse(bare.exists())
        # An interpreter without a package of the report.
        hidden = str(Path(PIL.__file__).parent)
        without = ["unshare", "-m", "sh", "-c", f'mount -t tmpfs none {hidden} && exec "$@"', "sh"]
        printed = self.run_study(study, "-o", bare, "--quiet", launcher=without)
        self.assertIn("apt-get install python3-pil", printed)
        self.assertIn("repeat the command with --resume", printed)
        self.assertEqual({name: (bare / name).read_bytes() for name in expected}, expected)
        self.assertFalse((bare / "study.html").exists())
        self.run_study(study, "-o", bare, "--resume", "--quiet")
        self.assertTrue((bare / "study.html").exists())
        # A page of an earlier run is not announced.
        self.assertNotIn(f"{bare}/study.html", self.run_study(study, "-o", bare, "--resume", launcher=without).splitlines())

    def test_run_that_failed_continues_from_its_checkpoint(self):
        def longer(document):
            document["set"].update({"Sheet/length": "4 cm", "Time/end": "3 ms", "Checkpoints/steps": 64})
        study = self.write_study(longer)
        process = subprocess.Popen([LATCON, "study", study, "-o", self.out, "--skip-verification", "--quiet"])
        checkpoints = self.out / "runs" / "low-1.part" / "checkpoints"
        self.assertTrue(wait_for(lambda: checkpoints.exists() and any(checkpoints.glob("*.h5")), process))
        (child,) = (child for child in children(process.pid) if "fracture" in words_of(child))
        os.kill(child, signal.SIGKILL)
        self.assertEqual(process.wait(120), 4)
        self.assertFalse((self.out / "runs" / "low-1" / "crack.json").exists())
        self.run_study(study, "-o", self.out, "--resume", "--quiet")
        self.assertIn("resumed_from", json.loads((self.out / "runs" / "low-1" / "run.json").read_text()))

    @unittest.skipUnless(CAN_MOUNT, "nothing can be mounted here")
    def test_full_disk_loses_nothing(self):
        def longer(document):
            document["runs"]["high"] = {}
        study = self.write_study(longer)
        self.run_study(study, "-o", self.out, "--quiet", "--threads", "1")
        expected = (self.out / "study.csv").read_bytes()
        high, low = (sum(-(-len(content) // 4096) * 4 for content in self.files(self.out / "runs" / name).values())
                     for name in ("high-1", "low-1"))  # in pages, as tmpfs counts [KiB]
        disk, kept = self.folder / "disk", self.folder / "kept"
        disk.mkdir()
        # Room for the first run, which is the more expensive one, for its case and lists, and for half of the other.
        script = (f"mount -t tmpfs -o size={high + low // 2 + 100}k none {disk} || exit 77; \"$@\"; status=$?; "
                  f"cp -r {disk}/out {kept}; exit $status")
        run = subprocess.run(["unshare", "-m", "sh", "-c", script, "sh", LATCON, "study", study, "-o", disk / "out",
                              "--skip-verification", "--quiet", "--threads", "1"],
                             capture_output=True, text=True, timeout=600, check=False)
        self.assertEqual(run.returncode, 5, run.stdout + run.stderr)
        self.assertIn("No space left on device", run.stderr)
        measured = list(kept.glob("runs/*-1/crack.json"))
        self.assertEqual(len(measured), 1)
        printed = self.run_study(study, "-o", kept, "--resume", "--threads", "1")
        self.assertIn("1 runs, 1 are finished already", printed)
        self.assertEqual((kept / "study.csv").read_bytes(), expected)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
