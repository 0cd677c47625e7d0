"""``latcon entries``, ``latcon help`` on a section or an entry, and ``latcon init``."""
from __future__ import annotations

import os
import shlex
import textwrap
from collections.abc import Mapping, Sequence
from typing import Any

from ..errors import DONE
from ..folder import write_atomically
from ..schema import Entry, EntryValue
from .output import shortest
from .program import InputError, Program, printable, read_input
from .record import Printed


def explain(program: Program, printed: Printed, options: Mapping[str, Any]) -> int:
    """Prints the entries of a section, or of all; or, if there are `commands` that the word may mean, entries of that name too."""
    word, entries, commands = options["word"], list(program.entries.values()), options.get("commands")
    sections = list(dict.fromkeys(entry.section for entry in entries))
    chosen = [section for section in sections if word.lower() in ("", section.lower())]
    if chosen:
        tables = "\n".join(section + "\n" + "".join(_line(entry) for entry in entries if entry.section == section) for section in chosen)
        printed.print(f"{tables}\nColumns: name, SI unit, default, meaning. One entry in full: latcon help Section/Name\n")
        return DONE
    if commands is None:
        raise _unknown(program, "section", word, sections, "; sections: " + ", ".join(sections))
    named = [entry for entry in entries if word.lower() in (entry.key.lower(), entry.name.lower())]
    if not named:
        known = [entry.key for entry in entries] if "/" in word else [*commands, *(entry.name for entry in entries), *sections]
        raise _unknown(program, "command, section or entry", word, known,
                       "; `latcon entries` lists all entries, `latcon --help` all commands")
    printed.print("".join(map(_whole, named)))
    return DONE


def init(program: Program, printed: Printed, options: Mapping[str, Any]) -> int:
    """Creates a folder with a commented case to start from."""
    folder = options["word"]
    case = os.path.join(folder, (os.path.basename(os.path.abspath(folder)) or "case") + ".prm")
    if os.path.exists(case):
        raise InputError(f"{case} exists; give another folder")
    source = f"{program.data}/cases/start.prm"
    content, problem = read_input(source)
    if problem:
        raise InputError(f"cannot read the starting case {source}: {problem}")
    if not options["dry_run"]:
        os.makedirs(folder, exist_ok=True)
        write_atomically(case, content)
        quoted = shlex.quote(case)
        printed.say(f"{case}\n\nrun it:       latcon fracture {quoted}\ncheck it:     latcon fracture {quoted} --dry-run\n"
                    "its entries:  latcon entries")
    return DONE


def _unknown(program: Program, kind: str, word: str, known: Sequence[str], otherwise: str) -> InputError:
    return InputError(f"no {kind} '{printable(word)}'{program.hint(word, known) or otherwise}")


def _hanging(before: str, text: str) -> str:
    return textwrap.fill(text, 120, initial_indent=before, subsequent_indent=" " * len(before), break_on_hyphens=False) + "\n"


def _line(entry: Entry) -> str:
    value = "required" if entry.required else _text(entry.default)
    return _hanging(f"  {entry.name:20}{'-' if entry.unit == '1' else entry.unit or '':8}{value:22} ", entry.documentation)


def _whole(entry: Entry) -> str:
    value = _text(entry.default)
    others = "or deg" if entry.unit == "rad" else "with a prefix n, u, m, c, d, k, M or G"
    unit = "none" if entry.unit == "1" else f"{entry.unit}; a value may carry its unit, {others}"
    default, value = ("none, the entry is required", "...") if entry.required else (value or "empty", value)
    return (f"{entry.key}\n{_hanging('  ', entry.documentation)}" + (f"  unit:     {unit}\n" if entry.unit else "")
            + (_hanging("  allowed:  ", entry.allowed) if entry.allowed else "") + f"  default:  {default}\n"
            f"  in a case file:       subsection {entry.section}\n{'':26}set {entry.name} = {value}\n{'':24}end\n"
            f"  on the command line:  --set \"{entry.key}={value}\"\n")


def _text(value: EntryValue) -> str:
    """Returns a value as a case file has it: a number by the fewest letters that read back to it."""
    if isinstance(value, list):
        return ", ".join(map(_text, value))
    if isinstance(value, float):
        return shortest(value)
    return "auto" if value is None else str(value).lower() if isinstance(value, bool) else str(value)
