import numpy as np
import pytest
from dashpot_theory import rebound, rebound_error

from blockshake.solvers.ls_dem.interfaces import damping_ratio
from blockshake.solvers.ls_dem.parameters import LsDemParameters

SPEED = 0.1  # m/s, downwards; gravity off, so that the theory is a spring and a dashpot alone
STEP = 2e-6  # s
OMEGA_DT = STEP * np.sqrt(LsDemParameters().normal_stiffness * 0.76 * 2.36 / 7364.0)  # of a block on its face


def test_the_ends_of_the_damping_ratio():
    assert damping_ratio(1.0) == 0.0
    assert damping_ratio(0.0) == 1.0
    assert damping_ratio(0.5) == pytest.approx(np.log(2.0) / np.sqrt(np.pi**2 + np.log(2.0) ** 2), rel=1e-15)


def _fall(make_structure, run_ls_dem, restitution, **parameters):
    body = {"name": "b", "shape": "block", "position": [0.0, 0.0, 0.8 + 1e-5], "velocity": [0.0, 0.0, -SPEED]}
    structure = make_structure([body], restitution=restitution, gravity=[0.0, 0.0, 0.0])
    run = run_ls_dem(structure, 0.01, time_step=STEP, **parameters)
    # straight up: nothing turned or went sideways
    assert np.abs(run.angular_velocity[-1]).max() < 1e-9
    assert np.abs(run.velocity[-1, 1, :2]).max() < 1e-9
    return run.velocity[-1, 1, 2] / SPEED


@pytest.mark.parametrize("spacing", [0.1, 0.2, 0.8])
@pytest.mark.parametrize("restitution", [0.5, 1.0])
def test_a_block_falling_flat_rebounds_by_the_theory(restitution, spacing, make_structure, run_ls_dem):
    """Eq. (2) without pulling on a face of 9 to 225 nodes: the interface's law, not the nodes'."""
    expected = rebound(damping_ratio(restitution))
    found = _fall(make_structure, run_ls_dem, restitution, node_spacing=spacing)
    assert found == pytest.approx(expected, abs=rebound_error(damping_ratio(restitution), OMEGA_DT))


def test_critical_damping_barely_rebounds(make_structure, run_ls_dem):
    """C_res = 0: zeta = 1; cut at zero it leaves exp(-2) of the speed where x + 2 x' = 0."""
    expected = rebound(1.0)
    assert expected == pytest.approx(np.exp(-2.0), rel=1e-6)
    found = _fall(make_structure, run_ls_dem, 0.0)
    assert found == pytest.approx(expected, abs=rebound_error(1.0, OMEGA_DT))
