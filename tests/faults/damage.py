"""Damaged checkpoints: they must be refused, or skipped in favour of the previous one, with a message.

A resumed run must never end with other results than the uninterrupted one.
"""
import shutil

import victims
from kills import Failure


def flip(content, rng):
    """Flips one bit."""
    content[rng.randrange(len(content))] ^= 1 << rng.randrange(8)


def cut(content, rng):
    del content[rng.randrange(len(content)):]


def blank(content, rng):
    """Overwrites up to one sector with zeros."""
    at = rng.randrange(len(content))
    n = min(rng.choice((1, 8, 512, 4096)), len(content) - at)
    content[at:at + n] = bytes(n)


def lengthen(content, rng):
    content += bytes(rng.randrange(256) for _ in range(rng.choice((1, 8, 512))))


def swap(content, rng):
    """Swaps two pieces."""
    n = min(512, len(content) // 4)
    one, two = rng.randrange(len(content) // 2 - n), len(content) // 2 + rng.randrange(len(content) // 2 - n)
    content[one:one + n], content[two:two + n] = content[two:two + n], content[one:one + n]


def empty(content, rng):
    content.clear()


DAMAGES = (flip, cut, blank, lengthen, swap, empty)


def damage_at_random(name, folder, rng, variants):
    """@return statistics"""
    arguments = [*victims.VICTIMS[name], "--threads", "1"]
    victims.run_to_end(arguments, folder / "undisturbed")
    expected = victims.contents(folder / "undisturbed")
    whole = sorted((folder / "undisturbed" / "checkpoints").glob("*.h5"))
    out = folder / "damaged"
    told = {"variants": variants, "refused": 0, "fell back": 0, "same bits without a word": 0}
    for _ in range(variants):
        damage, left = rng.choice(DAMAGES), rng.choice((1, 2))
        shutil.rmtree(out, ignore_errors=True)
        (out / "checkpoints").mkdir(parents=True)
        for path in whole[-left:]:
            shutil.copy(path, out / "checkpoints")
        victim = out / "checkpoints" / rng.choice(whole[-left:]).name
        before = victim.read_bytes()
        content = bytearray(before)
        damage(content, rng)
        victim.write_bytes(content)
        status, said = victims.run([*arguments, "--resume"], out)
        what = f"{name}: {damage.__name__}, {left} left: exit {status}: {said}"
        if status == 2:
            # Only the damaged checkpoint is left.
            if left != 1 or str(victim) not in said:
                raise Failure(what)
            told["refused"] += 1
            continue
        if status not in victims.DONE:
            raise Failure(what)
        # Frames from before the checkpoint do not exist: only the output of the resumed run is compared.
        found = {key: value for key, value in expected.items() if (out / key).exists()}
        different = [key for key, value in found.items() if (out / key).read_bytes() != value]
        if different or not found:
            raise Failure(f"{what}: not what the undisturbed run wrote: {', '.join(different)}")
        # The file begins with a line that contains the hash, and unused bytes.
        if str(victim) in said:
            told["fell back"] += 1
        elif bytes(content[512:]) == before[512:] and content[:content.find(b"\n")] == before[:before.find(b"\n")]:
            told["same bits without a word"] += 1
        else:
            raise Failure(what + ": not a word of the damage")
    return told
