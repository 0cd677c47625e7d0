#!/usr/bin/python3
"""Runs the commands and inputs in the documentation and compares their output with the pages; snippets.py has the syntax.

Usage: snippets_test.py PATH_OF_LATCON SOURCE_FOLDER [--full] [PAGE...]     --full: also blocks that are run weekly
PAGE is relative to the source folder; default: README.md and all of docs/. Blocks that are not run are counted, and
listed with their reasons. Where a fixture has left verdicts (LATCON_VERDICTS), they are reused although a page says that
claims are checked now.
"""
import collections
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from snippets import BadPage, blocks, differences

# Entries without which there is no case, for blocks that show a part of one.
REQUIRED = {"Sheet/spacing": "1 mm", "Sheet/length": "4 cm", "Sheet/height": "2 cm", "Material/density": "944",
            "Loading/strain x": "0.1", "Loading/strain y": "0.1"}


# Run weekly as a whole: tests/python covers what they show.
WEEKLY = {"docs/python.md"}

# Verdicts on claims and the list of fonts, once for all pages.
CACHE = tempfile.TemporaryDirectory()
MADE = os.environ.get("LATCON_VERDICTS")
if MADE:
    shutil.copytree(MADE, CACHE.name, dirs_exist_ok=True)


class Clone:
    """A temporary folder that looks like a fresh clone in which latcon is built."""

    def __init__(self, latcon, source):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name) / "latcon"
        self.folder.mkdir()
        for path in source.iterdir():
            if path.name not in ("run", "output", "build", ".git"):
                (self.folder / path.name).symlink_to(path)
        built = self.folder / "build" / "release" / "verification"
        built.mkdir(parents=True)
        (built / "latcon").symlink_to(latcon)
        (self.folder / "run").write_text('#!/bin/sh\nexec build/release/verification/latcon "$@"\n')
        (self.folder / "run").chmod(0o755)
        if (source / "build" / "paraview").is_dir():
            (self.folder / "build" / "paraview").symlink_to(source / "build" / "paraview")
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
    if '"runs"' in block.text:
        ended = clone.run("./run", "study", path.name, "--dry-run", "--quiet")
    else:
        ended = clone.run("./run", "continuum", path.name, "--dry-run", "--quiet",
                          *[word for name, value in REQUIRED.items() for word in ("--set", f"{name}={value}")])
    return f"{block.place()}: {ended.stdout}" if ended.returncode else ""


class Pages(unittest.TestCase):
    def test_snippets_do_what_the_pages_say(self):
        counts, left_out = collections.Counter(), []
        for page in PAGES:
            with self.subTest(page):
                clone, begin = Clone(LATCON, SOURCE), time.monotonic()
                self.addCleanup(clone.temporary.cleanup)
                statements = []
                for block in blocks(page, (SOURCE / page).read_text(encoding="utf-8")):
                    if block.mark == "not run" or (block.mark == "run weekly" and not FULL):
                        counts["left out"] += 1
                        left_out.append(f"{block.place()}: {block.says}")
                    elif block.language in ("sh", "prm", "json"):
                        counts["run" if block.language == "sh" else "read"] += 1
                        problem = (try_commands if block.language == "sh" else try_input)(clone, block)
                        if problem:
                            self.fail(problem)
                    elif block.language == "python":
                        counts["executed"] += 1
                        statements.append(block)
                if statements and (problem := try_statements(clone, statements)):
                    self.fail(problem)
                print(f"{page}: {time.monotonic() - begin:.0f} s", flush=True)
        print(f"{counts['run']} blocks of commands were run, {counts['executed']} of Python, {counts['read']} of input read, "
              f"{counts['left out']} left out",
              *left_out, sep="\n")
        self.assertGreater(counts["run"] + counts["executed"] + counts["read"], 0)


