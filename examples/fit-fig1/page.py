#!/usr/bin/python3
"""Prints the tables of docs/fit-fig1.md from the record of the fit, and draws its pictures.

Usage: page.py DIRECTORY [--pictures FOLDER]   (DIRECTORY has the record that fit_fig1.py leaves, and its runs for the picture of the
best crack; nothing is run)
"""
import argparse
import json
import pathlib
import shutil
import sys
import tempfile

import numpy as np

sys.dont_write_bytecode = True

import latcon

import fit_fig1

# Quantity of an observation, its name, its unit on the page and the number of these in an SI unit.
QUANTITIES = {"crack.wavelength": ("wavelength", "cm", 100), "crack.crest_amplitude": ("crest amplitude", "cm", 100),
              "crack.speed_lagrangian": ("speed", "m/s", 1)}
SCALES = {"m": ("cm", 100), "1": ("1", 1)}
LISTED = 8  # sets in the table of the best
UNBOUNDED = 10  # uncertainty of a combination, in ranges between the bounds


def read_fit(directory):
    """The fit, from its record: in a folder of its own, where all points are known and nothing is run."""
    count = len((directory / "evaluations.jsonl").read_text().splitlines())
    with tempfile.TemporaryDirectory() as folder:
        shutil.copy(directory / "evaluations.jsonl", folder)
        result = fit_fig1.fit(folder, count, workers=1, progress=False)
        result.points, result.parameters, result.directions, result.observations  # evaluated before the folder is removed
    return result


def table(head, rows):
    return [f"| {' | '.join(head)} |", f"|{' --- |' * len(head)}", *(f"| {' | '.join(row)} |" for row in rows)]


def short(key):
    """Name of a parameter in a column."""
    return {"Nearest neighbours/area factor": "NN", "Next-nearest neighbours/area factor": "NNN", "Fracture/distance": "distance",
            "Fracture/factor": "factor", "Sheet/height": "height"}[key]


def head_of(result):
    return [f"{short(key)} [{SCALES[row['unit']][0]}]".replace(" [1]", "") for key, row in result.parameters.iterrows()]


def scaled(result, values):
    return [f"{values[key] * SCALES[row['unit']][1]:.3g}" for key, row in result.parameters.iterrows()]


def observations(result, best):
    rows = []
    for key, (name, unit, scale) in QUANTITIES.items():
        row = result.observations.loc[key]
        others = [scale * run[key.partition(".")[2]] for run in best]
        rows.append((f"{name} [{unit}]", f"{scale * row['observed']:.3g} ± {scale * row['uncertainty']:.2g}",
                     f"{scale * row['best']:.3g}", f"{row['difference']:+.1f}",
                     f"{np.mean(others):.3g} ± {np.std(others, ddof=1):.2g}"))
    patterns = [run["pattern"] for run in best]
    is_oscillating = result.points.loc[number_of_best(result), "crack.pattern"] == 1
    rows.append(("pattern", "oscillating", "oscillating" if is_oscillating else "another", "",
                 f"oscillating {patterns.count('oscillating')} of {len(patterns)}"))
    return table(("", "the paper", "best point", "difference [σ]", f"best set, {len(best)} other seeds"), rows)


def number_of_best(result):
    return int(result.points["misfit"].idxmin())


def parameters(result):
    rows = []
    for key, row in result.parameters.iterrows():
        unit, scale = SCALES[row["unit"]]
        rows.append((f"`{key}`" + ("" if unit == "1" else f" [{unit}]"), f"{scale * row['lower']:.3g} to {scale * row['upper']:.3g}",
                     f"{scale * result.best[key]:.3g}", f"{scale * row['estimate']:.3g} ± {scale * row['uncertainty']:.2g}",
                     f"± {scale * row['fixed_others']:.2g}", "yes" if row["determined"] else "no"))
    return table(("entry", "bounds", "best point", "estimate", "with the others fixed", "determined"), rows)


