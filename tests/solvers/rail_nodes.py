"""LS-DEM's nodes on two rails: a block bears where rigid bodies bear that pivot, on the edges of its flats."""

import numpy as np

from blockshake.geometry.surface_nodes import box_nodes

FLAT = 0.76  # m, width of the flats of the columns' blocks
INSET = 0.003 * FLAT  # m, of the pivots of all shapes


def rail_nodes(size, chamfer, hollow, spacing, _):
    """Nodes of `box_nodes`, of those below and above the two outermost rows along y alone.

    They share the area of the whole face, so that its stiffness in compression is kept. A face of such nodes
    is hollow, as the four contact points of nonsmooth contact dynamics are; a whole face has another impact
    (docs/theory/rocking.md, *Why 0.86 and not 0.71*).
    """
    points, areas = box_nodes(size, chamfer, hollow, spacing, INSET / (min(size[:2]) - 2.0 * chamfer))
    level = np.isclose(np.abs(points[:, 2]), 0.5 * size[2])
    kept = ~level | np.isclose(np.abs(points[:, 0]), 0.5 * size[0] - chamfer - INSET)
    areas = np.where(level, areas * areas[level].sum() / areas[level & kept].sum(), areas)
    return points[kept], areas[kept]
