"""NSCD in equilibrium: every body is held by its joints, nothing moves, nothing sinks."""

import numpy as np
import pytest

from blockshake.geometry.structure import load_structure

G = 9.81
TOLERANCE = 1e-8  # default of nscd.tolerance


@pytest.mark.parametrize("configuration", [1, 2, 3, 4])
def test_forces_balance_and_nothing_sinks(configuration, run_nscd):
    """Newton's first law for each body of the shipped structures, redundant supports included."""
    structure = load_structure(f"configuration-{configuration}")
    run = run_nscd(structure, 2.0)
    held = np.zeros((len(run.time), len(structure.mass), 3))
    for joint, (a, b) in enumerate(run.joints):
        held[:, a] -= run.joint_force[:, joint]
        held[:, b] += run.joint_force[:, joint]
    weight = structure.mass[:, None] * np.array([0.0, 0.0, G])
    free = ~structure.driven
    # what the residual leaves of all impulses together; a body's imbalance is its change of velocity, and the
    # stack's weight is carried by a dozen contacts in each of a few joints
    imbalance = 10.0 * TOLERANCE * weight[free].sum()
    assert np.abs(held[:, free] - weight[free]).max() < imbalance
    assert run.numerics["max_penetration"] < 1e-10
    # a residual in every step adds up to g dt times it, over 2 s
    assert np.abs(run.position - run.position[0]).max() < TOLERANCE * G * 1e-3 * 2.0 * 10.0
