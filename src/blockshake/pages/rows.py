"""Which markers of a structure are drawn and tabled, and in which order."""

import numpy as np

from blockshake.measurement.sensors.markers import block_markers


def face_markers(structure):
    """One marker a block, from the top block down: body to marker, as of `block_markers`."""
    chosen = block_markers(structure)
    height = dict(zip(structure.body_names, structure.position[:, 2], strict=True))
    return dict(sorted(chosen.items(), key=lambda item: -round(height[item[0]], 3)))


def main_bodies(structure, bodies, most=4):
    """Bodies for a figure of few rows, from the top down: all, or of each stack every second one from its top.

    ``most``: rows up to which all are shown.
    """
    bodies = list(bodies)
    if len(bodies) <= most:
        return bodies
    places = np.round(structure.position, 2)
    stacks = {}
    for body in bodies:
        index = structure.body_names.index(body)
        stacks.setdefault(tuple(places[index, :2]), []).append(body)
    return [body for stack in stacks.values() for body in stack[::2]]


def bodies_by_height(structure, bodies, most=5):
    """One body of each height, from the lowest up: in two equal walls those of the first.

    ``bodies`` from the top down. Of more than ``most``, the lowest, the highest and those evenly between.
    """
    heights = {}
    for body in bodies:
        height = round(float(structure.position[structure.body_names.index(body), 2]), 3)
        heights.setdefault(height, body)
    chosen = [heights[height] for height in sorted(heights)]
    places = np.unique(np.linspace(0, len(chosen) - 1, min(most, len(chosen))).round().astype(int))
    return [chosen[place] for place in places]
