#!/usr/bin/python3
"""A short version of the fault harness, and tests that the harness detects incomplete files.

Usage: faults_test.py PATH_OF_LATCON PATH_OF_THE_LIBRARY_OF_FILE_FAULTS
"""
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
import kills
import moments
import victims
import whole

LIBRARY = pathlib.Path(sys.argv.pop(2))
PROGRAM = victims.Program(sys.argv.pop(1), LIBRARY)
SEED = 1
CAN_MOUNT = os.geteuid() == 0 and subprocess.run(["unshare", "-m", "mount", "-t", "tmpfs", "none", "/mnt"],
                                                 capture_output=True).returncode == 0


class Folder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)


class Faults(Folder):
    def test_runs_survive_kills_at_random_moments(self):
        rng = random.Random(SEED)
        for name in victims.VICTIMS:
            with self.subTest(name):
                ranks = (1, 1, 2) if name in victims.ON_RANKS else (1,)
                told = kills.kill_at_random(PROGRAM, name, self.folder / name, rng, 2, ranks)
                self.assertGreaterEqual(told["kills"], 2)
                self.assertGreater(told["runs"], 0)

    def test_run_without_checkpoints_starts_again(self):
        told = kills.kill_at_random(PROGRAM, "relaxation", self.folder, random.Random(SEED), 1)
        self.assertEqual(told["kills"], told["without_checkpoint"])

    def test_runs_survive_kills_and_full_disks_at_calls_that_change_files(self):
        rng = random.Random(SEED)
        for name in victims.VICTIMS:
            # tests/faults/run has both faults for all; files are written by the same functions.
            for fault in {"crack": ("kill", "full"), "lattice in motion": ("kill",)}.get(name, ("full",)):
                with self.subTest(f"{name}, {fault}"):
                    told = moments.at_moments(PROGRAM, name, self.folder / name, fault,
                                              lambda n: [rng.randint(1, n)])
                    self.assertGreater(told["calls"], 30)

    @unittest.skipUnless(CAN_MOUNT, "no disk can be mounted here")
    def test_small_disk(self):
        """A real disk becomes full in the middle of a file."""
        arguments = victims.VICTIMS["crack"]
        expected, _ = victims.undisturbed(PROGRAM, arguments, self.folder / "undisturbed")
        disk, kept = self.folder / "disk", self.folder / "kept"
        disk.mkdir()
        size = sum(path.stat().st_size for path in (self.folder / "undisturbed").rglob("*") if path.is_file())
        command = " ".join([PROGRAM.latcon, *(f"'{word}'" for word in arguments), "--output-dir", f"{disk}/out"])
        run = subprocess.run(["unshare", "-m", "sh", "-c",
                              f"mount -t tmpfs -o size={size // 2048}k none {disk} || exit 77; {command}; status=$?; "
                              f"cp -r {disk}/out {kept}; exit $status"],
                             capture_output=True, text=True, timeout=600)
        self.assertEqual(run.returncode, 5, run.stderr)
        self.assertIn(str(disk), run.stderr)
        self.assertGreater(whole.check(kept), 5)
        status, said = PROGRAM.run([*arguments, "--resume"], kept)
        self.assertIn(status, victims.DONE, said)
        kills.compare("crack", kept, expected)

    @unittest.skipUnless(CAN_MOUNT, "no disk can be mounted here")
    def test_disk_that_cannot_be_written(self):
        run = subprocess.run(["unshare", "-m", "sh", "-c",
                              f"mount -t tmpfs -o ro none {self.folder} || exit 77; exec "
                              + " ".join([PROGRAM.latcon, *(f"'{word}'" for word in victims.VICTIMS["crack"]),
                                          "--output-dir", f"{self.folder}/out"])],
                             capture_output=True, text=True, timeout=600)
        self.assertEqual(run.returncode, 5, run.stderr)
        self.assertIn(f"{self.folder}/out", run.stderr)

    def test_folder_of_somebody_else(self):
        """A folder without write permission; as user nobody if the test runs as root."""
        folder = self.folder / "locked"
        folder.mkdir(mode=0o555)
        self.folder.chmod(0o755)
        prefix = ["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"] if os.geteuid() == 0 else []
        run = subprocess.run([*prefix, PROGRAM.latcon, *victims.VICTIMS["crack"], "--output-dir", str(folder / "out")],
                             capture_output=True, text=True, timeout=600,
                             env=dict(os.environ, HOME=str(self.folder), XDG_CACHE_HOME=str(self.folder)))
        self.assertEqual(run.returncode, 5, run.stderr)
        self.assertIn("ermission denied", run.stderr)
        self.assertIn(str(folder / "out"), run.stderr)


class Harness(Folder):
    """Tests that the harness detects the faults it looks for."""

    @classmethod
    def setUpClass(cls):
        cls.run_folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.run_folder.cleanup)
        cls.whole = pathlib.Path(cls.run_folder.name) / "out"
        cls.expected, _ = victims.undisturbed(PROGRAM, victims.VICTIMS["crack"], cls.whole)

    def copy(self):
        out = self.folder / "out"
        shutil.copytree(self.whole, out)
        return out

    def test_finds_nothing_wrong_with_a_good_run(self):
        self.assertGreater(whole.check(self.copy()), 10)
        kills.compare("crack", self.copy_again(), self.expected)

    def copy_again(self):
        shutil.rmtree(self.folder / "out", ignore_errors=True)
        return self.copy()

    def test_sees_files_that_are_cut(self):
        names = ["crack.csv", "crack.json", "lattice.pvd", "lattice-0001.vtp", "near_tip.json"]
        out = self.copy()
        names += [str(path.relative_to(out)) for path in out.glob("checkpoints/*.h5")]
        self.assertGreater(len(names), 5)
        for name in names:
            with self.subTest(name):
                path = self.copy_again() / name
                content = path.read_bytes()
                path.write_bytes(content[:2 * len(content) // 3])
                self.assertRaises(whole.Broken, whole.check, self.folder / "out")

    def test_sees_a_flipped_bit(self):
        path = max(self.copy().glob("checkpoints/*.h5"))
        content = bytearray(path.read_bytes())
        content[len(content) // 2] ^= 1
        path.write_bytes(content)
        self.assertRaises(whole.Broken, whole.check, self.folder / "out")

    def test_sees_another_result(self):
        path = self.copy() / "crack.csv"
        path.write_text(path.read_text().replace("1", "2", 1))
        self.assertRaises(kills.Failure, kills.compare, "crack", self.folder / "out", self.expected)
        path.unlink()
        self.assertRaises(kills.Failure, kills.compare, "crack", self.folder / "out", self.expected)


if __name__ == "__main__":
    unittest.main(verbosity=2)