class Snippets(unittest.TestCase):
    """The test of the test."""

    def test_blocks_have_languages_marks_and_output(self):
        one, two, three = blocks("page.md", "```sh\na\n```\n\n```text\nb\n```\n<!-- exit code: 3 -->\n```sh\nc\n```\n"
                                            "words\n\n```text\nd\n```\n")
        self.assertEqual((one.text, one.output, one.line), ("a\n", "b\n", 1))
        (weekly,) = blocks("page.md", "<!-- run weekly: long -->\n```sh\na\n```\n")
        self.assertEqual((weekly.mark, weekly.says), ("run weekly", "long"))
        self.assertEqual((two.mark, two.says, two.output), ("exit code", "3", ""))
        self.assertEqual(three.language, "text")
        (weekly,) = blocks("page.md", "<!-- run weekly: long -->\n```python\na\n```\n")
        self.assertEqual(weekly.mark, "run weekly")
        for text in ("<!-- exit code: 3 -->\n```python\na\n```\n", "```sh\na\n", "```\na\n```\n", "<!-- not run: so -->\nwords\n", "<!-- not run: so -->\n```text\na\n```\n",
                     "words\n\n    ./run verify\n"):
            with self.assertRaises(BadPage):
                blocks("page.md", text)

    def test_output_is_compared_by_words_and_numbers(self):
        printed = "first line 12 s\nspeed  20.200 +- 0.84 m/s holds\nlast\n"
        self.assertEqual(differences("speed 20.2 +- 0.84 m/s ...\n...\nlast\n", printed), [])
        self.assertEqual(differences("first line ... s\n", printed), [])
        self.assertEqual(differences("speed 20.3 +- 0.84 m/s holds\n", printed), ["speed 20.3 +- 0.84 m/s holds"])
        self.assertEqual(differences("last\nspeed ...\n", printed), ["speed ..."])
        self.assertEqual(differences("spee\n", printed), ["spee"])

    def test_what_fails_is_told(self):
        clone = Clone(LATCON, SOURCE)
        self.addCleanup(clone.temporary.cleanup)
        for text, part in (("```sh\n./run lattice none.prm\n```\n", "exit code 2"),
                           ("```sh\nfalse\ntrue\n```\n", "exit code 1"),
                           ("<!-- exit code: 3 -->\n```sh\ntrue\n```\n", "exit code 0"),
                           ("```sh\n./run --version\n```\n```text\nlatcon 77\n```\n", "not printed"),
                           ("```prm\nsubsection Sheet\n  set spacin = 1 mm\nend\n```\n", "spacing"),
                           ("```json\n{\"titel\": \"x\", \"runs\": {}}\n```\n", "title"),
                           ("```json\n{\"Sheet\": {\"length\": \"1 kg\"}}\n```\n", "length")):
            (block,) = blocks("page.md", text)
            wrong = (try_commands if block.language == "sh" else try_input)(clone, block)
            self.assertIn(part, wrong)
        for text, part in (("```python\nx = 1\n```\n```python\nprint(x)\n```\n```text\n2\n```\n", "page.md:4: not printed"),
                           ("```python\nx = 1\n```\n```python\nprint(y)\n```\n", "page.md:4: exit code 1"),
                           ("```python\nx = 1\n```\n```python\nprint(x)\n```\n```text\n1\n```\n", "")):
            wrong = try_statements(clone, blocks("page.md", text))
            self.assertTrue(part in wrong and bool(part) == bool(wrong), wrong)


if __name__ == "__main__":
    LATCON, SOURCE = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
    FULL = "--full" in sys.argv
    # The tutorial, which shows that claims are checked, runs before the pages that reuse their verdicts.
    every = ["README.md", *sorted((str(path.relative_to(SOURCE)) for path in SOURCE.glob("docs/**/*.md")), reverse=True)]
    PAGES = [word for word in sys.argv[3:] if word != "--full"] or [page for page in every if FULL or page not in WEEKLY]
    unittest.main(argv=sys.argv[:1], verbosity=2)
