"""Draws the plots of a study and writes study.html."""
from .pages import write_page
from .motion import read_last_frame
from .near_tip_plots import opening_stress_picture, velocity_picture
from .pictures import draw_sheet, shrink
from .runs import read_run
from .study_page import RUN_PICTURES, contents
from .study_plots import draw_map, draw_paths, draw_speeds, draw_sweep
from .study_quantities import PATH, asked_quantities, sweeps_of
from .study_runs import first_measured, read_study

LARGEST_PICTURE = 400_000  # [bytes] per picture of a run, since the page contains all of them


def draw_pictures(study):
    """Draws all pictures for which the runs have data; see contents() for the result."""
    folder = study.folder / "pictures"
    folder.mkdir(exist_ok=True)
    drawn = {"paths": {}, "sweeps": {}, "speeds": None, "runs": []}
    for number, claim in enumerate(study.claims):
        names = list(dict.fromkeys(name for row in claim["rows"] for name in row["runs"] if name in study.runs))
        png = folder / f"paths-{number + 1}.png"
        if draw_paths(study, names, png):
            drawn["paths"][number] = png
        drawn["sweeps"][number] = draw_sweeps(study, number, claim, folder)
    drawn["overview"] = draw_overview(study, folder)
    shown = [name for name in study.document["pictures"] if name in study.runs]
    if draw_speeds(study, folder / "speeds.png"):
        drawn["speeds"] = folder / "speeds.png"
    for name in shown:
        seed = first_measured(study, name)
        if seed is not None:
            drawn["runs"].append((name, seed.seed, draw_run(seed, folder, LARGEST_PICTURE)))
    return drawn


def draw_overview(study, folder):
    """Draws the map over two swept entries, or the sweep along one unless a claim shows it: [(caption, PNG), ...]."""
    png = folder / "map.png"
    if caption := draw_map(study, png):
        return [(caption, png)]
    if len(study.abscissas) != 1:
        return []
    (entry,) = study.abscissas
    if any(row["against"] == entry["entry"] for claim in study.claims for row in claim["rows"]):
        return []
    sweep = {"against": entry["entry"], "against_unit": entry["unit"],
             "values": [{"run": run, "against": value} for run, value in zip(study.runs, entry["values"])]}
    png = folder / "sweep.png"
    if not draw_sweep(study, sweep, ("speed_lagrangian", *PATH), png):
        return []
    return [(sweep_caption("speed, wavelength and amplitudes", entry["entry"]), png)]


def sweep_caption(names, against):
    """Caption of quantities along an abscissa."""
    return (f"{names[:1].upper()}{names[1:]} against {against}: mean and standard deviation over the seeds. Open symbols at "
            "0: not defined for this crack.")


def draw_sweeps(study, number, claim, folder):
    """Draws one picture for each set of runs along one abscissa, with the quantities of its rows: [(caption, PNG), ...]."""
    drawn = []
    for sweep in sweeps_of(claim["rows"]):
        quantities = asked_quantities(sweep)
        png = folder / f"sweep-{number + 1}-{len(drawn) + 1}.png"
        onsets = {row["quantity"]: row["onset"] for row in sweep if row.get("onset")}
        if draw_sweep(study, sweep[0], quantities, png, onsets):
            names = ", ".join(name.replace("_", " ") for name in quantities)
            drawn.append((sweep_caption(names, sweep[0]["against"]), png))
    return drawn


def draw_run(seed, folder, most, kinds=tuple(RUN_PICTURES)):
    """Draws the sheet of a run and the fields near its tip, if they exist: {kind: PNG of at most `most` bytes}."""
    drawn = {}
    frame = read_last_frame(seed.folder)
    if frame is not None:
        drawn["sheet"] = folder / f"{seed.run}-sheet.png"
        draw_sheet(frame, read_run(seed.folder).input_number("Fracture/breaking stretch"), drawn["sheet"])
    means = seed.folder / "near_tip_folded.vti"
    if means.exists() and "velocity" in kinds:
        drawn["velocity"] = folder / f"{seed.run}-velocity.png"
        velocity_picture(means, drawn["velocity"], crack_speed=seed.values.get("speed_laboratory"))
    if means.exists() and "stress" in kinds:
        drawn["stress"] = folder / f"{seed.run}-stress.png"
        opening_stress_picture(means, drawn["stress"])
    for png in drawn.values():
        shrink(png, most)
    return drawn


def study_page(folder):
    """Draws the pictures and writes the page. Returns its path."""
    study = read_study(folder)
    write_page(folder / "study.html", "study.html", **contents(study, draw_pictures(study)))
    return folder / "study.html"
