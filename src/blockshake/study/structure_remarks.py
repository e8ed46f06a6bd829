"""Content of a structure as it was understood, and remarks where that is perhaps not what was meant."""

from collections import Counter

import numpy as np

from blockshake.geometry.rotations import rotation_matrices
from blockshake.quantities import PHYSICAL, USUAL
from blockshake.simulation.parameter_table import instances

_FAR = 1e4  # m, from the origin: with some digits of forces lost, docs/contracts.md
_SMALLEST, _LARGEST = (
    0.005,
    25.0,
)  # m, of the longest edge; no block of a structure or of a model test is beyond


def structure_lines(structure):
    """Blocks, their mass, size and slenderness, and the joints of a `Structure`; a list of str."""
    free = np.flatnonzero(~structure.driven)
    alike = Counter(_block_words(structure, body) for body in free)
    joints = np.count_nonzero(np.triu(structure.touching))
    weight = f"{structure.mass[free].sum():.0f} kg in all"
    return [
        f"a structure of {_counted(len(free), 'block')} of {weight}, and {_counted(joints, 'joint')}",
        *(f"  {count} of {words}" for words, count in alike.items()),
    ]


def _counted(number, name):
    return f"{number} {name}{'' if number == 1 else 's'}"


def _block_words(structure, body):
    """Size, mass and slenderness of a block as it stands."""
    solid = structure.solid(body)
    turned = solid.vertices @ rotation_matrices(structure.orientation[body]).T
    length, depth, height = np.ptp(turned, axis=0)
    return (
        f"{length:.3g} x {depth:.3g} x {height:.3g} m, {structure.mass[body]:.0f} kg, "
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


def _held_up(structure):
    """Bodies that a chain of touching bodies joins to a driven one, driven ones with them; all where none is driven."""
    held = structure.driven.copy()
    if not held.any():
        return np.ones_like(held)
    for _ in held:
        held |= structure.touching[held].any(axis=0)
    return held
