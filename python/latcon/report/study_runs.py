"""Reader of studies: study.json and the output directories of the runs."""
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

from ..errors import UnreadableFile
from ..files import if_present, read_json
from ..quantities import number_text
from ..study.outcome import RunOutcome, RunState, group_by_run, number_of, statistics


@dataclass
class Seed(RunOutcome):
    """One run with one seed; without a pattern if it was not measured."""

    folder: Path = Path()

    @property
    def is_measured(self):
        return self.state is RunState.MEASURED


@dataclass(frozen=True)
class Study:
    """Contents of the page."""

    folder: Path
    document: dict  # study.json
    runs: dict  # {name: (about, {entry: value}, [Seed, ...])}, in the order of the study

    @property
    def claims(self):
        return self.document["claims"]

    @property
    def varied(self):
        """Entries in which the runs differ: [{"entry", "unit", "values": [number or text, per run]}, ...]."""
        return self.document.get("varied", [])

    @property
    def abscissas(self):
        """Entries over which the page may begin with a map or plot: those that the runs of a sweep vary, if all values
        are numbers and no point occurs twice; none for studies without a sweep."""
        values = [entry["values"] for entry in self.varied]
        points = list(zip(*values))
        are_numbers = all(isinstance(value, (int, float)) for value in sum(values, []))
        is_plotted = self.document.get("swept") and are_numbers and len(set(points)) == len(points)
        return self.varied if is_plotted else []

    @property
    def seeds(self):
        return [seed for _, _, seeds in self.runs.values() for seed in seeds]


def read_study(folder):
    """Reads the study in a folder. @raises UnreadableFile"""
    path = folder / "study.json"
    document = read_json(path)
    try:  # wall times are in run.json alone, so that equal runs give an equal study.json
        seeds = [Seed(s["run"], s["seed"], RunState(s["state"]), problem=s["problem"], pattern=s["pattern"],
                      values={name: value for name, value in s["values"].items() if value is not None},
                      wall_time=number_of(if_present(read_json, folder / s["folder"] / "run.json") or {}, "wall_time_total_s", 0.0),
                      folder=folder / s["folder"]) for s in document["seeds"]]
        by_run = group_by_run(seeds)
        runs = {run["run"]: (run["about"], run["set"], by_run.get(run["run"], [])) for run in document["runs"]}
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        raise UnreadableFile(path, f"lacks {error}") from error
    return Study(folder, document, runs)


def mean_of(seeds, quantity):
    """Statistics over the seeds that have a quantity; None if none has."""
    found = statistics("", quantity, seeds)
    return found if found.n else None


def patterns_of(seeds):
    """Number of seeds with each pattern, the most frequent first: {pattern: count}."""
    return dict(Counter(sorted(seed.pattern for seed in seeds if seed.pattern)).most_common())


def value_text(mean, scale=1.0):
    """Mean and standard deviation as text: "2.29 ± 0.04 (5)", or "(4 of 5)" if a seed lacks the quantity; a dash for None."""
    if mean is None:
        return "–"
    return f"{number_text(mean.mean, mean.deviation, scale=scale)} ({mean.count})"
