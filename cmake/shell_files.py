#!/usr/bin/python3
"""Writes the manual page and the bash completion from the help of latcon.

Usage: shell_files.py LATCON DATA_FOLDER OUTPUT_FOLDER
"""
import json
import pathlib
import re
import subprocess
import sys

COMPLETION = """\
# Completion of latcon(1) for bash, written from its help.
_latcon() {
  local word command='' cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]} IFS=$'\\n'
  local -i at=COMP_CWORD sweeps=0
  COMPREPLY=()
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    case $word in
      @commands@) command=${command:-$word} ;;
      --sweep|--sweep=*) sweeps+=1 ;;
    esac
  done
  # Outside quotes bash divides an entry into its name, "=" and its value.
  [[ $prev != '=' ]] || at+=-1
  if [[ ${COMP_WORDS[at]} == '=' ]]; then
    case ${COMP_WORDS[at-2]} in
      --set|--sweep)
        cur=${COMP_WORDS[at-1]}=${cur#=}
        _latcon_values
        COMPREPLY=("${COMPREPLY[@]#*=}") ;;
    esac
    return
  fi
  case $prev in
    --set|--sweep)
      _latcon_words @entries@
      if ((${#COMPREPLY[@]} < 2)); then
        word=${COMPREPLY[0]-}
        COMPREPLY=()
        _latcon_values
        if [[ ${#COMPREPLY[@]} == 0 && $word ]]; then
          COMPREPLY=("$word")
          compopt -o nospace 2>/dev/null
        fi
      fi
      return ;;
    @folder_options@) _latcon_files -d; return ;;
    @file_options@) _latcon_files -f; return ;;
    @other_options@) return ;;
  esac
  if [[ $cur == -* ]]; then
    case $command in
@options@
      *) COMPREPLY=($(compgen -W $'@global_options@' -- "$cur")) ;;
    esac
    return
  fi
  case $command in
    '') COMPREPLY=($(compgen -W $'@command_words@' -- "$cur")) ;;
    verify) COMPREPLY=($(compgen -W $'@claims@' -- "$cur")) ;;
    study|batch)
      _latcon_files -f
      if ((sweeps)); then
        _latcon_words @cases@
      else
        COMPREPLY+=($(compgen -W $'@studies@' -- "$cur"))
      fi ;;
    report|init) _latcon_files -d ;;
    fracture|lattice|continuum|schema) _latcon_files -f; _latcon_words @cases@ ;;
    entries) _latcon_words @sections@ ;;
    help) _latcon_words @topics@ ;;
    *) _latcon_files -f ;;
  esac
}
_latcon_files() {
  COMPREPLY=($(compgen "$1" -- "$cur"))
  compopt -o filenames 2>/dev/null
}
# The arguments that begin with the typed text; outside quotes their blanks are escaped.
_latcon_words() {
  local word typed=${cur#[\\"\\']}
  typed=${typed//\\\\/}
  for word; do
    [[ $word == "$typed"* ]] || continue
    [[ $cur == [\\"\\']* ]] || word=${word// /\\\\ }
    COMPREPLY+=("$word")
  done
}
# Entries with values, where there is a choice.
_latcon_values() {
  _latcon_words @values@
}
complete -F _latcon latcon
"""

MAN_END = r"""
.SH FILES
.TP
.I share/latcon/cases
Cases, above the folder of the program (/usr/share/latcon/cases).
.TP
.I share/latcon/studies
Studies that can be run by name.
.TP
.I ~/.cache/latcon
Verdicts on claims, reused for the same inputs by the same program; in
.B XDG_CACHE_HOME
if that is set.
.SH EXAMPLES
.nf
latcon verify --quick
latcon fracture fig1 --set "Lattice/noise seed=7" --output-dir seed7
latcon compare output/fig1 seed7
latcon help Fracture/toughening
mpirun -n 4 latcon fracture case.prm
latcon study paper --quick
.fi
.SH SEE ALSO
.BR mpirun (1),
.BR paraview (1)
"""


class Help:
    """Parsed help of latcon or of one of its commands."""

    def __init__(self, latcon, *command):
        text = subprocess.run([latcon, *command, "--help"], check=True, capture_output=True, text=True).stdout
        self.summary, rest = text.split("\n", 1)
        self.usage = re.search(r"^Usage: (.*)$", rest, re.M).group(1)
        self.positionals, self.options, self.commands = (self.list_of(rest, name)
                                                         for name in ("Positionals", "Options", "Subcommands"))
        self.positionals += self.list_of(rest, "Claims")
        self.end = re.split(r"\n\n", rest.strip())[-1]

    @staticmethod
    def list_of(text, title):
        """(name, text) of each item below a title. Texts begin in a separate column; after a long name they begin on the
        next line."""
        column = 30
        block = re.search(rf"^{title}:\n((?:  .*\n)*)", text, re.M)
        items = []
        for line in block.group(1).splitlines() if block else []:
            if not line.startswith(" " * column):
                short = line[column - 1:column] in (" ", "")
                items.append([line[:column].strip() if short else line.strip(), line[column:] if short else ""])
            else:
                items[-1][1] = (items[-1][1] + " " + line[column:]).strip()
        return items

    def option_names(self):
        return [name for what, _ in self.options for name in re.findall(r"--[a-z-]+", what)]


