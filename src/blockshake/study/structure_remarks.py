"""Content of a structure as it was understood, and remarks where that is perhaps not what was meant."""

from collections import Counter

import numpy as np

from blockshake.geometry.overlap import depths_of_pairs, near_pairs
from blockshake.geometry.rotations import rotation_matrices
from blockshake.geometry.structure import DEEPEST_OVERLAP, START_TOLERANCE
from blockshake.geometry.structure_file import point_remarks
from blockshake.quantities import PHYSICAL, USUAL
from blockshake.simulation.parameter_table import instances

_FAR = 1e4  # m, from the origin: with some digits of forces lost, docs/guide/contracts.md
_SMALLEST, _LARGEST = (
    0.005,
    25.0,
)  # m, of the longest edge; no block of a structure or of a model test is beyond


def structure_lines(structure):
    """Blocks, their mass, size and slenderness, and the joints of a `Structure`; a list of str."""
    free = np.flatnonzero(~structure.driven)
    alike = Counter(_block_words(structure, body) for body in free)
    joints = np.count_nonzero(np.triu(structure.touching))
    weight = f"{_kilograms(structure.mass[free].sum())} in all"
    return [
        f"a structure of {_counted(len(free), 'block')} of {weight}, and {_counted(joints, 'joint')}",
        *(f"  {count} of {words}" for words, count in alike.items()),
    ]


def _kilograms(mass):
    return f"{mass:.0f} kg" if mass >= 100.0 else f"{mass:.3g} kg"


def _counted(number, name):
    return f"{number} {name}{'' if number == 1 else 's'}"


def _block_words(structure, body):
    """Size, mass and slenderness of a block as it stands."""
    solid = structure.solid(body)
    turned = solid.vertices @ rotation_matrices(structure.orientation[body]).T
    length, depth, height = np.ptp(turned, axis=0)
    return (
        f"{length:.3g} x {depth:.3g} x {height:.3g} m, {_kilograms(structure.mass[body])}, "
        f"height over width {height / min(length, depth):.2g}"
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
    held = _held_up(structure)
    for body in np.flatnonzero(~held):
        remarks.append(
            f"{structure.body_names[body]} touches nothing that stands on a driven body: it will fall"
        )
    for body in np.flatnonzero(~structure.driven):
        name, solid = structure.body_names[body], structure.solid(body)
        edge = np.ptp(solid.vertices, axis=0).max()
        if not _SMALLEST <= edge <= _LARGEST:
            remarks.append(
                f"{name} is {edge:.3g} m long and weighs {structure.mass[body]:.3g} kg: expected m"
            )
    return remarks


def unusual_values(structure):
    """One sentence for every parameter of a `Structure` beyond the values that are usual; a list of str."""
    remarks = []
    for quantity in (one for one in PHYSICAL if one.name in USUAL):
        low, high = USUAL[quantity.name]
        for name, value in instances(quantity.name, structure.file):
            if value is not None and not (low <= np.min(value) and np.max(value) <= high):
                shown = f"{value:g}" if isinstance(value, float) else list(value)
                unit = "" if quantity.unit == "1" else f" {quantity.unit}"
                remarks.append(f"{name} is {shown}{unit}: {low:g} to {high:g}{unit} is usual")
    return remarks


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
            f"{_counted(np.count_nonzero(inside), 'joint')} overlapping, by up to {1e3 * depth.max():.2g} mm ({a} and "
            f"{b}): a run starts them as they are laid, pressed by the weight alone"
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
