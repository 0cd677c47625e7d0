"""A copy of the sources and of their build, in which mutants are built and tested.

Only the objects that depend on the mutated file are rebuilt; they precede the archives on the linker's command line, which
contain the original objects.
"""
import json
import pathlib
import re
import shlex
import shutil
import subprocess

from testing import Failed, Verdict

SOURCES = ("support", "lattice", "continuum", "verification", "tests")
SOURCE_NAMES = (".h", ".cc", ".inc")
BUILT_NAMES = (".o", ".a", ".gch", ".hxx", ".h")
FEW = 8  # number of objects that are built first


class Scratch:
    """The copied sources are not changed: a mutated file is in a separate folder, which the compiler searches first."""

    def __init__(self, root, build, folder, programs):
        """@param root source folder @param build complete build folder @param folder folder for the copy
        @param programs {name of the target: test program}"""
        self._root, self._origin = root.resolve(), build.resolve()
        self.tree, self._build, self._programs = folder / "tree", folder / "build", programs
        self._ninja(*programs)  # the build must be up to date before it is copied
        for name in filter(lambda name: (root / name).is_dir(), SOURCES):
            _copy(root / name, self.tree / name, lambda n: n.endswith(SOURCE_NAMES))
        _copy(build, self._build, lambda n: n.endswith(BUILT_NAMES) or n in programs)
        self._compile = {}  # object: command
        for entry in json.loads((build / "compile_commands.json").read_text(encoding="utf-8")):
            command = shlex.split(entry["command"])
            self._compile[command[command.index("-o") + 1]] = command
        self._dependents = self._find_dependents()
        self._links = {name: self._link(name) for name in programs}

    def _ninja(self, *arguments):
        done = subprocess.run(["ninja", "-C", str(self._origin), *arguments], stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, text=True, check=False)
        if done.returncode != 0:
            raise Failed(f"ninja {' '.join(arguments)}: {done.stderr or done.stdout}")
        return done.stdout

    def _find_dependents(self):
        """{source, relative to the root: objects}"""
        dependents, current = {}, ""
        for line in self._ninja("-t", "deps").splitlines():
            if line and not line.startswith(" "):
                current = line.split(":")[0]
            elif current in self._compile and line.strip().startswith(f"{self._root}/"):
                dependents.setdefault(str(pathlib.Path(line.strip()).relative_to(self._root)), []).append(current)
        return dependents

    def _link(self, name):
        line = next(line for line in reversed(self._ninja("-t", "commands", name).splitlines())
                    if re.search(rf" -o \S*\b{name} ", line))
        return shlex.split(line.split("&&")[1])

    def measure(self, folder):
        """Measures the times of all tests without a fault. @param folder stores them until a program is rebuilt"""
        folder.mkdir(exist_ok=True)
        for name, program in self._programs.items():
            program.measure(self._build / _output(self._links[name]), folder / f"{name}.json")

    def test(self, mutant, stages, folder):
        """Builds and tests a mutant.
        @param stages names of programs in the order in which to run them @param folder that does not exist yet
        @return Verdict"""
        overlay = folder / "tree"
        faulty = overlay / mutant.file
        faulty.parent.mkdir(parents=True)
        faulty.write_text(mutant.planted((self.tree / mutant.file).read_text(encoding="utf-8")), encoding="utf-8")
        suites = self._suites_that_know(mutant.file)
        dependents = self._dependents.get(mutant.file, [])
        built = {}
        # Nearly all objects depend on a header: a few of them may already reveal the fault.
        plans = [(stages, dependents)]
        few = [name for name in dependents if self._knows(self._source(name), mutant.file)]
        if len(dependents) > FEW and 0 < len(few) <= FEW:
            plans.insert(0, (stages[:1], few))
        for names, objects in plans:
            for name in names:
                used = [o for o in objects if o in self._links[name] or _archive(o) in self._links[name]]
                for part in used:
                    if part not in built:
                        built[part] = folder / "objects" / part
                        if not self._compiles(part, overlay, built[part]):
                            return Verdict("no program")
                if used:
                    program = self._linked(name, {part: built[part] for part in used}, folder)
                    verdict = self._programs[name].run(program, suites)
                    program.unlink()
                    if verdict.outcome == "killed":
                        return Verdict("killed", f"{name}: {verdict.by}")
        if not built:
            raise Failed(f"{mutant.file} is in none of {' '.join(stages)}")
        return Verdict("survived")

    def _source(self, name):
        return pathlib.Path(self._compile[name][-1]).relative_to(self._root)

    def _knows(self, source, file):
        """Returns whether a source has the name of a file, is its test, or includes it directly."""
        stem = pathlib.Path(file).stem
        if source.stem in (stem, stem + "_test"):
            return True
        header = str(pathlib.Path(file).with_suffix(".h")) if file.endswith(".cc") else file
        return f'#include "{header}"' in (self.tree / source).read_text(encoding="utf-8")

    def _suites_that_know(self, file):
        suites = set()
        for path in sorted((self.tree / "tests").rglob("*_test.cc")):
            if self._knows(path.relative_to(self.tree), file):
                suites.update(re.findall(r"^TEST(?:_[FP])?\((\w+),", path.read_text(encoding="utf-8"), re.MULTILINE))
        return suites

    def _compiles(self, name, overlay, target):
        target.parent.mkdir(parents=True, exist_ok=True)
        command = [part.replace(str(self._origin), str(self._build)) for part in self._compile[name]]
        root = command.index(f"-I{self._root}")
        source = self._source(name)
        command[root:root + 1] = [f"-I{overlay}", f"-I{self.tree}"]
        command[-1] = str((overlay if (overlay / source).exists() else self.tree) / source)
        command[command.index("-o") + 1] = str(target)
        command.append("-w")  # a fault may leave a variable unused
        done = subprocess.run(command, cwd=self._build, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
        return done.returncode == 0

    def _linked(self, name, objects, folder):
        """Links a test program with these objects in place of the originals. @return its path"""
        link = self._links[name]
        program = folder / _output(link)
        program.parent.mkdir(parents=True, exist_ok=True)
        own = {part: str(path) for part, path in objects.items()}
        command = [own.pop(part, part) for part in link]
        at = command.index("-o")
        command[at:at + 2] = ["-o", str(program), *own.values()]
        done = subprocess.run(command, cwd=self._build, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                              check=False)
        if done.returncode != 0:
            raise Failed(f"{name} cannot be linked:\n{done.stdout[-2000:]}")
        return program


def _copy(source, target, wanted):
    """The files of a folder with given names."""
    shutil.copytree(source, target, ignore=lambda where, names: [
      n for n in names if not pathlib.Path(where, n).is_dir() and not wanted(n)])


def _output(link):
    return link[link.index("-o") + 1]


def _archive(name):
    """The archive that contains an object: lattice/CMakeFiles/latcon_lattice.dir/... is in lattice/liblatcon_lattice.a."""
    match = re.match(r"(.*)/CMakeFiles/(\w+)\.dir/", name)
    return f"{match.group(1)}/lib{match.group(2)}.a"
