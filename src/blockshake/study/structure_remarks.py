"""Remarks on a structure that is well formed, but perhaps not what was meant."""

import numpy as np

_LIGHTEST, _HEAVIEST = 100.0, 25000.0  # kg/m3; no block is of less or more
_LARGEST = 50.0  # m, of an edge


def structure_remarks(structure):
    """One sentence for everything about a `Structure` that looks like a slip of the pen; a list of str."""
    remarks = []
    if not structure.driven.any():
        remarks.append("no body is driven: no ground motion acts")
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
