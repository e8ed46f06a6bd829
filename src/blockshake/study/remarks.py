"""A structure and a motion as they were understood, and remarks where that is perhaps not what was meant."""

from collections import Counter

import numpy as np

from blockshake.dynamics.intensity import acceleration_segments, motion_figures
from blockshake.dynamics.load_motion import provenance
from blockshake.dynamics.motion import PITCH
from blockshake.geometry.cylinder import prism_errors
from blockshake.geometry.overlap import depths_of_pairs, near_pairs
from blockshake.geometry.rotations import rotation_matrices
from blockshake.geometry.structure import DEEPEST_OVERLAP, START_TOLERANCE
from blockshake.geometry.structure_file import point_remarks
from blockshake.pages.wording import count_words
from blockshake.quantities import PERHAPS, PHYSICAL, USUAL
from blockshake.simulation.models import ignored_by
from blockshake.simulation.parameter_table import instances
from blockshake.simulation.rocking import columns, overhangs

_FAR = 1e4  # m, from the origin: with some digits of forces lost, docs/guide/contracts.md
# m, of the longest edge; no block of a structure or of a model test is beyond
_SMALLEST, _LARGEST = 0.005, 60.0
_ONE_G = 9.81  # m/s2
_WEAKEST, _STRONGEST = 0.5, 30.0  # m/s2, of peak accelerations that move blocks and that were ever recorded
_FARTHEST = 1.0  # m, of a shake table or of the ground
_STEEPEST = 0.05  # rad, of a table
_FASTEST_END = 0.05  # m/s
_LONGEST = 600.0  # s, of a test or of an earthquake
_SHORTEST = 0.1  # s
_OVERHANG = 0.5  # of that at which the mass centre is over the edge
# by kind of motion: its unit, and smaller ones that are perhaps meant
_UNITS = {"acceleration": "m/s2", "velocity": "m/s", "displacement": "m"}
_SMALLER = {"acceleration": "cm/s2 or mm/s2", "velocity": "cm/s or mm/s", "displacement": "mm"}


def structure_lines(structure):
    """Blocks, their mass, size and slenderness, the joints and the columns of a `Structure`; a list of str."""
    free = np.flatnonzero(~structure.driven)
    alike = Counter(_block_words(structure, body) for body in free)
    joints = np.count_nonzero(np.triu(structure.touching))
    weight = f"{_kilograms(structure.mass[free].sum())} in all"
    return [
        f"a structure of {count_words(len(free), 'block')} of {weight}, and {count_words(joints, 'joint')}",
        *(f"  {count} of {words}" for words, count in alike.items()),
        *(_column_words(structure, column) for column in columns(structure) if len(column.bodies) > 1),
        *(
            f"  {name} is a prism of {shape.cylinder.sides} sides: {_prism_words(shape.cylinder.sides)}"
            for name, shape in structure.file.shapes.items()
            if shape.cylinder
        ),
    ]


def _column_words(structure, column):
    """Mass centre of all that stands together, and its height over width."""
    bottom = min(column.bodies, key=lambda body: structure.position[body, 2])
    return (
        f"  {len(column.bodies)} blocks from {structure.body_names[bottom]} up: mass centre at x "
        f"{column.centre[0]:.3g} m, {column.height:.3g} m above the foot, {_slenderness(column.height, column.levers)}"
    )


def _slenderness(height, levers):
    """Height of a mass centre over its distance from the edges along x, which is height over width of a box."""
    with np.errstate(divide="ignore"):
        left, right = (f"{value:.2g}" for value in height / np.maximum(levers, 0.0))
    return f"height over width along x {left}" + (f" to -x and {right} to +x" if left != right else "")


def _prism_words(sides):
    errors = prism_errors(sides)
    return (
        f"the cylinder's volume, its radius {100 * errors.narrow:+.2g} to {100 * errors.wide:+.2g} %, its inertia "
        f"{100 * errors.inertia:+.2g} %; on its side it rolls only above {np.degrees(errors.slope):.2g} degrees"
    )


def _kilograms(mass):
    return f"{mass:.0f} kg" if mass >= 100.0 else f"{mass:.3g} kg"


