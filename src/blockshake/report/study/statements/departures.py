"""Departures from the paper, and choices that it leaves open: numbers are those of the program's own constants."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from blockshake.files import HOME, load_yaml
from blockshake.geometry.reference_block import reference_block
from blockshake.geometry.structure import load_structure
from blockshake.report.document.units import quantity
from blockshake.report.document.wording import given, model_label, number, percent
from blockshake.report.study.statements.ls_dem import rebound_without_pull
from blockshake.simulation.models import MODELS
from blockshake.solvers.ls_dem.interfaces import damping_ratio
from blockshake.solvers.ls_dem.parameters import LsDemParameters
from blockshake.solvers.nscd.parameters import NscdParameters
from blockshake.solvers.nscd_deformable.parameters import DeformableParameters
from blockshake.study.ensembles.ensemble import RESIDUAL_WINDOW
from blockshake.study.sampling.distributions import LINKED, TABLE_2
from blockshake.study.stiffness.wave_step import STEP_VELOCITY


class Departure(NamedTuple):
    """One departure.

    Attributes
    ----------
    topic : str
    printed : str
        The paper's choice, in the words of this program.
    here : callable
        Gives the choice of this program in words.
    page : str
        Where the reasons stand.
    """

    topic: str
    printed: str
    here: Callable
    page: str


def _words(text):
    """Choice without a number."""
    return lambda: text


def _pivot():
    structure, share = load_structure("configuration-1"), LsDemParameters().perimeter_inset
    block = reference_block(structure)
    chamfer = structure.file.shapes[structure.file.bodies[block.body].shape].chamfer
    edge = 0.5 * float(block.size[0])
    inset = share * 2.0 * (edge - chamfer)
    return (
        f"The outermost nodes lie {given(1e2 * share)} % of a flat's width inside the flat. A block of "
        f"{given(2.0 * edge)} m with a chamfer of {given(1e3 * chamfer)} mm pivots "
        f"{number(1e3 * (edge - chamfer - inset))} mm from its middle."
    )


def _no_pull():
    restitution = load_structure("configuration-1").file.restitution
    rebound = rebound_without_pull(damping_ratio(restitution))
    return (
        f"The force is cut at zero. A flat impact at C_res {given(restitution)} rebounds at {number(rebound)} of its "
        "velocity."
    )


def _logarithm():
    """Ratio of the damping to the critical one by (ln C_res)^2, and by ln(C_res^2) as printed."""
    restitution = load_structure("configuration-1").file.restitution
    decay = -np.log(restitution)
    return (
        f"Read as (ln C_res)^2, as the restitution asks for: {number(damping_ratio(restitution))} of the critical "
        f"damping for C_res {given(restitution)}, where ln(C_res^2) gives "
        f"{number(decay / np.sqrt(np.pi**2 - 2.0 * decay))}."
    )


def _poisson():
    materials = load_structure("configuration-4").file.materials
    told = ", ".join(f"{given(materials[name].poisson_ratio)} for {name}" for name in ("concrete", "steel"))
    ratio = 1.0 / (2.0 + 2.0 * materials["concrete"].poisson_ratio)
    return f"Taken as {told}; G is then {number(ratio)} times E of concrete."


def _lying():
    structure = load_structure("configuration-4")
    file, block = structure.file, reference_block(structure)
    own = file.materials[file.bodies[block.body].material].youngs_modulus / float(block.size[2])

    def stiffer(name):
        body = next(one for one in file.bodies if one.name == name)
        modulus, height = file.materials[body.material].youngs_modulus, file.shapes[body.shape].box[2]
        return modulus / height / own, modulus / float(block.size[2]) / own

    (top, top_here), (beam, beam_here) = stiffer("top"), stiffer("beam-1")
    return (
        f"A body's stiffness per area follows the modulus and not its own height: a lying block has "
        f"{number(top_here)} and a beam {number(beam_here)} times that of the upright blocks, where E/h would give "
        f"{number(top)} and {number(beam)} times."
    )


def _beams():
    structure = load_structure("configuration-4")
    index = structure.body_names.index("beam-1")
    box = structure.file.shapes["beam"].box
    share = structure.mass[index] / structure.mass[structure.body_names.index("top")]
    return (
        f"Solid bars of {' x '.join(map(given, box))} m, {number(structure.mass[index])} kg each, {percent(share)} % "
        "of the top block."
    )


def _study():
    return load_yaml(HOME / "config" / "study.yaml")


def _steps():
    own, study = MODELS["ls-dem"].time_step, _study()["models"]["ls-dem"]["time_step"]
    return f"{given(study)} s in config/study.yaml; {given(own)} s in config/paper.yaml and where nothing is said."


def _parts():
    parts = _study()["models"]["nscd-rigid"]["parameters"]["nscd.impact_parts"]
    return (
        f"A step in which rigid bodies meet is taken in {parts} parts in config/study.yaml and config/paper.yaml, in "
        f"{NscdParameters().impact_parts} where nothing is said and by deformable blocks."
    )


def _solver():
    own = NscdParameters()
    return (
        "Newton's method first, nonlinear Gauss-Seidel where it fails; relative residual "
        f"{given(own.tolerance)}, at most {own.max_iterations} iterations."
    )


def _deformable():
    own = DeformableParameters()
    return (
        f"Shapes of the full mesh are reduced to static ones and {own.modes} modes; contact points are at most "
        f"{given(own.contact_spacing)} m apart; the deformation has theta {given(own.elastic_theta)}."
    )


def _inputs():
    commanded = [
        case["structure"] for case in load_yaml(HOME / "config" / "paper.yaml")["cases"] if "input" in case
    ]
    words = f" Commanded in config/paper.yaml: {', '.join(commanded)}." if commanded else ""
    return (
        "Displacement of the slab along x with its accelerometer, along y and z, and pitch, each smoothed by itself "
        f"and drawn anew for each sample from its uncertainty.{words}"
    )


def _shaking():
    told = sorted({f"{case['motion']} at {given(case['scale'])}" for case in _study()["cases"]})
    return f"{', '.join(told)}, the strongest of that motion in the shipped campaign that is not sealed."


def _levels():
    rise = load_yaml(HOME / "config" / "virtual-campaign.yaml")["intensities"]["increment"]
    return (
        f"The simulated ladder rises by {percent(_study()['ladder']['increment'])} %, the shipped synthetic tests by "
        f"{percent(rise)} %."
    )


def _strata():
    size = _study()["ensemble"]["size"]
    short = []
    for one in TABLE_2.values():
        values = one.stratum_medians(size)
        short.append(1.0 - values.std() / values.mean() / one.cov)
    return (
        f"Each stratum has its median: the coefficients of variation of {size} samples fall short by "
        f"{percent(min(short))} to {percent(max(short))} %."
    )


def _linked():
    return f"{len(LINKED)} further parameters take sampled values: {', '.join(LINKED)}."


def _search():
    told = []
    for name in ("study", "paper"):
        own = load_yaml(HOME / "config" / f"{name}.yaml")["calibration"]
        models = " and ".join(map(model_label, own["cases"]))
        told.append(f"{own['size']} samples of every open test by {models} in config/{name}.yaml")
    return f"One hypercube, even between its ends: {'; '.join(told)}."


def _fewer():
    told = [
        f"{count} of {case['structure']} by {model_label(model)}"
        for case in _study()["cases"]
        for model, count in case.get("samples", {}).items()
    ]
    window = sorted({case["duration"] for case in _study()["cases"]})
    return (
        f"In config/study.yaml windows of {', '.join(map(given, window))} s and fewer samples, the first rows of the "
        f"whole design: {', '.join(told)}."
    )


def _defaults():
    own = MODELS["ls-dem"].stiffness_of(load_structure("configuration-1"))
    k_n, k_s = (quantity(own[f"ls_dem.{one}_stiffness"], "N/m3") for one in ("normal", "shear"))
    steps = ", ".join(
        f"{given(MODELS[name].time_step)} s for {model_label(name)}" for name in ("ls-dem", "nscd-rigid")
    )
    return (
        f"`blockshake simulate` and the nominal model of a diagnosis take stiffness from E/h and G/h of the "
        f"structure's own block, not from a wave test (configuration-1: k_n {k_n} and k_s {k_s}), and steps of {steps}."
    )


_METHOD, _NSCD = "docs/method.md", "docs/nscd.md"
DEPARTURES = (
    Departure("LS-DEM", "The nodes of one block look for contact with the other.",
              _words("Each pair is checked both ways, and each side has half of the stiffness; of a block on the "
                     "slab the block's own nodes carry all."), _METHOD),
    Departure("LS-DEM", "A node stands for its part of its own surface.",
              _words("Where flats overlap in part, the nodes of both integrate over the overlap."),
              "docs/decisions/0013-areas-of-a-joint.md"),
    Departure("LS-DEM", "k_n and k_s of a block, at each node.", _words("k_n and k_s per area."),
              "docs/decisions/0001-stiffness-per-area.md"),
    Departure("LS-DEM", "Nodes cover the surface, chamfer included.", _pivot, _METHOD),
    Departure("LS-DEM", "Nothing is said of the start.",
              _words("LS-DEM and deformable blocks start from a computed state of rest; rigid blocks start as given, "
                     "unless a joint is soft."), _METHOD),
    Departure("LS-DEM", "Eq. (3) with the mass of the block, at each node.",
              _words("One dashpot for the interface, with the reduced mass of the two bodies."), _METHOD),
    Departure("LS-DEM", "ln C_res^2 in Eq. (3).", _logarithm, _METHOD),
    Departure("LS-DEM", "Eq. (2), which can pull.", _no_pull, _METHOD),
    Departure("LS-DEM", "Eq. (4) adds k_s v dt along the tangential velocity.",
              _words("The sign is read as opposing the velocity."), _METHOD),
    Departure("LS-DEM", "The distance on a lattice.", _words("The distance to a box by its formula."), _METHOD),
    Departure("LS-DEM", "Steps of 1e-5 s.", _steps, _METHOD),
    Departure("Stiffness", "No Poisson's ratio is stated.", _poisson, _METHOD),
    Departure("Stiffness", "Waves are read at a similar velocity of all blocks.",
              _words("Waves are read at half of the step's velocity."), "docs/uncertainty.md"),
    Departure("Stiffness", "A unit step of velocity is given to the ground of the tower.",
              lambda: f"The step has {given(STEP_VELOCITY)} m/s, so that no joint opens; shear waves are sent with the "
                      "blocks' rotations blocked and a friction at which no joint slips.", "docs/uncertainty.md"),
    Departure("Stiffness", "Nothing is said of lying blocks and beams.", _lying, _METHOD),
    Departure("Structures", "The section of the steel beams is not stated.", _beams,
              "config/structures/configuration-4.yaml"),
    Departure("Structures", "Stoppers and retaining systems stand around the specimens.",
              _words("Not in the structure files: their places and gaps are not published."),
              "config/structures/configuration-1.yaml"),
    Departure("Structures", "Width and length of the blocks, the direction of shaking over them, slab, gap of the "
                            "walls and places of sensors are not stated.",
              _words("Inferred; each structure file marks them."), "config/structures/configuration-1.yaml"),
    Departure("NSCD", "Steps are taken whole.", _parts, _NSCD),
    Departure("NSCD", "Nonlinear Gauss-Seidel.", _solver, _NSCD),
    Departure("NSCD", "Contact areas are shrunk by an amount not stated.",
              lambda: f"Drawn in by {given(NscdParameters().shrink)} where nothing is said.", _NSCD),
    Departure("NSCD", "Velocities of contacts at the detected configuration.",
              _words("Lever arms of the middle of the step, without which rocking gains energy."), _NSCD),
    Departure("NSCD", "Surface nodes of deformable blocks.", _deformable, "docs/nscd-deformable.md"),
    Departure("NSCD", "A viscous modulus in Pa.", _words("Read as Pa s."), "docs/nscd-deformable.md"),
    Departure("Input", "Displacement of the slab's marker, differentiated.", _inputs,
              "docs/decisions/0009-measured-input.md"),
    Departure("Input", "Recorded ground motions and measured tests.",
              _words("Those that ship are synthetic; records and tests of a user take their place."),
              "docs/motions.md"),
    Departure("Input", "Record and level of Figs. 11 to 14 are not stated.", _shaking, "docs/configuration.md"),
    Departure("Input", "Tests start at 50 % and rise by about 25 %.", _levels, "docs/campaigns.md"),
    Departure("Input", "Mass centres of the models are plotted beside face markers.",
              _words("The models are read at the markers."), "docs/sampling.md"),
    Departure("Statistics", "The values of the strata are not stated.", _strata, "docs/sampling.md"),
    Departure("Statistics", "Correlations are not stated.", _words("None, unless the configuration gives some."),
              "docs/sampling.md"),
    Departure("Statistics", "Slab, and steel on steel and on the slab, are not in Table 2.", _linked,
              "docs/configuration.md"),
    Departure("Statistics", "The mean friction is drawn at random from 0.3 to 0.8, with 50 samples by both models.",
              _search, "docs/calibration.md"),
    Departure("Statistics", "The mean friction whose envelope contains the test.",
              _words("The friction has the lowest continuous ranked probability score of the samples near it, and a "
                     "range that holds the truth in 95 % of campaigns."), "docs/calibration.md"),
    Departure("Statistics", "Envelopes are held against the tests by eye.",
              _words("Coverage stands beside that of each sample by the others, with a distance and its chance."),
              "docs/sampling.md"),
    Departure("Statistics", "Envelopes are the largest and the smallest of all samples.",
              _words("Thickness is the standard deviation over samples and time, or the mean difference of two "
                     "samples, which hang less on single samples and on their number."), "docs/sampling.md"),
    Departure("Statistics", "Displacements are absolute.",
              _words("Envelopes and their widths, peaks and distances are relative to the slab; the absolute ones "
                     "stand beside them."), "docs/sampling.md"),
    Departure("Statistics", "Nothing is said of a run that ends in a collapse.",
              _words("A run ends at its collapse and counts as one that is over every limit; one that still falls as "
                     "its window ends counts so too."), "docs/sampling.md"),
    Departure("Statistics", "Residual displacements after a test.",
              lambda: f"The mean over the last {given(RESIDUAL_WINDOW)} s of the window, at which blocks may still "
                      "rock.", "docs/sampling.md"),
    Departure("Statistics", "50 samples over whole records.", _fewer, "docs/configuration.md"),
    Departure("Defaults", "Calibrated stiffness everywhere.", _defaults, _METHOD),
)  # fmt: skip
