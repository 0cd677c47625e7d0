"""Generator of mutants, small faults in C++ sources formatted by clang-format.

The format distinguishes operators: binary operators are surrounded by spaces; template brackets, pointers and signs are not.
"""
import dataclasses
import random
import re


@dataclasses.dataclass(frozen=True)
class Mutant:
    """One fault in one line of one file."""
    file: str    # relative to the root
    line: int    # from 1
    before: str  # the original line
    after: str   # the line with the fault
    kind: str    # of fault

    def planted(self, text):
        """The text of the file with the fault in it."""
        lines = text.split("\n")
        assert lines[self.line - 1] == self.before
        lines[self.line - 1] = self.after
        return "\n".join(lines)

    def __str__(self):
        return f"{self.file}:{self.line}  {self.kind}\n    - {self.before.strip()}\n    + {self.after.strip()}"


def _blank(match):
    return re.sub(r"[^\n]", " ", match.group(0))


def code_only(text):
    """The text with comments, strings and characters replaced by blanks, at unchanged positions."""
    return re.sub(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'', _blank, text, flags=re.DOTALL)


# Lines without arithmetic of the program: declarations of names, checks of invariants, messages.
_NO_CODE = re.compile(r"^\s*(?:#|(?:using|namespace|template|class|friend|static_assert|throw|HWY_EXPORT|HWY_UNROLL)\b|"
                      r"(?:public|private|protected):|[{}();]*\s*$)|\bassert\(")


def _literal(number):
    """The number that replaces a literal: for an integer its neighbour, otherwise its double."""
    if re.fullmatch(r"\d+", number):
        return "0" if number == "1" else str(int(number) + 1)
    value = float(number)
    return "1." if value == 0. else repr(2. * value)


# Texts that replace each other, by kind of fault.
_PAIRS = {"arithmetic": ((" + ", " - "), (" * ", " / "), (" += ", " -= "), (" *= ", " /= "), ("hn::Add(", "hn::Sub(")),
          "comparison": ((" < ", " <= "), (" > ", " >= "), (" < ", " > "), (" == ", " != "), ("hn::Lt(", "hn::Gt(")),
          "least and greatest": (("min(", "max("), ("hn::Min(", "hn::Max("), ("minCoeff(", "maxCoeff(")),
          "logic": ((" && ", " || "), ("hn::And(", "hn::Or("), ("true", "false")), "function": (("sin(", "cos("),)}
# Further faults: kind, pattern, replacement (a string, or a function of the match).
_EXCHANGES = [
    ("arithmetic", r" % ", " / "),
    ("arithmetic", r"hn::Mul\(", "hn::Div("),
    ("sign", r"(?<=[(\[{,=?:] )-(?=[\w(])|(?<=[(\[{])-(?=[\w(])|(?<=return )-(?=[\w(])", ""),
    ("constant", r"(?<![\w.])(?:\d+\.\d*|\.\d+|\d+)(?:e-?\d+)?(?![\w.])", lambda m: _literal(m.group(0))),
    ("x and y", r"(?<![&*])\b(v|a|f|n|d|dv|)([xy])(\(\)|_?)(?=\b|[^\w])",
     lambda m: m.group(1) + {"x": "y", "y": "x"}[m.group(2)] + m.group(3)),
    ("logic", r"(?<=[( ])!(?=[\w(])", ""),
    ("function", r"std::(sqrt|abs)\(", "("),
    ("function", r"\.(transpose)\(\)", ""),
    ("choice", r" \? ([\w.]+) : ([\w.]+)(?=[;,)\]]|$)", lambda m: f" ? {m.group(2)} : {m.group(1)}"),
    ("factor 2", r"(?<=return )(?=[\w(-][^;{]*;$)", "2. * "),
]
for kind, pairs in _PAIRS.items():
    for before, after in (pair[::step] for pair in pairs for step in (1, -1)):
        _EXCHANGES.append((kind, re.sub(r"^\b|\b$", r"\\b", re.escape(before)), after))
_EXCHANGES = [(kind, re.compile(pattern), to) for kind, pattern, to in _EXCHANGES]
_TEMPLATE_NUMBERS = re.compile(r"<[\w:]*(?:(?:, )?\d+)+>|, \d+> ")  # sizes of types: other values do not compile
# A whole statement on a line of its own: a call, an assignment to what exists, a jump.
_STATEMENT = re.compile(r"^\s*(?:(?:\+\+|--|\*)?[A-Za-z_][\w:.\->\[\]() *+%,]*(?:\([^{}]*\)| [-+*/|&]?= [^{}]+)|\+\+[^{};]+|"
                        r"continue|break);$")
_DECLARATION = re.compile(r"^\s*(?:const|static|constexpr|auto|double|bool|int|unsigned|return|"
                          r"std::(?:vector|array|size_t|string|optional|ptrdiff_t|pair)|"
                          r"[A-Z]\w*(?:::\w+)*(?:<.*>)? [&*]?\w+ ?[=({;]|Eigen::\w+ \w|[\w:]+<[^;]*> [&*]?\w+)")


def _closing(line, begin):
    """Position at which the bracket that opens before `begin` closes; None if that is on another line."""
    depth = 1
    for place in range(begin, len(line)):
        depth += {"(": 1, ")": -1}.get(line[place], 0)
        if depth == 0:
            return place
    return None


def _faults_of_line(code, whole):
    """(kind, line with the fault) for all faults of a line of code; `whole`: no statement extends across its ends."""
    for kind, pattern, to in _EXCHANGES:
        for match in pattern.finditer(_TEMPLATE_NUMBERS.sub(_blank, code) if kind == "constant" else code):
            exchange = to if isinstance(to, str) else to(match)
            yield kind, match.start(), match.end(), exchange
    match = re.match(r"^\s*(?:else )?if \(", code)
    if match:
        end = _closing(code, match.end())
        if end is not None:
            yield "negated", match.end(), end, None
    if whole and _STATEMENT.match(code) and not _DECLARATION.match(code):
        begin = len(code) - len(code.lstrip())
        yield "dropped", begin, len(code), ";"


def of_file(path, file):
    """All mutants of a file, in order.
    @param path of the file @param file its name in the report"""
    text = path.read_text(encoding="utf-8")
    lines, codes = text.split("\n"), code_only(text).split("\n")
    mutants, seen = [], set()
    inside_throw = False
    previous = ";"
    for number, (line, code) in enumerate(zip(lines, codes), 1):
        code = code.rstrip()
        starts_throw = re.search(r"\bthrow\b|\bstatic_assert\(", code) is not None
        in_throw = inside_throw or starts_throw
        if in_throw:
            inside_throw = not code.endswith(";")
        if not code.strip() or _NO_CODE.search(code) or in_throw:
            previous = code.strip() or previous
            continue
        whole = previous.endswith((";", "{", "}", ")", ":", "else")) or not previous
        for kind, begin, end, exchange in _faults_of_line(code, whole):
            part = line[begin:end]
            after = line[:begin] + (f"!({part})" if exchange is None else exchange) + line[end:]
            if after != line and (number, after) not in seen:
                seen.add((number, after))
                mutants.append(Mutant(file, number, line, after, kind))
        previous = code.strip()
    return mutants


def in_random_order(mutants, seed):
    """Shuffles mutants so that the first N are a uniform sample. The position of each depends only on the seed and on itself."""
    return sorted(mutants, key=lambda m: random.Random(f"{seed} {m.file} {m.line} {m.before} {m.after}").random())