def _block_words(structure, body):
    """Size, mass and slenderness of a block as it stands, about its mass centre."""
    solid = structure.solid(body)
    turned = solid.vertices @ rotation_matrices(structure.orientation[body]).T
    length, depth, height = np.ptp(turned, axis=0)
    return (
        f"{length:.3g} x {depth:.3g} x {height:.3g} m, {_kilograms(structure.mass[body])}, "
        + _slenderness(-turned[:, 2].min(), np.array([-turned[:, 0].min(), turned[:, 0].max()]))
    )


def structure_remarks(structure):
    """One sentence for everything about a `Structure` that looks like a slip of the pen; a list of str."""
    remarks = []
    if not structure.driven.any():
        remarks.append("no body is driven: no ground motion acts")
    if structure.driven.all():
        remarks.append("all bodies are driven: nothing can move by itself")
    if structure.file.gravity[2] >= 0.0:
        remarks.append(
            f"gravity is {structure.file.gravity[2]:g} m/s2 along z: it does not press blocks down"
        )
    remarks += unusual_values(structure)
    for name, solid in structure.solids.items():
        if solid.polyhedron is None:
            remarks.append(
                f"{name} is not convex: LS-DEM reads it from a lattice of ls_dem.grid_spacing, which rounds off the "
                "edges on which others stand, and a run is not judged for a fall that the window cuts"
            )
    remarks += _misfits(structure)
    remarks += point_remarks(structure)
    farthest = np.abs(structure.position).max()
    if farthest > _FAR:
        remarks.append(
            f"the blocks stand {farthest:.3g} m from the origin, where places have steps of {np.spacing(farthest):.1g} "
            "m: a local origin in whole metres keeps more digits"
        )
    for body, share in overhangs(structure).items():
        if share > _OVERHANG:
            remarks.append(
                f"{structure.body_names[body]} overhangs its support by {share:.0%} of what it may alone"
            )
    held = _held_up(structure)
    for body in np.flatnonzero(~held):
        remarks.append(
            f"{structure.body_names[body]} touches nothing that stands on a driven body: it will fall"
        )
    return remarks


def unusual_values(structure):
    """One sentence for every parameter and every free block of a `Structure` of an unusual size; a list of str."""
    remarks = []
    for quantity in (one for one in PHYSICAL if one.name in USUAL):
        low, high = USUAL[quantity.name]
        for name, value in instances(quantity.name, structure.file):
            if value is not None and not (low <= np.min(value) and np.max(value) <= high):
                shown = f"{value:g}" if isinstance(value, float) else list(value)
                unit = "" if quantity.unit == "1" else f" {quantity.unit}"
                remarks.append(
                    f"{name} is {shown}{unit}: {low:g} to {high:g}{unit} is usual"
                    f"{_perhaps(quantity.name, np.abs(value).max())}"
                )
    for body in np.flatnonzero(~structure.driven):
        edge = np.ptp(structure.solid(body).vertices, axis=0).max()
        if not _SMALLEST <= edge <= _LARGEST:
            remarks.append(
                f"{structure.body_names[body]} is {edge:.3g} m long and weighs {structure.mass[body]:.3g} kg: expected "
                f"m{', perhaps given in mm' if edge > _LARGEST else ''}"
            )
    return remarks


def unused_settings(names, models):
    """One sentence for every parameter, by its dotted name, that one of the models has no use for; a list of str."""
    return [
        f"{name} has no effect on {model}" + (f", which has {instead}" if instead else "")
        for name in names
        for model, instead in ignored_by(name, models).items()
    ]


def _perhaps(name, size):
    """Words on the unit in which a value of a quantity was perhaps given; empty where none fits its size."""
    units = (unit for unit, low, high in PERHAPS.get(name, ()) if low <= size <= high)
    return "".join(f"; perhaps given in {unit}" for unit in units)


