"""Forged checkpoints: their hash is correct, but no run wrote their contents.

Each must be refused with exit code 2 and a message that names the file, whatever sizes and indices it contains.
"""
import hashlib
import shutil

import h5py
import numpy

import victims
import whole

TIME_LIMIT = 60  # [s]; refusals happen while the file is read
# Lists of arbitrary length: nothing else in the file or the case determines their length.
OF_ANY_LENGTH = ("near_tip/sampler/path", "/sites")


def make_right(path):
    """Updates the hash of a checkpoint to that of its bytes."""
    content = path.read_bytes()
    line = content[:content.index(b"\n")]
    told = line[:line.rindex(b" ") + 1] + hashlib.sha256(content[whole.USER_BLOCK:]).hexdigest().encode() + b"\n"
    path.write_bytes(told + content[len(told):])


def replace(file, name, values):
    """Replaces an array by another with the type of `values`."""
    del file[name]
    file.create_dataset(name, data=values)


def is_text(values):
    return values.dtype.kind in "SO"


def remove(file, name):
    del file[name]


def another_type(file, name):
    values = file[name][:]
    replace(file, name, numpy.zeros(len(values), dtype="f4") if not is_text(values) else numpy.zeros(1))


def longer(file, name):
    replace(file, name, numpy.concatenate([file[name][:], file[name][:1] if len(file[name]) else [0]]).astype(file[name].dtype))


def shorter(file, name):
    replace(file, name, file[name][:-1])


def many(file, name):
    """Replaces one string by ten thousand, or a list of numbers by a very long one."""
    values = file[name][:]
    replace(file, name, numpy.resize(values if len(values) else numpy.zeros(1, values.dtype), 10000 + 7 * len(values)))


def endless(file, name):
    """Declares an array larger than any memory, with no data in the file."""
    kind = file[name].dtype
    del file[name]
    file.create_dataset(name, shape=(1 << 40,), dtype=kind, chunks=(1 << 16,))


def elsewhere(file, name):
    """Stores an array in another file."""
    kind, n = file[name].dtype, len(file[name])
    del file[name]
    file.create_dataset(name, shape=(n,), dtype=kind, external=[("/dev/zero", 0, h5py.h5f.UNLIMITED)])


def linked(file, name):
    del file[name]
    file[name] = h5py.ExternalLink("other.h5", "/values")


def grid(file, name):
    replace(file, name, numpy.resize(file[name][:], (max(1, len(file[name])), 1)))


