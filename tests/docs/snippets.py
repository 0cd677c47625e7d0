"""Parser of fenced code blocks in Markdown pages.

A block of a page is

    ```sh      commands, run in the order of the page, all blocks of a page in one folder
    ```python  statements, run after the commands, all blocks of a page by one interpreter in that folder
    ```text    straight after commands or statements: what they print. `...` matches anything, in a line or for lines
    ```prm, ```json    part of a case, or a study, which has `runs`; a dry run reads it

and any other language is ignored. A comment on the line before a block of commands or statements marks exceptions;
statements have no exit code:

    <!-- not run: REASON -->  it is never run
    <!-- run weekly: REASON -->  it is run with --full alone
    <!-- exit code: N -->     its last command ends with the non-zero exit code N
"""
import dataclasses
import re

from printed_numbers import agrees

MARK = re.compile(r"^<!-- (not run|run weekly|exit code): (.+) -->$")
FENCE = re.compile(r"^```(\w*)$")


class BadPage(Exception):
    pass


@dataclasses.dataclass
class Block:
    page: str
    line: int  # of the fence
    language: str
    text: str
    mark: str = ""  # `not run`, `run weekly` or `exit code`
    says: str = ""  # what follows the mark
    output: str = ""  # of commands or statements: what the page says they print

    def place(self):
        return f"{self.page}:{self.line}"


def blocks(page, text):
    """All fenced blocks of a page, in order. @throws BadPage for an unmatched fence or mark"""
    found, lines = [], text.splitlines()
    mark, i, after = None, 0, None  # after: the commands that end on the line before, blank ones left out
    while i < len(lines):
        fence, marked = FENCE.match(lines[i]), MARK.match(lines[i])
        if fence:
            begin = i
            i += 1
            while i < len(lines) and lines[i] != "```":
                i += 1
            if i == len(lines):
                raise BadPage(f"{page}:{begin + 1}: a fence is not closed")
            if not fence[1]:
                raise BadPage(f"{page}:{begin + 1}: a block needs a language, `text` if it is none")
            block = Block(page, begin + 1, fence[1], "\n".join(lines[begin + 1:i]) + "\n", *(mark or ("", "")))
            if mark and block.language != "sh" and (block.language != "python" or mark[0] == "exit code"):
                raise BadPage(f"{block.place()}: '{mark[0]}' is for commands (sh)")
            if block.language == "text" and after:
                after.output = block.text
            else:
                found.append(block)
            after = block if block.language in ("sh", "python") else None
            mark = None
        elif marked:
            mark, after = (marked[1], marked[2]), None
        elif lines[i].strip():
            if mark:
                raise BadPage(f"{page}:{i + 1}: '{mark[0]}' is not followed by a block")
            if re.match(r" {4}(\./|latcon |mpirun |cmake |pvpython )", lines[i]):
                raise BadPage(f"{page}:{i + 1}: commands want a fence with a language")
            after = None
        i += 1
    return found


def differences(expected, printed, relative=1e-3):
    """Lines of `expected` that `printed` lacks, in order: words and numbers agree by printed_numbers.py."""
    missing, rest = [], [line.split() for line in printed.splitlines()]
    for line in expected.splitlines():
        if not line.strip() or line.strip() == "...":
            continue
        for i, words in enumerate(rest):
            if same(line.split(), words, relative):
                rest = rest[i + 1:]
                break
        else:
            missing.append(line)
    return missing


def same(expected, words, relative):
    if not expected:
        return not words
    if expected[0] == "...":
        return any(same(expected[1:], words[i:], relative) for i in range(len(words) + 1))
    return bool(words) and agrees(expected[0], words[0], relative) and same(expected[1:], words[1:], relative)