def _misfits(structure):
    """Remarks on blocks that stand a little inside others, or a little above them."""
    shapes, solids = [body.shape for body in structure.file.bodies], structure.solids
    centroid, orientation = structure.centroid, structure.orientation

    def depths(pairs, position):
        return depths_of_pairs(pairs, shapes, solids, position, orientation)

    pairs = near_pairs([solids[shape] for shape in shapes], centroid, orientation, DEEPEST_OVERLAP)
    pairs = pairs[~structure.driven[pairs].all(axis=1)]
    depth = depths(pairs, centroid)
    inside = depth > START_TOLERANCE
    if inside.any():
        a, b = (structure.body_names[body] for body in pairs[depth.argmax()])
        yield (
            f"{count_words(np.count_nonzero(inside), 'joint')} overlapping, by up to {1e3 * depth.max():.2g} mm ({a} "
            f"and {b}): a run starts them as they are laid, pressed by the weight alone"
        )
    apart = (depth < -START_TOLERANCE) & (depth > -DEEPEST_OVERLAP)
    # a gap is one to fall through where it closes as the upper body comes down by it
    down = np.array(structure.file.gravity) / max(np.linalg.norm(structure.file.gravity), 1e-300)
    for pair, gap in zip(pairs[apart], -depth[apart], strict=True):
        lower, upper = sorted(pair, key=lambda body: -centroid[body] @ down)
        lowered = centroid.copy()
        lowered[upper] += gap * down
        if depths(pair[None], lowered)[0] > -0.1 * START_TOLERANCE:
            names = structure.body_names
            yield f"{names[upper]} is {1e3 * gap:.2g} mm above {names[lower]}: it falls unless another block holds it"


def _held_up(structure):
    """Bodies that a chain of touching bodies joins to a driven one, driven ones with them; all where none is driven."""
    held = structure.driven.copy()
    if not held.any():
        return np.ones_like(held)
    for _ in held:
        held |= structure.touching[held].any(axis=0)
    return held


def motion_line(motion):
    """Duration, kind, peaks along the axes that move, pitch and provenance of a `GroundMotion`, in one line."""
    places = motion.evaluate(motion.table.breaks)
    axes = [axis for axis, place in zip("xyz", places.T, strict=False) if np.ptp(place) > 0.0] or ["x"]
    words = []
    for axis in axes:
        peaks = motion_figures(motion, axis)
        most = peaks["peak_acceleration"], peaks["peak_velocity"], peaks["peak_displacement"]
        words.append("peaks along {}: {:.3g} m/s2, {:.3g} m/s, {:.3g} m".format(axis, *most))
    if places[:, PITCH].any():
        words.append(f"pitch up to {np.abs(places[:, PITCH]).max():.3g} rad")
    return (
        f"a motion of {motion.duration:g} s, given as {motion.kind}; {'; '.join(words)}; "
        f"{provenance(motion.attributes)}"
    )


def motion_remarks(motion):
    """One sentence for everything about a `GroundMotion` that looks like a slip of the pen; a list of str."""
    remarks = [motion.attributes["gaps"]] if "gaps" in motion.attributes else []
    ends = [end for axis in "xyz" for end in acceleration_segments(motion, axis)[1:]]
    peak = float(max(np.abs(end).max() for end in ends))
    shift = motion.evaluate(motion.table.breaks) - motion.evaluate(motion.table.breaks[:1])
    moved, pitched = float(np.abs(shift[:, :PITCH]).max()), float(np.abs(shift[:, PITCH]).max())
    strength = f"the peak acceleration is {peak / _ONE_G:.2g} g"
    if motion.first_pitch != 0.0:
        remarks.append(
            f"the table starts turned by {motion.first_pitch:.2g} rad, and all that stands on it with it"
        )
    elif peak == 0.0 and pitched == 0.0:
        remarks.append("nothing moves")
    if 0.0 < peak < _WEAKEST:
        meant = "expected m/s2, not g" if motion.kind == "acceleration" else "it moves no block"
        remarks.append(f"{strength}: {meant}")
    if peak > _STRONGEST:
        remarks.append(f"{strength}: expected {_UNITS[motion.kind]}, not {_SMALLER[motion.kind]}")
    end = float(np.abs(motion.evaluate(motion.table.breaks[-1:], derivative=1)[0, :PITCH]).max())
    if end > _FASTEST_END and peak <= _STRONGEST:
        remarks.append(f"the ground still moves at {end:.2g} m/s at the end: an offset of the {motion.kind}?")
    if moved > _FARTHEST:
        remarks.append(f"the ground moves by {moved:.3g} m")
    if pitched > _STEEPEST:
        remarks.append(f"the table pitches by {pitched:.2g} rad, {np.degrees(pitched):.2g} degrees")
    if motion.duration > _LONGEST:
        remarks.append(f"the motion lasts {motion.duration:.0f} s: expected s, not ms")
    if motion.duration < _SHORTEST:
        remarks.append(f"the motion lasts {motion.duration:.2g} s: were its times in s already?")
    return remarks