def no_number(file, name):
    values = file[name][:]
    values[len(values) // 2] = numpy.nan
    replace(file, name, values)


def value(number):
    def made(values):
        return numpy.full(max(1, len(values)), number).astype(values.dtype)

    def change(file, name):
        replace(file, name, made(file[name][:]))
    change.__name__ = f"value {number:g}"
    change.alters = lambda values: not numpy.array_equal(made(values), values)
    return change


def unterminated(file, name):
    """Writes a string that fills its space, without a terminating zero."""
    text = bytes(file[name][0])
    del file[name]
    kind = h5py.h5t.C_S1.copy()
    kind.set_size(len(text) + 1)
    space = h5py.h5s.create_simple((1,))
    data = h5py.h5d.create(file.id, name.encode(), kind, space)
    data.write(h5py.h5s.ALL, h5py.h5s.ALL, numpy.array([text + b"x"], dtype=f"S{len(text) + 1}"), kind)


LARGE = value(float(1 << 62))
EVERYWHERE = (remove, another_type, longer, many, endless, elsewhere, linked, grid)


def of_array(name, values):
    """Possible defects of an array, depending on its kind."""
    if is_text(values):
        # The program that wrote it is not compared.
        return [*EVERYWHERE, unterminated]
    changes = [change for change in EVERYWHERE
               if not (name.endswith(OF_ANY_LENGTH) and change in (longer, many))]
    if values.dtype.kind == "f" and len(values):
        changes.append(no_number)
    if len(values) > 1 and not name.endswith(OF_ANY_LENGTH):
        changes.append(shorter)
    return changes


# Counts, indices and loop limits, by the end of their names, and values that they cannot have.
NUMBERS = {
    "run/step": [LARGE], "run/time": [value(-1e308), value(1e308)], "run/schema": [LARGE],
    "simulation/time": [value(-1e308), value(1e308), value(0.)], "simulation/parts": [value(0), value(3), value(1 << 30)],
    "simulation/bonds": [value(0xffff)], "simulation/lost_bonds": [value(255)], "simulation/n_broken": [LARGE],
    "simulation/initial_energy": [value(1e300)],
    "fracture/tip": [LARGE, value(0)], "fracture/tip_x": [value(1e308)],
    "record/last_tip": [LARGE, value(0)], "record/tip": [LARGE, value(1e308), value(-1.)],
    "record/broken_bonds": [LARGE, value(0), value(6), value(.5), value(1e308)], "record/energies": [value(1e308), value(-1.)],
    "sampler/n_pending": [LARGE, value(1000)], "sampler/last_tip": [LARGE, value(0)],
    "/block": [LARGE, value(4)], "pending/n": [LARGE], "folded/n": [LARGE, value(0)], "blocks/n": [LARGE],
    "samples": [LARGE], "vortices/sizes": [LARGE], "backward_speeds/sizes": [LARGE], "following_speeds/sizes": [LARGE],
    "film/frames/times": [value(-1.), value(0.)],
    "frames/times": [value(-1.)], "next_frame": [value(-1e308), value(1e308), value(1e-300)],
    "solver/steps": [LARGE, value(0)], "solver/time": [value(-1e308), value(1e308)],
    "frames/frames": [LARGE, value(1e308), value(0)],
    "linear_solver/is_stale": [value(2)],
}


def number_of(array):
    """The key of NUMBERS of an array; None if it has none."""
    ends = [end for end in NUMBERS if array == end or array.endswith("/" + end.lstrip("/"))]
    return max(ends, key=len, default=None)


def variants(path):
    """(name of the array, change) for all possible defects of a checkpoint."""
    found = []
    with h5py.File(path, "r") as file:
        names = []
        file.visititems(lambda name, item: names.append(name) if isinstance(item, h5py.Dataset) else None)
        for name in names:
            if name in ("run/program", "run/case_hash"):
                continue  # for readers only: the program does not read them
            values = file[name][:]
            found += [(name, change) for change in of_array(name, values)]
            if (number := number_of(name)) and len(values):
                # A count of bonds that never broke is 0 already.
                found += [(name, change) for change in NUMBERS[number] if change.alters(values)]
    return found


def prepared(name, folder):
    """Runs a victim. @return its folder, the path of its only checkpoint"""
    out = folder / name.replace(" ", "-")
    victims.run_to_end([*victims.VICTIMS[name], "--threads", "1"], out)
    *older, last = sorted((out / "checkpoints").glob("*.h5"))
    for path in older:
        path.unlink()
    return out, last


def require_refused(name, left, checkpoint, changes):
    """Resumes from changed checkpoints, in copies of a folder."""
    good = checkpoint.read_bytes()
    out = left.with_name("resumed")
    wrong = []
    for array, change in changes:
        shutil.rmtree(out, ignore_errors=True)
        (out / "checkpoints").mkdir(parents=True)
        path = out / "checkpoints" / checkpoint.name
        path.write_bytes(good)
        with h5py.File(path, "r+") as file:
            change(file, array)
        make_right(path)
        status, said = victims.run([*victims.VICTIMS[name], "--resume", "--threads", "1"], out, timeout=TIME_LIMIT)
        if status != 2 or str(path) not in said:
            wrong.append(f"{name}: {array}, {change.__name__}: exit {status}: {said.strip()[:300]}")
    assert not wrong, "\n".join(wrong)
