"""Contact stiffness from wave speed: a step of velocity sent up a tower, as in the paper's Figs. 9 and 10."""

from dataclasses import dataclass

import numpy as np
import pandas as pd
import xarray as xr

from blockshake.dynamics.motion import ground_motion
from blockshake.errors import InputError
from blockshake.geometry.structure import load_structure
from blockshake.solvers.ls_dem.driver import simulate_ls_dem
from blockshake.solvers.ls_dem.parameters import LsDemParameters
from blockshake.study.sample_parameters import sample_parameters

STEP_VELOCITY = 1e-3  # m/s; a larger step would open or slip the joints and measure something else
DEFINITION = (
    "arrival at a block is the first instant at which its mass centre moves with half of the step's velocity; "
    "the effective wave speed is the height between the mass centres of the lowest and the highest block over "
    "the difference of their arrivals; a step of 1 mm/s, vertical for the normal and horizontal with rotations "
    "blocked for the shear stiffness"
)
_TIME_STEP = 1e-5  # s
_MATCHED = 1e-4  # relative error of the wave speed at which the search stops
_MOST_ROUNDS = 8
_AXES = {"normal": ("z", 2), "shear": ("x", 0)}


@dataclass(frozen=True)
class WaveTest:
    """Histories of one step test and the wave speed read from them.

    Attributes
    ----------
    time : float64 array, shape (n_times,)
        [s]
    displacement, velocity : float64 arrays, shape (n_times, n_blocks)
        Along the step, blocks from the lowest up [m, m/s].
    arrival : float64 array, shape (n_blocks,)
        [s]
    wave_speed : float
        [m/s]
    """

    time: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray
    arrival: np.ndarray
    wave_speed: float


def target_wave_speeds(structure):
    """Speeds of pressure and shear waves in the tower's material, Zhou et al. (2023), Eqs. (7), (8) [m/s].

    Parameters
    ----------
    structure : Structure

    Returns
    -------
    dict of str to float
        ``normal``: sqrt(E / rho); ``shear``: sqrt(G / rho) with G = E / (2 (1 + nu)).
    """
    material = structure.file.materials[structure.file.bodies[_blocks(structure)[0]].material]
    young, density = material.youngs_modulus, material.density
    return {
        "normal": float(np.sqrt(young / density)),
        "shear": float(np.sqrt(young / (2.0 + 2.0 * material.poisson_ratio) / density)),
    }


def measure_wave_speed(structure, parameters, direction):
    """Send one step of velocity up a tower with LS-DEM and read the effective wave speed.

    Parameters
    ----------
    structure : Structure
        One driven body and a single stack of blocks on it.
    parameters : LsDemParameters
    direction : str
        ``normal`` (vertical step) or ``shear`` (horizontal step, rotations blocked).

    Returns
    -------
    WaveTest

    Raises
    ------
    InputError
        The structure is not a single tower, or a block never reached half the step's velocity.
    """
    channel, axis = _AXES[direction]
    blocks = _blocks(structure)
    height = structure.position[blocks[-1], 2] - structure.position[blocks[0], 2]
    # time for the step to pass the tower, generously: three times at the chain's long-wave speed
    stiffness = parameters.normal_stiffness if direction == "normal" else parameters.shear_stiffness
    pitch = height / (len(blocks) - 1)
    density = structure.mass[blocks[0]] / structure.solid(blocks[0]).properties.volume
    duration = 3.0 * (height + pitch) / np.sqrt(stiffness * pitch / density)
    times = np.arange(0.0, duration, _TIME_STEP)
    step = ground_motion("velocity step", [0.0, 2.0 * duration], {channel: [STEP_VELOCITY] * 2}, "velocity")
    run = simulate_ls_dem(
        structure, step, parameters, times, _TIME_STEP, rotations_blocked=direction == "shear"
    )
    velocity = run.velocity[:, blocks, axis]
    if run.status != "completed" or not (velocity >= 0.5 * STEP_VELOCITY).any(axis=0).all():
        raise InputError(
            structure.source,
            "",
            f"expected a tower that passes a {direction} step of velocity on; {run.reason}",
        )
    arrival = np.array([_crossing(times, history, 0.5 * STEP_VELOCITY) for history in velocity.T])
    displacement = run.position[:, blocks, axis] - run.position[0, blocks, axis]
    return WaveTest(times, displacement, velocity, arrival, float(height / (arrival[-1] - arrival[0])))


