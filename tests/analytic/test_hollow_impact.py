"""Impact of hollow faces: less is kept than by flat ones, more than Housner's (1963) edges keep, and why."""

import numpy as np
import pytest
from planar_block import DEPTH, kept_by
from rocking_theory import HALF_WIDTH, H, Rocker

from blockshake.geometry.surface_nodes import line_nodes

INSET, ANGLE, READ = 0.003 * 2.0 * HALF_WIDTH, 0.045, 6e-3  # m, rad, rad past upright
SEAT = {"slab": {"box": [0.8, 2.4, 0.2]}}  # flat, its nodes under the block's own


def _kept(make_structure, run_ls_dem, hollow, spacing=0.2):
    rocker = Rocker(INSET)
    shapes = SEAT | {"sharp": {"box": [2.0 * HALF_WIDTH, DEPTH, 2.0 * H], "hollow": hollow}}
    structure = make_structure([rocker.body(ANGLE)], friction=0.9, restitution=0.5, shapes=shapes)
    run = run_ls_dem(structure, 0.3, rate=2000, time_step=1e-5, node_spacing=spacing)
    return rocker, rocker.kept(run, READ)


@pytest.mark.parametrize("spacing", [0.2, 0.1])
@pytest.mark.parametrize("hollow", [1e-4, 1e-3])
def test_a_second_program_with_the_same_gaps_keeps_the_same(hollow, spacing, make_structure, run_ls_dem):
    """Rows of springs in a plane, each with the gap that the hollow face leaves at its place."""
    rocker, kept = _kept(make_structure, run_ls_dem, hollow, spacing)
    x, width = line_nodes(2.0 * HALF_WIDTH, spacing, INSET)
    y, depth = line_nodes(DEPTH, spacing, INSET)
    across, along = np.meshgrid(x / HALF_WIDTH, 2.0 * y / DEPTH, indexing="ij")
    gap = hollow * (1.0 - across**2) ** 2 * (1.0 - along**2) ** 2
    share = np.outer(width, depth) / DEPTH
    rows = np.repeat(x, y.size)
    expected = kept_by(rocker, rows, share.ravel(), 0.5, ANGLE, READ, gap=gap.ravel())
    assert kept == pytest.approx(expected, abs=1e-3)


def test_deeper_faces_keep_less_and_never_as_little_as_edges(make_structure, run_ls_dem):
    """The rim along the fall lies between the pivots, so that even a deep hollow keeps more than two edges do."""
    kept = [_kept(make_structure, run_ls_dem, hollow)[1] for hollow in (0.0, 1e-4, 1e-3, 3e-3)]
    assert (np.diff(kept) < -0.01).all()
    assert kept[-1] > Rocker(INSET).housner + 0.02
