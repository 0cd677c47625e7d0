"""Tests of checkpoints and --resume: choice of the checkpoint, messages about unusable ones, files of a stopped run.

Results of runs that are stopped at arbitrary times and resumed: tests/faults; on ranks and threads: same_files_test.py.
"""
import hashlib
import math
import pathlib
import re
import shutil
import signal

import h5py
import pytest

from program import CASES, LATCON, checkpoints, expect_same, files, frames, latcon, numbers, read, read_json, settings, wait_for
from verdicts_fixture import REFUSED

STRIP = ["fracture", CASES / "quick.prm", "--skip-verification", "--no-report", *settings(
    "Sheet/length=2.5 cm", "Sheet/height=1.25 cm", "Output/frame interval=0.1 ms", "Checkpoints/steps=160", "Time/end=0.8 ms", "Near tip/interval=0")]


@pytest.fixture(scope="module")
def ended(module_path):
    """Runs the strip to its end, once for all tests that begin with it."""
    ended = module_path / "out"
    latcon(*STRIP, "--output-dir", ended, expect=(0, 3))
    return ended


def run_to_end(out, *more):
    return latcon(*STRIP, "--output-dir", out, *more, expect=(0, 3))


def test_last_two_are_kept_and_tell_what_they_are(ended, out):
    shutil.copytree(ended, out)
    found = checkpoints(out)
    assert len(found) == 2
    steps = []
    for path in found:
        with h5py.File(path, "r") as file:
            steps.append(int(file["run/step"][0]))
            assert path.name == f"checkpoint-{steps[-1]:012}.h5"
            assert file["run/command"][0] == b"fracture"
            assert file["run/schema"][0] == 5
            assert b"Sheet/length = 0.025\n" in file["run/case"][0]
            assert file["run/time"][0] == file["simulation/time"][0]
            sites = file["simulation/x"].shape
            assert file["simulation/bonds"].shape == sites
            assert file["record/tip"].size > 0
            case_hash = file["run/case_hash"][0].decode()
            assert case_hash == hashlib.sha256(file["run/case"][0]).hexdigest() == read_json(out / "run.json")["case_hash"]
    assert steps[1] - steps[0] == 160


def test_stopped_run_goes_on_with_the_same_bits(ended, out, start):
    process = start(*STRIP, "--output-dir", out, "--threads", "2")
    assert wait_for(lambda: len(checkpoints(out)) > 1, process), "it ended too soon"
    process.send_signal(signal.SIGTERM)
    assert process.wait(timeout=600) == 130 == read_json(out / "run.json")["exit_code"]
    # The instant of the signal is in a frame and in a checkpoint.
    with h5py.File(checkpoints(out)[-1], "r") as file:
        assert file["run/time"][0] == frames(out / "lattice.pvd")[-1][0]
        step = int(file["run/step"][0])
    run = run_to_end(out, "--resume", "--threads", "1")
    assert f"step {step}," in run.stdout
    assert read_json(out / "run.json")["resumed_from"]["step"] == step
    expect_same(out, files(ended))


def test_checkpoint_of_another_program_is_named(out, tmp_path, ended):
    shutil.copytree(ended, out)
    own = read_json(out / "run.json")["program_hash"]
    program = pathlib.Path(LATCON).resolve()
    parts = [hashlib.sha256(path.read_bytes()).hexdigest() for path in (program, program.parent / "latcon_elements.so")]
    assert own == hashlib.sha256(" ".join(parts).encode()).hexdigest()
    (tmp_path / "bin").mkdir()
    (tmp_path / "share").symlink_to(program.parents[1] / "share")
    other = tmp_path / "bin" / "latcon"
    other.write_bytes(program.read_bytes() + b"\0")
    other.chmod(0o755)
    run = latcon(*STRIP, "--resume", "--output-dir", out, program=other, expect=(0, 3))
    assert "It was written by another build of latcon, commit " in run.stdout
    info = read_json(out / "run.json")
    assert info["resumed_from"]["program_hash"] == own
    assert info["program_hash"] == hashlib.sha256(other.read_bytes()).hexdigest()


