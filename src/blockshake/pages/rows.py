"""Which markers of a structure are drawn and tabled, and in which order."""

import numpy as np

from blockshake.measurement.sensors.markers import block_markers


def face_markers(structure):
    """One marker a block, from the top block down: body to marker, as of `block_markers`."""
    chosen = block_markers(structure)
    height = dict(zip(structure.body_names, structure.position[:, 2], strict=True))
    return dict(sorted(chosen.items(), key=lambda item: -round(height[item[0]], 3)))


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
