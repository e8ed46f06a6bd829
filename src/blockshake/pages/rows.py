"""Which markers of a structure are drawn and tabled, and in which order."""

import numpy as np

from blockshake.measurement.motion.joints import find_leaves
from blockshake.measurement.sensors.markers import block_markers


def face_markers(structure):
    """One marker a block, from the top block down: body to marker, as of `block_markers`."""
    chosen = block_markers(structure)
    height = dict(zip(structure.body_names, structure.position[:, 2], strict=True))
    return dict(sorted(chosen.items(), key=lambda item: -round(height[item[0]], 3)))


def top_markers(structure):
    """Marker of the highest block that has one in every leaf of `find_leaves`: body to marker, as of `face_markers`."""
    leaf_of, tops = {body: name for name, leaf in find_leaves(structure).items() for body in leaf}, {}
    for body, marker in face_markers(structure).items():
        tops.setdefault(leaf_of[structure.body_names.index(body)], (body, marker))
    return dict(tops.values())


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
