"""``python3 -m latcon``: commands of the program that are Python: studies, comparisons, explanations of entries."""
from __future__ import annotations

import json
import os
import sys

from .errors import ProgramNotFound
from .program import find_program


def main(words: list[str]) -> int:
    """Runs a command whose options the program has parsed; otherwise starts the program, which parses them."""
    if words[:1] == ["--parsed"]:
        from .study.command import run
        # Paths, which need not be UTF-8, then the other options.
        own = {"compare": ("first", "second"), "study": ("study",), "batch": ("study",)}.get(words[1], ("word",))
        return run(words[1], dict(zip(("output_dir", "program", "data", *own), words[2:-1])) | json.loads(words[-1]))
    try:
        program = os.fspath(find_program())
    except ProgramNotFound as error:
        print(f"latcon: {error}", file=sys.stderr)
        return 2
    environment = {"LATCON_PYTHON": sys.executable, **os.environ}
    os.execve(program, [program, *words], environment)


sys.exit(main(sys.argv[1:]))