def calibrate_stiffness(structure="configuration-2", parameters=None):
    """Normal and shear stiffness whose effective wave speeds are those of the blocks' material.

    Parameters
    ----------
    structure : str or path
        A single tower; the paper's has four blocks.
    parameters : dict of str to value, optional
        Physical parameters by dotted name.

    Returns
    -------
    dict
        ``normal_stiffness``, ``shear_stiffness`` [N/m3], ``definition``, and by direction ``wave_speed`` reached
        and ``target_wave_speed`` [m/s].

    Raises
    ------
    InputError
        As `measure_wave_speed`.

    Notes
    -----
    In a chain whose joints neither open nor slip every speed goes with the square root of the stiffness, but for
    the damping and the time step; so the search multiplies by the square of the speed ratio and is over in a few
    rounds.
    """
    tower = load_structure(structure, parameters)
    targets = target_wave_speeds(tower)
    blocks = _blocks(tower)
    pitch = float(np.diff(tower.position[blocks, 2]).mean())
    density = tower.mass[blocks[0]] / tower.solid(blocks[0]).properties.volume
    stiffness = {direction: density * targets[direction] ** 2 / pitch for direction in _AXES}
    reached = {}
    for direction in _AXES:
        for _ in range(_MOST_ROUNDS):
            numerical = LsDemParameters(
                normal_stiffness=stiffness["normal"], shear_stiffness=stiffness["shear"]
            )
            reached[direction] = measure_wave_speed(tower, numerical, direction).wave_speed
            ratio = targets[direction] / reached[direction]
            if abs(ratio - 1.0) < _MATCHED:
                break
            stiffness[direction] *= ratio**2
    return {
        "normal_stiffness": float(stiffness["normal"]),
        "shear_stiffness": float(stiffness["shear"]),
        "definition": DEFINITION,
        "wave_speed": reached,
        "target_wave_speed": targets,
    }


def _blocks(structure):
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


def _crossing(times, values, level):
    """First time at which a sampled curve reaches a level, linear between samples."""
    after = int(np.argmax(values >= level))
    if after == 0:
        return float(times[0])
    part = (level - values[after - 1]) / (values[after] - values[after - 1])
    return float(times[after - 1] + part * (times[after] - times[after - 1]))


def calibrate_design(structure, design, linked):
    """Stiffness of every sample of a design.

    Parameters
    ----------
    structure : str or path
        The tower.
    design : pandas.DataFrame
        Sampled values, index the sample.
    linked : dict of str to str
        Parameters that take the sampled value of another.

    Returns
    -------
    pandas.DataFrame
        Columns ``ls_dem.normal_stiffness`` and ``ls_dem.shear_stiffness`` [N/m3], index as the design's.
    """
    found = [
        calibrate_stiffness(structure, sample_parameters(row, structure, linked))
        for _, row in design.iterrows()
    ]
    return pd.DataFrame(
        {f"ls_dem.{name}": [one[name] for one in found] for name in ("normal_stiffness", "shear_stiffness")},
        index=design.index,
    )


def wave_tests(structure):
    """Histories of the step tests of a tower at the stiffness calibrated for its nominal parameters.

    Parameters
    ----------
    structure : str or path

    Returns
    -------
    xarray.Dataset
        ``displacement`` and ``velocity(direction, time, block)`` along the step [m, m/s]; ``arrival(direction,
        block)`` [s]; ``stiffness`` [N/m3], ``wave_speed`` and ``target_wave_speed(direction)`` [m/s]; NaN after the
        shorter test's end. Attribute ``definition``.
    """
    tower = load_structure(structure)
    calibrated = calibrate_stiffness(structure)
    numerical = LsDemParameters(
        **{name: calibrated[name] for name in ("normal_stiffness", "shear_stiffness")}
    )
    blocks = [tower.body_names[body] for body in _blocks(tower)]
    tests = []
    for direction in _AXES:
        test = measure_wave_speed(tower, numerical, direction)
        tests.append(
            xr.Dataset(
                {
                    "displacement": (("time", "block"), test.displacement, {"units": "m"}),
                    "velocity": (("time", "block"), test.velocity, {"units": "m s-1"}),
                    "arrival": ("block", test.arrival, {"units": "s"}),
                    "stiffness": ((), calibrated[f"{direction}_stiffness"], {"units": "N m-3"}),
                    "wave_speed": ((), test.wave_speed, {"units": "m s-1"}),
                    "target_wave_speed": ((), calibrated["target_wave_speed"][direction], {"units": "m s-1"}),
                },
                coords={"time": ("time", test.time, {"units": "s"}), "block": blocks},
            )
        )
    joined = xr.concat(tests, dim=xr.Variable("direction", list(_AXES)), join="outer")
    joined.attrs = {"Conventions": "CF-1.11", "title": "wave tests of a tower", "definition": DEFINITION,
                    "step_velocity": STEP_VELOCITY}  # fmt: skip
    return joined