def test_without_any_it_starts_from_the_beginning(out):
    run = run_to_end(out, "--resume")
    assert "No checkpoint in" in run.stdout
    assert "resumed_from" not in read_json(out / "run.json")


def test_files_may_be_renamed_and_their_interval_changed(ended, out):
    shutil.copytree(ended, out)
    first, last = checkpoints(out)
    with h5py.File(last, "r") as file:
        step = int(file["run/step"][0])
    last.rename(last.with_name("a.h5"))
    first.rename(first.with_name("b.h5"))
    (out / "report.html").write_text("of the part that is there")
    with open(out / ".latcon-files", "a", encoding="utf-8") as names:
        names.write("report.html\n")
    run = run_to_end(out, "--resume", "--set", "Checkpoints/interval=1")
    assert not (out / "report.html").exists()
    assert "a.h5" in run.stdout
    assert read_json(out / "run.json")["resumed_from"]["step"] == step


@pytest.mark.parametrize("damage", [
    lambda content: content[:1000] + bytes([content[1000] ^ 16]) + content[1001:],
    lambda content: content[:-5] + bytes([content[-5] ^ 1]) + content[-4:], lambda content: content[:len(content) // 2],
    lambda content: content[:700] + bytes(512) + content[1212:], lambda content: content + b"\0", lambda content: b""],
    ids=["a bit", "a bit at the end", "half", "a sector of zeros", "a byte more", "nothing"])
def test_older_one_is_taken_if_the_last_is_damaged(out, ended, damage):
    shutil.copytree(ended, out)
    expected = files(out)
    first, last = checkpoints(out)
    last.write_bytes(damage(last.read_bytes()))
    run = run_to_end(out, "--resume")
    assert re.search(f"{last}: it (was changed or damaged|is not a checkpoint)", run.stderr)
    assert str(first) in run.stdout
    expect_same(out, expected)


def test_nothing_is_touched_if_none_can_be_used(out, ended):
    shutil.copytree(ended, out)
    first, last = checkpoints(out)
    first.write_bytes(first.read_bytes()[:1000])
    last.write_text("not a checkpoint at all\n")
    (out / "checkpoints" / "notes.txt").write_text("mine")
    before = {path: path.stat().st_mtime_ns for path in out.rglob("*")}
    run = latcon(*STRIP, "--output-dir", out, "--resume", expect=2)
    assert f"{first}: it was changed or damaged" in run.stderr
    assert f"{last}: it is not a checkpoint" in run.stderr
    assert "omit --resume" in run.stderr
    assert {path: path.stat().st_mtime_ns for path in out.rglob("*")} == before


def test_those_of_another_case_are_refused_with_the_difference(out, ended):
    shutil.copytree(ended, out)
    run = latcon(*STRIP, "--output-dir", out, "--resume", "--set", "Fracture/breaking stretch=3.1", expect=2)
    assert "another case: Fracture/breaking stretch = 3.05 in the checkpoint, 3.1 in this case" in run.stderr
    run = latcon("lattice", *STRIP[1:2], "--output-dir", out, "--resume", "--set", "Lattice/solution=motion", expect=2)
    assert "written by `latcon fracture`" in run.stderr


@pytest.mark.parametrize("words, code", [
    (STRIP, (0, 3)), (["lattice", *STRIP[1:2], *STRIP[4:8]], 0), (["compare", None, None, "--no-report"], 0),
    (["fracture", *STRIP[1:2], "--no-report", *STRIP[4:8], *REFUSED], 3)])
def test_new_start_keeps_those_of_the_run_before(out, ended, words, code):
    """Whatever is started, its frames are not those of the checkpoints, and an end before its first one is no reason to lose them."""
    shutil.copytree(ended, out)
    before = [path.name for path in checkpoints(out)]
    for _ in range(1 if words is STRIP else 2):
        latcon(*(word or ended for word in words), "--output-dir", out, expect=code)
        assert sorted(path.name for path in (out / "checkpoints.old").glob("*.h5")) == before
        assert [path.name for path in checkpoints(out)] == (before if words is STRIP else [])
        (out / "checkpoints").mkdir(exist_ok=True)


def test_by_wall_time(out):
    place = STRIP.index("Checkpoints/steps=160")
    arguments = STRIP[:place - 1] + STRIP[place + 1:]
    latcon(*arguments, "--output-dir", out, "--set", "Checkpoints/interval=0.05 s", expect=(0, 3))
    assert len(checkpoints(out)) == 2


def push(checkpoint, speed):
    """Gives a site in the middle of the sheet in a checkpoint another velocity."""
    with h5py.File(checkpoint, "r+") as file:
        velocities = file["simulation/vx"]
        velocities[velocities.size // 2] = speed
    content = checkpoint.read_bytes()
    head, rest = content[:512], content[512:]
    checkpoint.write_bytes(re.sub(rb"[0-9a-f]{64}", hashlib.sha256(rest).hexdigest().encode(), head, count=1) + rest)


def test_last_sound_state_is_left_with_when_and_where(out):
    """Steps are stable, and divided where bonds are short, so that no case makes a sheet blow up."""
    motion = ["lattice", CASES / "quick.prm", "--output-dir", out, *settings(
        "Lattice/solution=motion", "Time/end=0.1 ms", "Fracture/breaking stretch=auto", "Output/energy interval=1", "Checkpoints/steps=20")]
    latcon(*motion)
    push(checkpoints(out)[-1], 1e4)
    run = latcon(*motion, "--resume", expect=4)
    told = re.search(r"became unstable: at (\S+) s .* number (\d+) at X = (\S+) m, Y = (\S+) m, .* state, at (\S+) s; try",
                     run.stderr)
    assert told is not None, run.stderr
    assert "try a smaller Time/safety factor\n" in run.stderr
    blown, site, X, Y, sound = map(float, told.groups())
    assert sound < blown
    energies = numbers(out / "energy.csv")
    # Checked in every step.
    step = energies["t"][1] - energies["t"][0]
    assert (blown - sound) / step == pytest.approx(1., abs=1e-5 * blown / step)  # six digits of each
    last_time, last = frames(out / "lattice.pvd")[-1]
    assert last_time == pytest.approx(sound, abs=1e-5 * sound)
    assert last_time == energies["t"][-1]
    assert energies["elastic"][-1] + energies["kinetic"][-1] < 2. * energies["elastic"][0]
    sheet = read(last)
    assert 0. < (sheet.PointData["velocity"]**2).sum() < math.inf
    assert sheet.Points[int(site), :2].tolist() == pytest.approx([X, Y], abs=5e-7)


def test_last_sound_frame_has_the_stresses_of_its_time(out, tmp_path):
    """Bonds have a memory, and steps are too long for the springs of their branches."""
    case = ["fracture", CASES / "quick.prm", "--skip-verification", "--no-report", *settings(
        "Sheet/length=2.5 cm", "Sheet/height=1.5 cm", "Contact/present=false", "Nearest neighbours/viscosity=1 Pa s",
        "Next-nearest neighbours/viscosity=1 Pa s", "Nearest neighbours/branch moduli=5 MPa", "Nearest neighbours/relaxation times=0.2 ms",
        "Output/energy interval=80", "Output/frame interval=20 us", "Fracture/breaking stretch=1000")]
    latcon(*case, "--output-dir", tmp_path / "sound", "--set", "Time/end=10 us", expect=(0, 3))
    run = latcon(*case, "--output-dir", out, "--set", "Time/step=9.4e-6 s", expect=4)
    assert "valid state, at 0 s; try a smaller Time/step\n" in run.stderr
    assert [time for time, _ in frames(out / "lattice.pvd")] == [0.]
    assert (out / "lattice-0000.vtp").read_bytes() == (tmp_path / "sound" / "lattice-0000.vtp").read_bytes()
