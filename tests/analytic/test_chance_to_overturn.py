"""The chance that a block of uncertain width overturns under a pulse of uncertain strength, against theory."""

import numpy as np
from overturning_theory import AFTER, pulse
from rocking_theory import G, Rocker, rock

import blockshake
from blockshake.dynamics.motion import ground_motion

FREQUENCY, SIZE = 1.0, 24  # Hz, samples
UNCERTAIN = {
    "shapes.sharp.box.x": {"mean": 0.8, "cov": 0.05},
    "motion.scale": {"distribution": "uniform", "loc": 0.45, "scale": 0.5},  # of a pulse of 1 g
}
NEAR = 0.015  # of the amplitude; nearer to a limit a run may be on its other side


def falls(width, amplitude):
    """Whether the rigid block overturns, by event-driven integration of Housner's equation."""
    rocker = Rocker(0.0, width)
    time, a = pulse(FREQUENCY, amplitude * G)
    return rock(rocker, lambda t: np.interp(t, time, a), 1.0 / FREQUENCY + AFTER, rocker.housner)[0]


def test_the_chance_is_that_of_direct_integration(make_mapping):
    time, a = pulse(FREQUENCY, G)
    motion = ground_motion("cycle", time, {"x": a}, "acceleration")
    mapping = make_mapping(
        [{"name": "b", "shape": "sharp", "on": "slab"}],
        friction=3.0,
        shapes={"slab": {"box": [6.0, 6.0, 0.2]}},
    )
    design = blockshake.draw_samples(SIZE, 1, UNCERTAIN).values
    seen, expected, sure = [], [], []
    for _, row in design.iterrows():
        width, amplitude = row["shapes.sharp.box.x"], row["motion.scale"]
        run = blockshake.simulate(
            mapping,
            motion,
            "nscd-rigid",
            {"shapes.sharp.box.x": float(width)},
            time_step=2e-4,
            scale=float(amplitude),
            duration=1.0 / FREQUENCY + AFTER,
            output_rate=50.0,
        )
        seen.append(run.attrs["status"] in ("collapsed", "falling"))
        about = [falls(width, part * amplitude) for part in (1.0 - NEAR, 1.0, 1.0 + NEAR)]
        expected.append(about[1])
        sure.append(len(set(about)) == 1)
    seen, expected, sure = (np.array(one) for one in (seen, expected, sure))
    assert sure.sum() >= 0.8 * SIZE
    np.testing.assert_array_equal(seen[sure], expected[sure])
    assert 0.2 < expected.mean() < 0.8
    assert abs(seen.mean() - expected.mean()) <= (~sure).mean()