def plain(what):
    """An option or argument without the type that CLI11 appends."""
    what = re.sub(r":UINT in \[.*?\]", "", what)
    what = re.sub(r" :\{.*?\}| REQUIRED", "", what)
    return what.replace(",-", ", -")


def roff(text):
    return text.replace("\\", r"\e").replace("-", r"\-").replace("'", r"\(aq")


def manual(program, commands, version):
    def items(pairs):
        return "".join(f".TP\n.B {roff(plain(what))}\n{roff(text)}\n" for what, text in pairs)

    name, what = program.summary.split(": ", 1)
    page = f'.TH LATCON 1 "" "latcon {version}" "User Commands"\n.nh\n.SH NAME\n{name} \\- {roff(what)}\n.SH SYNOPSIS\n'
    page += ".br\n".join(f".B {roff(command.usage.replace('[OPTIONS] ', ''))}\n.RI [ options ]\n"
                         for command in commands.values())
    page += f".SH OPTIONS\n{items(program.options)}.SH COMMANDS\n"
    for name, command in commands.items():
        own = [pair for pair in command.options if "--help" not in pair[0]]
        page += f".SS {name}\n{roff(command.summary)}\n{items(command.positionals + own)}"
    codes = re.sub(r"^Exit codes: ", "", program.end.replace("\n", " ")).rstrip(".").split("; ")
    page += ".SH EXIT STATUS\n" + items(code.split(" ", 1) for code in ("; ".join(codes)).split("; "))
    return page + MAN_END.lstrip("\n")


def quoted(words):
    return " ".join(f"'{word}'" for word in words)


def choices(entry):
    """Words of the schema from which the value of an entry is chosen."""
    return ("false", "true") if entry["type"] == "boolean" else entry.get("words", ())


def completion(latcon, data, program, commands):
    every = program.options + [pair for command in commands.values() for pair in command.options]

    def of_type(pattern):
        return "|".join(sorted({name for what, _ in every if re.search(pattern, what)
                                for name in what.split()[0].split(",")}))

    shared = program.option_names()
    schema = json.loads(subprocess.run([latcon, "schema"], check=True, capture_output=True, text=True).stdout)
    keys = [f"{entry['section']}/{entry['name']}" for entry in schema["entries"]]
    sections = list(dict.fromkeys(entry["section"] for entry in schema["entries"]))
    words = {
        "commands": "|".join(commands),
        "command_words": r"\n".join(commands),
        "entries": quoted(f"{key}=" for key in keys),
        "values": quoted(f"{key}={value}" for key, entry in zip(keys, schema["entries"]) for value in choices(entry)),
        "sections": quoted(sections),
        "topics": quoted([*commands, *sections, *keys]),
        "cases": quoted(schema["cases"]),
        "folder_options": of_type(r" DIR"),
        "file_options": of_type(r" FILE"),
        "other_options": of_type(r" (N:|TIME|FIELD=VALUE|LAWS|SIDE|I/N|NAME|X,Y,R)"),
        "global_options": r"\n".join(shared),
        "options": "\n".join(f"      {name}) COMPREPLY=($(compgen -W $'"
                             + r"\n".join(dict.fromkeys(shared + command.option_names())) + "' -- \"$cur\")) ;;"
                             for name, command in commands.items()),
        "claims": re.search(r":\{(.*?)\}", commands["verify"].positionals[0][0]).group(1).replace(",", r"\n"),
        "studies": r"\n".join(sorted(path.stem for path in (data / "studies").glob("*.json"))),
    }
    return re.sub(r"@(\w+)@", lambda name: words[name.group(1)], COMPLETION)


def main():
    latcon, data, output = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    version = subprocess.run([latcon, "--version"], check=True, capture_output=True, text=True).stdout.split()[1]
    program = Help(latcon)
    commands = {name: Help(latcon, name) for name, _ in program.commands}
    (output / "latcon.1").write_text(manual(program, commands, version))
    (output / "latcon.bash").write_text(completion(latcon, data, program, commands))


if __name__ == "__main__":
    main()
