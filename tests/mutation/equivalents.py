"""Reader of equivalents.txt, the reviewed mutants that no test can detect."""
import re


class Equivalents:
    """Entries are blocks of four lines, with empty lines between them:

        file: lattice/forces.cc
        - the original line
        + the line with the fault
        reason: why nothing that can be observed changes
    """

    def __init__(self, reasons):
        self._reasons = reasons  # {(file, before, after): reason}

    @classmethod
    def read(cls, path):
        """@throws ValueError for an incomplete entry"""
        reasons = {}
        text = re.sub(r"^#.*\n?", "", path.read_text(encoding="utf-8"), flags=re.MULTILINE)
        for block in filter(None, (block.strip() for block in re.split(r"\n\s*\n", text))):
            match = re.fullmatch(r"file: (\S+)\n- (.+)\n\+ (.+)\nreason: ((?:.|\n)+)", block)
            if not match:
                raise ValueError(f"{path}: no entry of four lines: {block}")
            file, before, after, reason = match.groups()
            reasons[file, before.strip(), after.strip()] = " ".join(reason.split())
        return cls(reasons)

    def outdated(self, mutants_of):
        """Entries that are not mutants of their file. @param mutants_of returns the mutants of a file by its name"""
        known = {file: {(m.before.strip(), m.after.strip()) for m in mutants_of(file)} for file, _, _ in self._reasons}
        return [entry for entry in self._reasons if entry[1:] not in known[entry[0]]]

    def reason(self, mutant):
        """None for a mutant that is not listed."""
        return self._reasons.get((mutant.file, mutant.before.strip(), mutant.after.strip()))
