"""Noise of the slab's pose: a rest of half a second tells it within a third, the markers' noise better."""

import numpy as np
import pytest
from known_blocks import readings, stack

from blockshake.diagnosis.evidence.slab_motion import explain_slab, slab_motion
from blockshake.forces.seen.reconstructed_test import reconstruct_test
from blockshake.measurement.campaigns.campaign import Sensors

NOISE = 3e-4  # m


def moved(t):
    """A table that moves along x alone."""
    own = max(t - 0.6, 0.0)
    return 0.05 * np.sin(np.pi * own) ** 3 if own < 4.0 else 0.0


@pytest.mark.parametrize("seed", [0, 1, 2, 3])
def test_a_rest_that_is_quiet_by_chance_is_no_vertical_motion(seed):
    structure = stack(1)
    read = readings(
        structure, lambda t: np.array([[moved(t), 0.0, 0.0], [moved(t), 0.0, 0.0]]), NOISE, 0.02, seed
    )
    # the markers of the slab say a third of their noise while the table rests
    own = [str(name).startswith("slab") for name in read["marker"].values]
    read["marker_displacement"][dict(time=slice(0, 120), marker=own)] /= 3.0
    seen = reconstruct_test("still", read, structure, Sensors(marker_noise=NOISE, accelerometer_noise=0.02))
    slab = slab_motion(seen)
    moving = seen.motion.time > 0.7
    assert slab.lift_noise == pytest.approx(slab.lift[moving].std(), rel=0.25)
    assert slab.turn_noise == pytest.approx(slab.turn[moving].std(), rel=0.25)
    assert explain_slab([slab])["vertical-motion"].gain < 0.0
