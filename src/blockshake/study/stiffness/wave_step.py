"""A step of velocity sent up a tower by LS-DEM: the experiment behind the contact stiffness."""

from typing import NamedTuple

import numpy as np

from blockshake.dynamics.motion import ground_motion
from blockshake.dynamics.system import Status
from blockshake.errors import InputError
from blockshake.simulation.models import model_of
from blockshake.solvers.ls_dem.driver import simulate_ls_dem

STEP_VELOCITY = 1e-3  # m/s; a larger step would open or slip the joints and measure something else
AXES = {"normal": ("z", 2), "shear": ("x", 0)}
_TIME_STEP = model_of("ls-dem").time_step  # s; shorter where a wave passes a block in fewer steps than these
_STEPS_A_BLOCK = 20


class StepTest(NamedTuple):
    """Histories of a step of velocity sent up a tower."""

    time: np.ndarray  # float64 (n_times,); [s], evenly spaced
    # displacement, velocity: float64 (n_times, n_blocks); along the step, blocks from the lowest up [m, m/s]
    displacement: np.ndarray
    velocity: np.ndarray
    height: float  # of the highest block's mass centre over that of the lowest [m]


def send_step(structure, parameters, direction, passages=3.0, rotations_blocked=True):
    """`StepTest` of the blocks of a tower whose base moves with the step's velocity from the start.

    Parameters
    ----------
    structure : Structure
    parameters : LsDemParameters
    direction : str
        ``normal`` or ``shear``.
    passages : float
        Length of the test, in passages of the tower at the chain's long-wave speed [1].
    rotations_blocked : bool
        Whether the blocks do not rotate under a horizontal step; a vertical one rotates none.

    Raises
    ------
    InputError
        The structure is not a single tower, or the run did not complete.
    """
    channel, axis = AXES[direction]
    blocks = tower_blocks(structure)
    height = structure.position[blocks[-1], 2] - structure.position[blocks[0], 2]
    pitch = height / (len(blocks) - 1)
    stiffness = parameters.normal_stiffness if direction == "normal" else parameters.shear_stiffness
    density = structure.mass[blocks[0]] / structure.solid(blocks[0]).properties.volume
    duration = passages * (height + pitch) / np.sqrt(stiffness * pitch / density)
    young = structure.file.materials[structure.file.bodies[blocks[0]].material].youngs_modulus
    time_step = min(_TIME_STEP, pitch * np.sqrt(density / young) / _STEPS_A_BLOCK)
    times = np.arange(0.0, duration, time_step)
    step = ground_motion("velocity step", [0.0, 2.0 * duration], {channel: [STEP_VELOCITY] * 2}, "velocity")
    blocked = direction == "shear" and rotations_blocked
    run = simulate_ls_dem(structure, step, parameters, times, time_step, rotations_blocked=blocked)
    if run.status != Status.COMPLETED:
        raise no_passage(structure, direction, f"; {run.reason}")
    moved = run.position[:, blocks, axis] - run.position[0, blocks, axis]
    return StepTest(times, moved, run.velocity[:, blocks, axis], height)


def no_passage(structure, direction, reason=""):
    """InputError of a tower that does not pass a step on."""
    said = f"expected a tower that passes a {direction} step of velocity on{reason}"
    return InputError(structure.source, "", said)


def tower_blocks(structure):
    """Indices of the tower's blocks from the lowest up."""
    free = np.flatnonzero(~structure.driven)
    blocks = free[np.argsort(structure.position[free, 2], kind="stable")]
    aligned = np.abs(structure.position[blocks, :2] - structure.position[blocks[:1], :2]).max() < 1e-6
    stacked = structure.touching[blocks[:-1], blocks[1:]].all()
    if len(blocks) < 2 or structure.driven.sum() != 1 or not aligned or not stacked:
        raise InputError(
            structure.source, "bodies", "expected a single tower of at least two blocks on one driven body"
        )
    return blocks


def crossing(times, values, level):
    """First time at which a sampled curve reaches a level, linear between samples.

    Parameters
    ----------
    times, values : float64 arrays, shape (n_times,)
    level : float
        In the unit of the values.

    Returns
    -------
    float
        [s]; NaN where the curve never reaches the level.

    Examples
    --------
    >>> crossing(np.array([0.0, 1.0, 2.0]), np.array([0.0, 0.0, 4.0]), 1.0)
    1.25
    """
    if not (values >= level).any():
        return float("nan")
    after = int(np.argmax(values >= level))
    if after == 0:
        return float(times[0])
    part = (level - values[after - 1]) / (values[after] - values[after - 1])
    return float(times[after - 1] + part * (times[after] - times[after - 1]))