def sets(result, others):
    shown = result.points[np.isfinite(result.points["misfit"])].sort_values("misfit").head(LISTED)
    rows = [[str(number), *scaled(result, row), *(f"{scale * row[key]:.3g}" for key, (_, _, scale) in QUANTITIES.items()),
             f"{row['crack.crest_amplitude'] / row['crack.wavelength']:.3f}", f"{row['misfit']:.1f}",
             f"{100 * others[str(number)]['bridged_length']:.2f}"] for number, row in shown.iterrows()]
    head = ["point", *head_of(result), *(f"{name} [{unit}]" for name, unit, _ in QUANTITIES.values()), "crest amplitude/wavelength", "misfit",
            "bridged length [cm]"]
    return table(head, rows)


def directions(result):
    """Bounded combinations, and the share of each parameter in the space of the others, whose basis is arbitrary."""
    keys = list(result.parameters.index)
    bounded = result.directions[result.directions["uncertainty"] < UNBOUNDED]
    rows = [[f"{row['uncertainty']:.2g}", "yes" if row["determined"] else "no", *(f"{row[key]:+.2f}" for key in keys)]
            for _, row in bounded.iterrows()]
    rows.append(["unbounded", "no", *(f"{100 * (1 - (bounded[key]**2).sum()):.0f} %" for key in keys)])
    return table(["uncertainty", "determined", *map(short, keys)], rows)


def counts(result):
    points = result.points
    stages = points["stage"].value_counts()
    oscillating = int((points["crack.pattern"] == 1).sum())
    return [f"{len(points)} points ({stages.get('sobol', 0)} of them Sobol points, {stages.get('tpe', 0)} of the TPE sampler, "
            f"{stages.get('local', 0)} around the local minimum), a crack each with noise seed {fit_fig1.SEEDS[0]}; "
            f"{oscillating} oscillate; {len(result.near_equal)} are not distinguished from the best with 95 % confidence. "
            f"Least misfit {result.misfit:.1f}."]


def oscillating(result):
    """Points with a crack that oscillates, and has a wavelength."""
    return result.points[(result.points["crack.pattern"] == 1) & np.isfinite(result.points["crack.wavelength"])]


def bridges(result, others):
    """Sentences on the bridged length, which was not fitted."""
    points = oscillating(result)
    length = np.array([100 * others[str(number)]["bridged_length"] for number in points.index])
    ratio = (points["crack.crest_amplitude"] / points["crack.wavelength"]).to_numpy()
    near, short = points.index.isin(result.near_equal.index), length == length.min()
    return [f"The {near.sum()} near-equal cracks have bridged lengths from {length[near].min():.2f} to {length[near].max():.2f} cm and "
            f"crest amplitudes over wavelengths from {ratio[near].min():.3f} to {ratio[near].max():.3f}. The {short.sum()} oscillating cracks with "
            f"the shortest bridges, {length.min():.2f} cm, have {ratio[short].min():.3f} to {ratio[short].max():.3f}, and misfits from "
            f"{points['misfit'][short].min():.0f}."]


def best_runs(best):
    rows = [(str(run["seed"]), run["pattern"], *(f"{100 * run[name]:.3g}" for name in ("wavelength", "crest_amplitude", "amplitude")),
             f"{run['speed_lagrangian']:.3g}", f"{100 * run['bridged_length']:.2f}", f"{run['detached_sites']:.0f}") for run in best]
    return table(("seed", "pattern", "wavelength [cm]", "crest amplitude [cm]", "amplitude [cm]", "speed [m/s]", "bridged length [cm]",
                  "detached sites"), rows)


