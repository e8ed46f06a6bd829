"""The largest stable time step, said before a run needs it."""

import numpy as np
import pytest

from blockshake.solvers.ls_dem.interfaces import damping_ratio
from blockshake.solvers.ls_dem.parameters import LsDemParameters

G = 9.81
K_N = LsDemParameters().normal_stiffness
CUBE = {"name": "b", "shape": "cube", "position": [0.0, 0.0, 0.5]}
# a slab of the cube's plan, so that both sides' nodes see the same area
SLAB = {"slab": {"box": [1.0, 1.0, 0.2]}}


def _limit(restitution, mass=2400.0, area=1.0):
    """One block on its bed, vertical: w = sqrt(k_n A / m), and the scheme's limit for its damping."""
    z = damping_ratio(restitution)
    return 2.0 * (np.sqrt(1.0 + 4.0 * z**2) - 2.0 * z) / np.sqrt(K_N * area / mass)


@pytest.mark.parametrize("restitution", [1.0, 0.5, 0.1, 0.0])
def test_one_block_on_its_bed(restitution, make_structure, run_ls_dem):
    """The root of the scheme's characteristic polynomial is -1 there: h^2 + 8 z h - 4 = 0 for h = w dt."""
    # shear springs so soft that the vertical mode is the fastest
    structure = make_structure([CUBE], shapes=SLAB, restitution=restitution)
    run = run_ls_dem(structure, 0.001, time_step=1e-5, shear_stiffness=1e8)
    # rocking of a cube on a face: w^2 = (k_n A / 12) / (1/6 + 1/4), a fifth of the vertical one's
    assert run.numerics["stable_time_step"] == pytest.approx(_limit(restitution), rel=1e-3)


@pytest.mark.parametrize(("part", "stays"), [(0.97, True), (1.03, False)])
@pytest.mark.parametrize("restitution", [1.0, 0.5, 0.1])
def test_the_limit_is_the_limit(restitution, part, stays, make_structure, run_ls_dem, caplog):
    """A push of 1e-6 m/s dies below the limit and grows above it."""
    structure = make_structure(
        [{**CUBE, "velocity": [0.0, 0.0, -1e-6]}], shapes=SLAB, restitution=restitution
    )
    with caplog.at_level("WARNING"):
        run = run_ls_dem(structure, 0.5, time_step=part * _limit(restitution), shear_stiffness=1e8, rate=50)
    speed = np.abs(run.velocity[-1, 1, 2])
    assert (speed < 1e-4) if stays else (speed > 1e-4)
    assert ("limit of stability" in caplog.text) is not stays
