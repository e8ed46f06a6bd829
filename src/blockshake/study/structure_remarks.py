"""Content of a structure as it was understood, and remarks where that is perhaps not what was meant."""

from collections import Counter

import numpy as np

from blockshake.geometry.rotations import rotation_matrices
from blockshake.geometry.structure_file import point_remarks

_LIGHTEST, _HEAVIEST = 100.0, 25000.0  # kg/m3; no block is of less or more
_LARGEST = 50.0  # m, of an edge
_SOFTEST = 1e7  # Pa, of rubber; no block is softer


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
    for name, material in structure.file.materials.items():
        if material.youngs_modulus < _SOFTEST:
            remarks.append(f"{name} has a Young's modulus of {material.youngs_modulus:.3g} Pa: expected Pa")
    remarks += point_remarks(structure)
    held = _held_up(structure)
    for body in np.flatnonzero(~held):
        remarks.append(
            f"{structure.body_names[body]} touches nothing that stands on a driven body: it will fall"
        )
    for body in np.flatnonzero(~structure.driven):
        name, solid = structure.body_names[body], structure.solid(body)
        density = structure.mass[body] / solid.properties.volume
        if not _LIGHTEST <= density <= _HEAVIEST:
            remarks.append(
                f"{name} weighs {structure.mass[body]:.3g} kg, {density:.3g} kg/m3: expected kg/m3"
            )
        edge = np.ptp(solid.vertices, axis=0).max()
        if edge > _LARGEST:
            remarks.append(
                f"{name} is {edge:.3g} m long and weighs {structure.mass[body]:.3g} kg: expected m"
            )
    return remarks


def _held_up(structure):
    """Bodies that a chain of touching bodies joins to a driven one, driven ones with them; all where none is driven."""
    held = structure.driven.copy()
    if not held.any():
        return np.ones_like(held)
    for _ in held:
        held |= structure.touching[held].any(axis=0)
    return held
