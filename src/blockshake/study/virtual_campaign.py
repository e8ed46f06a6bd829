"""The virtual tests that stand in for measurements: synthetic, and called so."""

import pandas as pd

from blockshake.dynamics.load_motion import load_motion
from blockshake.files import content_digest
from blockshake.measurement.virtual_test import virtual_test
from blockshake.study.distributions import draw_true_parameters
from blockshake.study.sample_parameters import sample_parameters
from blockshake.study.simulation import simulate
from blockshake.study.stiffness import calibrate_stiffness

MARKER_NOISE = 1e-4  # m, the optical system's
TIME_STEP = 1e-5  # s, the paper's
NODE_SPACING = 0.16  # m; not the study's 0.2, so that the study does not meet its own discretisation
_TOWER = "configuration-2"


def simulate_virtual_test(case, linked):
    """One synthetic test of a case and its truth.

    Parameters
    ----------
    case : dict
        ``structure``, ``motion``, ``scale`` and ``duration`` [s].
    linked : dict of str to str
        Parameters that take the drawn value of another.

    Returns
    -------
    test : xarray.Dataset
        As in a campaign's test file.
    truth : dict
        Parameters of the run; not for a reader of the test.

    Notes
    -----
    LS-DEM with parameters drawn independently from Table 2, stiffness from wave speed, seeded by the
    structure's name; Gaussian noise on every marker.
    """
    seed = int(content_digest("virtual test", case["structure"])[:8], 16)
    drawn = draw_true_parameters(seed)
    stiffness = calibrate_stiffness(_TOWER, sample_parameters(pd.Series(drawn), _TOWER, linked))
    drawn |= {f"ls_dem.{name}": stiffness[name] for name in ("normal_stiffness", "shear_stiffness")}
    truth = sample_parameters(pd.Series(drawn), case["structure"], linked) | {
        "ls_dem.node_spacing": NODE_SPACING
    }
    run = simulate(
        case["structure"], load_motion(case["motion"], case["scale"]), "ls-dem", truth,
        time_step=TIME_STEP, duration=case["duration"], accelerometers=False,
    )  # fmt: skip
    return virtual_test(run, seed, MARKER_NOISE), {"seed": seed, "time_step": TIME_STEP, "parameters": truth}


def campaign_yaml(case):
    """Text of the campaign file of a virtual test."""
    return (
        "# SYNTHETIC: one simulated run seen through noisy markers, see SOURCE.md. Nothing here was measured.\n"
        f"name: virtual-{case['structure']}\n"
        f"structure: {case['structure']}\n"
        f"sensors: {{marker_noise: {MARKER_NOISE}, accelerometer_noise: 0.02}}\n"
        "tests:\n"
        f"  - {{name: virtual, file: virtual.nc, motion: {case['motion']}, scale: {case['scale']}, role: fit}}\n"
    )
