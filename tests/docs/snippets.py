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

from markdown_it import MarkdownIt

from printed_numbers import agrees

MARK = re.compile(r"<!-- (not run|run weekly|exit code): (.+) -->\n?")


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
    mark, after = None, None  # of the block that follows; the commands that end before, nothing in between
    for token in MarkdownIt().parse(text):
        place = f"{page}:{token.map[0] + 1 if token.map else '?'}"
        if token.type != "fence":
            if mark:
                raise BadPage(f"{place}: '{mark[0]}' is not followed by a block")
            if token.type == "code_block" and re.match(r"(\./|latcon |mpirun |cmake |pvpython )", token.content):
                raise BadPage(f"{place}: commands want a fence with a language")
            after, match = None, MARK.fullmatch(token.content)
            mark = match.groups() if match and token.type == "html_block" else None
            continue
        if lines[token.map[1] - 1].strip() != token.markup:
            raise BadPage(f"{place}: a fence is not closed")
        if not token.info:
            raise BadPage(f"{place}: a block needs a language, `text` if it is none")
        block = Block(page, token.map[0] + 1, token.info, token.content, *(mark or ("", "")))
        if mark and block.language != "sh" and (block.language != "python" or mark[0] == "exit code"):
            raise BadPage(f"{place}: '{mark[0]}' is for commands (sh)")
        if block.language == "text" and after:
            after.output = block.text
        else:
            found.append(block)
        after, mark = block if block.language in ("sh", "python") else None, None
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
