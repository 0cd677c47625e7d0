"""What each claim says in plain words, and the plots that belong to it."""
from dataclasses import dataclass
from typing import Callable

from crack_plots import draw_running_crack
from length_plots import draw_dispersion, draw_edge_layer, draw_hole, draw_notch, draw_sinusoidal_energy
from wave_plots import draw_attenuation, draw_travelling_waves, draw_wave_speeds

# Claims that a run may have checked: {name: (heading, what is claimed in any case)}. Others are shown under their name
# alone.
CLAIMS = {
    "energy": (
        "Energy: lattice and continuum hold the same energy",
        "A sheet of bonds and the continuum that stands for it hold the same energy, in J/m³ of the undeformed "
        "sheet, and the same stress wherever the deformation is homogeneous. At small strain the moduli and wave "
        "speeds follow."),
    "wave-speeds": (
        "Wave speeds: waves travel and die out alike",
        "Waves in the lattice and in the finite elements do what closed formulas say, in an undeformed and in a "
        "stretched sheet."),
    "intrinsic-length": (
        "Intrinsic length: what the spacing leaves in the continuum",
        "A lattice of spacing d has a length that the local continuum lacks."),
    "prestretch": (
        "Pre-stretch: stretched sheets agree",
        "Stretched between held edges, the relaxed lattice and the finite elements have the same energy, tractions "
        "and fields."),
    "running-crack": (
        "Running crack: both sides part alike",
        "A straight crack is driven through lattice and continuum at the same speed. Far from its tip, from five spacings "
        "on, velocity, opening stress and opening agree as closely as the place of the tip is known in a lattice; near "
        "the tip the differences are reported."),
    "fracture": (
        "Fracture: the crack beside the published one",
        "The crack that the lattice breaks is measured and set beside the published values. There is no continuum "
        "here: the claims above are why the lattice is believed up to the crack, and nothing is claimed of "
        "agreement beyond it. Pictures of the crack are in the section of its run."),
}


@dataclass(frozen=True)
class Plot:
    """A picture NAME.png of the table NAME.csv."""

    name: str
    claim: str  # in whose section it is shown
    draw: Callable  # (tables, PNG file) -> error metrics in words
    claimed: str  # what the claim says where it leaves this table
    caption: str  # what the picture shows


PLOTS = (
    Plot("sinusoidal_energy", "energy", draw_sinusoidal_energy,
         "Where the deformation varies along a sinusoid, the energies differ by a power of k d (k: wave number, d: "
         "spacing of the lattice).",
         "Energy of a sheet displaced along a sinusoid, over what the local continuum has for it, against k d. "
         "Dashed: with the lattice's gradient energy; dotted: that over 1 + l_d² k², for loads without their "
         "gradient; solid with crosses: finite elements with the gradient energy; circles: lattice. Right: "
         "relative difference from the lattice, triangles longitudinal, circles shear; the order is the slope over "
         "the half of the points with the smallest k d."),
    Plot("travelling_waves", "energy", draw_travelling_waves,
         "A travelling wave holds the same energy on both sides, half of it elastic and half kinetic.",
         "Mean energies per undeformed volume in a travelling wave, over that of the theory (dashed), against k d; "
         "the kinetic energy of the finite elements includes that of micro-inertia. Triangles longitudinal, "
         "circles shear waves of the lattice; solid with crosses: finite elements. Right: finite elements against "
         "the lattice."),
    Plot("wave_speeds", "wave-speeds", draw_wave_speeds,
         "The local continuum knows one speed for all wavelengths; with the lattice's gradient energy and "
         "micro-inertia the speed falls with shorter waves as it does in the lattice.",
         "Phase velocity, in percent off that of long waves, against k d, both per undeformed length. Dashed: exact "
         "dispersion of the lattice; dotted: closed formula of the gradient continuum; circles: measured in a run of "
         "the lattice; solid with crosses: finite elements. Right: relative difference from the exact dispersion, "
         "triangles longitudinal, circles shear; the order is the slope over the half of the points with the "
         "smallest k d."),
    Plot("attenuation", "wave-speeds", draw_attenuation,
         "Dashpots on the bonds and the viscosity of the continuum let waves die out at the same rate.",
         "Decay rate γ and frequency ω of damped waves against k d, a colour for each multiple of the dashpots' "
         "viscosity. Dashed: theory; circles: measured in a run of the lattice; plus signs: continuum; crosses: "
         "finite elements. Right: distance from the theory in the complex plane, |Δω + iΔγ| over |ω + iγ|."),
    Plot("dispersion", "intrinsic-length", draw_dispersion,
         "It shows in waves, whose speed falls as c (1 − α (k d)²/2), k the wave number, with α depending on "
         "direction.",
         "α of ω² = c² k² (1 − α (k d)²) against the direction of the wave. Dashed: from the exact dispersion; "
         "dotted: the part that nearest bonds contribute; dash-dotted: what an isotropic gradient energy can have; "
         "circles: fitted to runs of the lattice in time."),
    Plot("edge_layer", "intrinsic-length", draw_edge_layer,
         "It shows at free edges, where rows stand off their bulk spacing if there are next-nearest bonds, and only "
         "then.",
         "Distance between rows near a free edge, relative to that in the bulk, in a stretched sheet; full where "
         "it is wider, open where it is narrower. Dashed: theory; circles: relaxed lattice."),
    Plot("hole", "prestretch", draw_hole,
         "Around a hole, where the deformation varies, they differ by a power of d over its radius.",
         "Stretched sheets with a round hole of radius R: relative differences between finite elements and lattice "
         "against d/R, a line for each law of the finite elements. The order is the slope of a line."),
    Plot("notch", "prestretch", draw_notch,
         "At a notch they differ by a power of d over its length.",
         "Stretched sheets with a notch: relative differences between finite elements and lattice against d over "
         "its length, a line for each law of the finite elements. The order is the slope of a line."),
    Plot("running_crack", "running-crack", draw_running_crack,
         "The pictures show what the lattice has near the tip, and what the continua with and without gradient energy "
         "have of it.",
         "Fields around the tip of a driven crack in the reference configuration, mean of four samples: lattice, network "
         "continuum, and the same with gradient energy and micro-inertia, with one scale of colours for each row. Blue "
         "ahead of the tip: material that moves against the crack."),
)


def heading(claim):
    """Heading of a claim's section."""
    return CLAIMS[claim][0] if claim in CLAIMS else claim


def explanation(claim, drawn):
    """What a claim says, given the names of the plots that were drawn; empty for one that is not known here."""
    parts = [CLAIMS[claim][1]] if claim in CLAIMS else []
    return " ".join(parts + [plot.claimed for plot in PLOTS if plot.claim == claim and plot.name in drawn])
