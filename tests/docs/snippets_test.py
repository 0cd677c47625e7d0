"""Runs the commands and inputs in the documentation and compares their output with the pages; snippets.py has the syntax.

With LATCON_FULL also blocks that are run weekly, and the claims and the report of every crack; otherwise the claims of the tutorial
alone, since each rubber would take half a minute, with one report, and fewer meshes. Where a fixture has left verdicts (LATCON_VERDICTS),
they are reused although a page says that claims are checked now.
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

import pytest

from snippets import blocks, differences

LATCON, SOURCE = pathlib.Path(os.environ["LATCON"]), pathlib.Path(__file__).resolve().parents[2]
FULL = "LATCON_FULL" in os.environ

# Entries without which there is no case, for blocks that show a part of one.
REQUIRED = [word for entry in ("Sheet/spacing=1 mm", "Sheet/length=4 cm", "Sheet/height=2 cm", "Material/density=944",
                               "Loading/strain x=0.1", "Loading/strain y=0.1") for word in ("--set", entry)]

# Run weekly as a whole: tests/python covers what they show.
WEEKLY = {"docs/python.md"}

# Cracks of this page wait for their claims, and the first has a report, in the daily tests too.
WHOLE = "docs/tutorial.md"
# What the daily tests add to commands: of this page, and of others. The page has three digits of what the meshes leave out.
OF_WHOLE = """case "$1" in fracture) test ! -e output/quick/report.html || set -- "$@" --no-report ;;
continuum) set -- "$@" --set "Continuum/adaptive cycles=5" --set "Continuum/reaction tolerance=1e-3" ;; esac
"""
SHORT = 'case "$1" in fracture|study) set -- "$@" --skip-verification --no-report ;; esac\n'

# Verdicts on claims and the list of fonts, once for all pages.
CACHE = tempfile.TemporaryDirectory()
MADE = os.environ.get("LATCON_VERDICTS")
if MADE:
    shutil.copytree(MADE, CACHE.name, dirs_exist_ok=True)


class Clone:
    """A temporary folder that looks like a fresh clone in which latcon is built."""

    def __init__(self, folder, whole=False):
        self.folder = folder / "latcon"
        self.folder.mkdir()
        for path in SOURCE.iterdir():
            if path.name not in ("run", "output", "build", ".git"):
                (self.folder / path.name).symlink_to(path)
        built = self.folder / "build" / "release" / "verification"
        built.mkdir(parents=True)
        short = "" if FULL else OF_WHOLE if whole else SHORT
        for path, program in ((built / "latcon", f"'{LATCON}'"), (self.folder / "run", "build/release/verification/latcon")):
            path.write_text(f'#!/bin/sh\n{short if path.parent == built else ""}exec {program} "$@"\n')
            path.chmod(0o755)
        if (SOURCE / "build" / "paraview").is_dir():
            (self.folder / "build" / "paraview").symlink_to(SOURCE / "build" / "paraview")
        self.environment = dict(os.environ, XDG_CACHE_HOME=CACHE.name, MPLCONFIGDIR=f"{CACHE.name}/matplotlib",
                                OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                                OMPI_MCA_rmaps_base_oversubscribe="1", PYTHONDONTWRITEBYTECODE="1", MPLBACKEND="Agg",
                                PYTHONPATH=str(self.folder / "python"), LATCON=str(self.folder / "run"))

    def run(self, *command):
        return subprocess.run(command, cwd=self.folder, env=self.environment, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, check=False)


def try_commands(clone, block):
    """@return the problem, or nothing"""
    ended = clone.run("bash", "-euo", "pipefail", "-c", block.text)
    wanted = int(block.says) if block.mark == "exit code" else 0
    if ended.returncode != wanted:
        return f"{block.place()}: exit code {ended.returncode}\n{block.text}{ended.stdout[-3000:]}"
    says = block.output.replace("claims: checked now, ...", "claims: verdicts of ... reused") if MADE else block.output
    missing = differences(says, ended.stdout)
    if missing:
        return f"{block.place()}: not printed:\n" + "\n".join(missing) + f"\nbut:\n{ended.stdout[-3000:]}"
    return ""


def try_statements(clone, statements):
    """Runs blocks of Python one after the other. @return the problem, or nothing"""
    end = "----- end of a block -----"
    script = clone.folder / "statements.py"
    script.write_text("".join(f"{block.text}\nprint({end!r}, flush=True)\n" for block in statements))
    ended = clone.run(sys.executable, str(script))
    printed = ended.stdout.split(end + "\n")
    for block, text in zip(statements, printed):
        if missing := differences(block.output, text):
            return f"{block.place()}: not printed:\n" + "\n".join(missing) + f"\nbut:\n{text[-3000:]}"
    if ended.returncode:
        return f"{statements[len(printed) - 1].place()}: exit code {ended.returncode}\n{printed[-1][-3000:]}"
    return ""


def try_input(clone, block):
    path = clone.folder / f"block-{block.line}.{block.language}"
    path.write_text(block.text)
    command, options = ("study", []) if '"runs"' in block.text else ("continuum", REQUIRED)
    ended = clone.run("./run", command, path.name, "--dry-run", "--quiet", *options)
    return f"{block.place()}: {ended.stdout}" if ended.returncode else ""


# Blocks that are not run, and those that are.
LEFT_OUT = ("not run",) if FULL else ("not run", "run weekly")


def pages():
    """Pages with blocks that are run; the tutorial, which shows that claims are checked, is before those that reuse verdicts."""
    for path in [SOURCE / "README.md", *sorted(SOURCE.glob("docs/**/*.md"), reverse=True)]:
        page = str(path.relative_to(SOURCE))
        if (FULL or page not in WEEKLY) and any(
                block.mark not in LEFT_OUT and block.language in ("sh", "prm", "json", "python")
                for block in blocks(page, path.read_text(encoding="utf-8"))):
            yield page


@pytest.mark.parametrize("page", pages())
def test_snippets_do_what_the_pages_say(tmp_path, page):
    clone, statements = Clone(tmp_path, page == WHOLE), []
    for block in blocks(page, (SOURCE / page).read_text(encoding="utf-8")):
        if block.mark in LEFT_OUT:
            print(f"left out: {block.place()}: {block.says}")
        elif block.language in ("sh", "prm", "json"):
            assert not (try_commands if block.language == "sh" else try_input)(clone, block)
        elif block.language == "python":
            statements.append(block)
    assert not statements or not try_statements(clone, statements)