def draw(result, others, folder):
    """Pictures: each quantity over each parameter; crest amplitude over wavelength, coloured by the bridged length."""
    from matplotlib.figure import Figure
    points = oscillating(result)
    near = points[points.index.isin(result.near_equal.index)]
    best = points.loc[[number_of_best(result)]]
    keys = list(result.parameters.index)
    figure = Figure(figsize=(11, 6), layout="constrained")
    grid = figure.subplots(len(QUANTITIES), len(keys), sharey="row", sharex="col")
    for number, (quantity, (name, unit, scale)) in enumerate(QUANTITIES.items()):
        line = grid[number]
        observed = result.observations.loc[quantity]
        for axes, key in zip(line, keys):
            axes.axhspan(scale * (observed["observed"] - observed["uncertainty"]), scale * (observed["observed"] + observed["uncertainty"]),
                         color="0.8")
            axis_unit, axis_scale = SCALES[result.parameters.loc[key, "unit"]]
            for some, style in ((points, {"color": "0.55", "s": 10}), (near, {"color": "tab:blue", "s": 16}),
                                (best, {"color": "crimson", "s": 40, "marker": "*"})):
                axes.scatter(axis_scale * some[key], scale * some[quantity], linewidths=0, zorder=3, **style)
            if number == len(grid) - 1:
                axes.set_xlabel(short(key) + ("" if axis_unit == "1" else f" [{axis_unit}]"))
        line[0].set_ylabel(f"{name} [{unit}]")
    figure.savefig(folder / "fit-fig1-points.png", dpi=80)

    figure = Figure(figsize=(6.5, 4.5), layout="constrained")
    axes = figure.subplots()
    shown = axes.scatter(100 * points["crack.wavelength"], 100 * points["crack.crest_amplitude"], s=24, cmap="viridis",
                         c=[100 * others[str(number)]["bridged_length"] for number in points.index])
    observed = result.observations
    axes.errorbar(100 * observed.loc["crack.wavelength", "observed"], 100 * observed.loc["crack.crest_amplitude", "observed"],
                  xerr=100 * observed.loc["crack.wavelength", "uncertainty"], yerr=100 * observed.loc["crack.crest_amplitude", "uncertainty"],
                  color="crimson", fmt="o", capsize=3, label="the paper")
    reach = np.array([0, 100 * points["crack.wavelength"].max()])
    for ratio in (0.05, 0.074):
        axes.plot(reach, ratio * reach, ":", color="0.4", linewidth=1)
        axes.annotate(f"{ratio:g}", (reach[1], ratio * reach[1]), fontsize=8, color="0.3")
    axes.set(xlabel="wavelength [cm]", ylabel="crest amplitude [cm]", xlim=(1, None), ylim=(0, None))
    axes.legend(loc="upper left")
    figure.colorbar(shown, label="bridged length behind the tip [cm]")
    figure.savefig(folder / "fit-fig1-ratio.png", dpi=90)


def draw_best(run, folder):
    """Picture of one crack with the best set: sheet at the end, and path."""
    from matplotlib.figure import Figure
    figure = Figure(figsize=(9, 5), layout="constrained")
    sheet, path = figure.subplots(2, 1, height_ratios=(3, 2))
    run.plot_sheet(-1, "stretch", ax=sheet)
    run.plot_path(ax=path)
    path.set_ylim(-0.45, 0.45)
    figure.savefig(folder / "fit-fig1-best.png", dpi=75)


def blocks(directory):
    """Lines of the page that come from the record."""
    result = read_fit(directory)
    best, others = (json.loads((directory / f"{name}.json").read_text()) for name in ("best", "unfitted"))
    return result, others, [counts(result), observations(result, best), best_runs(best), parameters(result), sets(result, others),
                            directions(result), bridges(result, others)]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("directory", type=pathlib.Path)
    parser.add_argument("--pictures", type=pathlib.Path, help="folder for the pictures")
    given = parser.parse_args()
    result, others, tables = blocks(given.directory)
    print("\n\n".join("\n".join(lines) for lines in tables))
    if given.pictures:
        draw(result, others, given.pictures)
        best = given.directory / "runs" / f"{number_of_best(result):05}-{fit_fig1.SEEDS[0]}"
        if best.is_dir():
            draw_best(latcon.open(best), given.pictures)


if __name__ == "__main__":
    main()
