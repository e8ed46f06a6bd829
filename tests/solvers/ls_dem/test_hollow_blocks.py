"""Stacks of blocks with hollow faces: where they start from, and which model takes notice."""

import numpy as np
import pytest

from blockshake.geometry.structure import load_structure
from blockshake.simulation.models import MODELS

AT_REST = np.array([0.0, 0.05])  # s


def _sink(hollow):
    """How far the top block of configuration 1 sinks at the start [m], and how far it moves at rest [m]."""
    structure = load_structure("configuration-1", {"shapes.block.hollow": hollow})
    run = MODELS["ls-dem"].solve(structure, None, MODELS["ls-dem"].schema(), AT_REST, 5e-5)
    height = run.position[:, -1, 2]
    return structure.position[-1, 2] - height[0], abs(height[1] - height[0])


def test_a_stack_starts_at_rest_whatever_the_hollow():
    """The rim alone bears, so that a deeper hollow lets a stack sink farther, by micrometres."""
    sinks, moved = np.transpose([_sink(hollow) for hollow in (0.0, 3e-5, 1e-4, 1e-3)])
    assert (np.diff(sinks) > 1e-6).all()
    assert sinks[-1] < 1e-4
    assert moved.max() < 1e-12


@pytest.mark.parametrize(
    "model", [name for name, model in MODELS.items() if "hollow" in model.without_effect]
)
def test_models_that_bear_on_corners_take_no_notice(model):
    row = MODELS[model]
    flat, hollow = (
        row.solve(load_structure("configuration-1", changed), None, row.schema(), AT_REST, 1e-3)
        for changed in ({}, {"shapes.block.hollow": 1e-3})
    )
    np.testing.assert_array_equal(flat.position, hollow.position)
