"""Contact stiffness from wave speed: a step of velocity sent up a tower, as in the paper's Figs. 9 and 10."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple, TypedDict

import numpy as np
import pandas as pd
import xarray as xr

from blockshake.geometry.structure import Structure, StructureSource, load_structure
from blockshake.simulation.models import model_of
from blockshake.solvers.ls_dem.parameters import LsDemParameters
from blockshake.store import Unit
from blockshake.study.sampling.sample_parameters import structure_parameters
from blockshake.study.stiffness.tower import tower_of
from blockshake.study.stiffness.wave_step import (
    AXES,
    STEP_VELOCITY,
    StepTest,
    crossing,
    no_passage,
    send_step,
    tower_blocks,
)

DEFINITION = (
    "arrival at a block is the first instant at which its mass centre moves with half of the step's velocity; "
    "the effective wave speed is the height between the mass centres of the lowest and the highest block over "
    "the difference of their arrivals; a step of 1 mm/s, vertical for the normal and horizontal with rotations "
    "blocked for the shear stiffness"
)
_LS_DEM = model_of("ls-dem")
_MATCHED = 1e-4  # relative error of the wave speed at which the search stops
_MOST_ROUNDS = 8


class WaveTest(NamedTuple):
    """One step test and the wave speed read from it."""

    step: StepTest
    arrival: np.ndarray  # float64 (n_blocks,); at the blocks from the lowest up [s]
    wave_speed: float  # [m/s]


def target_wave_speeds(structure):
    """Speeds of pressure and shear waves in the tower's material, Zhou et al. (2023), Eqs. (7), (8) [m/s].

    ``normal``: sqrt(E / rho); ``shear``: sqrt(G / rho) with G = E / (2 (1 + nu)).
    """
    block = structure.file.bodies[tower_blocks(structure)[0]]
    material = structure.file.materials[block.material]
    young, density = material.youngs_modulus, block.density or material.density
    return {
        "normal": float(np.sqrt(young / density)),
        "shear": float(np.sqrt(young / (2.0 + 2.0 * material.poisson_ratio) / density)),
    }


def measure_wave_speed(structure, parameters, direction):
    """`WaveTest`: send one step of velocity up a tower with LS-DEM and read the effective wave speed.

    Parameters
    ----------
    structure : Structure
        One driven body and a single stack of blocks on it.
    parameters : LsDemParameters
    direction : str
        ``normal`` (vertical step) or ``shear`` (horizontal step, rotations blocked).

    Raises
    ------
    InputError
        The structure is not a single tower, or a block never reached half the step's velocity.
    """
    test = send_step(structure, parameters, direction)
    if not (test.velocity >= 0.5 * STEP_VELOCITY).any(axis=0).all():
        raise no_passage(structure, direction)
    arrival = np.array([crossing(test.time, history, 0.5 * STEP_VELOCITY) for history in test.velocity.T])
    return WaveTest(test, arrival, float(test.height / (arrival[-1] - arrival[0])))


class Stiffness(TypedDict):
    """Contact stiffness [N/m3], with the wave speeds reached and aimed at [m/s] by direction."""

    normal_stiffness: float
    shear_stiffness: float
    definition: str
    wave_speed: dict[str, float]
    target_wave_speed: dict[str, float]


def calibrate_stiffness(structure: StructureSource, parameters: Mapping[str, Any] | None = None) -> Stiffness:
    """Normal and shear stiffness whose effective wave speeds are those of the blocks' material.

    Parameters
    ----------
    structure : Structure, str, path or mapping
        Whose blocks `tower_of` makes the tower that is tested.
    parameters : dict of str to value, optional
        Physical parameters by dotted name.

    Returns
    -------
    Stiffness
        A dict of ``normal_stiffness``, ``shear_stiffness`` [N/m3], ``definition``, and by direction ``wave_speed``
        reached and ``target_wave_speed`` [m/s].

    Raises
    ------
    InputError
        As `tower_of` and `measure_wave_speed`.

    Examples
    --------
    >>> import blockshake
    >>> stiffness = blockshake.calibrate_stiffness("my.yaml")
    >>> stiffness["normal_stiffness"] > stiffness["shear_stiffness"] > 0.0
    True

    Notes
    -----
    In a chain whose joints neither open nor slip every speed goes with the square root of the stiffness, but for the
    damping and the time step; so the search multiplies by the square of the speed ratio and is over in a few rounds.
    """
    tower = tower_of(load_structure(structure, parameters))
    targets = target_wave_speeds(tower)
    blocks = tower_blocks(tower)
    pitch = float(np.diff(tower.position[blocks, 2]).mean())
    density = tower.mass[blocks[0]] / tower.solid(blocks[0]).properties.volume
    stiffness = {direction: density * targets[direction] ** 2 / pitch for direction in AXES}
    reached = {}
    for direction in AXES:
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


def calibrate_design(structure, design, linked, store):
    """Stiffness of a structure for every sample of a design.

    Parameters
    ----------
    structure : str or path
    design : pandas.DataFrame
        Sampled values, columns the dotted names.
    linked : dict of str to str
        Parameters that take another's sampled value.
    store : Store

    Returns
    -------
    pandas.DataFrame
        With the design's index: ``ls_dem.normal_stiffness`` and ``ls_dem.shear_stiffness`` [N/m3].
    """
    loaded = load_structure(structure)
    rows = []
    for _, row in design.iterrows():
        parameters = structure_parameters(row, loaded, linked)
        rows.append(
            stiffness_parameters(store.value(_Stiffness(tower_of(loaded.with_parameters(parameters)))))
        )
    return pd.DataFrame(rows, index=design.index)


@dataclass(frozen=True)
class _Stiffness(Unit):
    """Calibrated stiffness of the tower of a sample, which has neither friction nor other shapes of the structure."""

    tower: Structure

    def made(self, checkpoint):
        return calibrate_stiffness(self.tower)


def stiffness_parameters(calibrated):
    """Stiffness from `calibrate_stiffness` as parameters of LS-DEM, by dotted name."""
    return {f"{_LS_DEM.prefix}.{name}": calibrated[name] for name in _LS_DEM.calibrated}


def wave_tests(structure):
    """Histories of the step tests of a structure's tower at the stiffness calibrated for its nominal parameters.

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
    loaded = load_structure(structure)
    tower, calibrated = tower_of(loaded), calibrate_stiffness(loaded)
    numerical = LsDemParameters(**{name: calibrated[name] for name in _LS_DEM.calibrated})
    blocks = [tower.body_names[body] for body in tower_blocks(tower)]
    tests = []
    for direction in AXES:
        test = measure_wave_speed(tower, numerical, direction)
        tests.append(
            xr.Dataset(
                {
                    "displacement": (("time", "block"), test.step.displacement, {"units": "m"}),
                    "velocity": (("time", "block"), test.step.velocity, {"units": "m s-1"}),
                    "arrival": ("block", test.arrival, {"units": "s"}),
                    "stiffness": ((), calibrated[f"{direction}_stiffness"], {"units": "N m-3"}),
                    "wave_speed": ((), test.wave_speed, {"units": "m s-1"}),
                    "target_wave_speed": ((), calibrated["target_wave_speed"][direction], {"units": "m s-1"}),
                },
                coords={"time": ("time", test.step.time, {"units": "s"}), "block": blocks},
            )
        )
    joined = xr.concat(tests, dim=xr.Variable("direction", list(AXES)), join="outer")
    joined.attrs = {"Conventions": "CF-1.11", "title": "wave tests of a tower", "definition": DEFINITION,
                    "step_velocity": STEP_VELOCITY}  # fmt: skip
    return joined
