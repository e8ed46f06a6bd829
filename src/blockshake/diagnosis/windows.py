"""Short simulations restarted from measured poses: what a model says a moment later, where whole tests are chaotic."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.transform import Rotation

from blockshake.diagnosis.smoothed_state import set_down
from blockshake.dynamics.motion import GroundMotion, MotionTable, ground_motion
from blockshake.effects.effect import Experiment
from blockshake.effects.registry import with_effect
from blockshake.geometry.rotations import rotation_matrices
from blockshake.geometry.structure import Structure
from blockshake.measurement.instruments import Instruments
from blockshake.measurement.joint_coordinates import joint_coordinates
from blockshake.solvers.ls_dem.parameters import LsDemParameters
from blockshake.solvers.nscd.parameters import NscdParameters
from blockshake.study.simulation import MODELS, part_parameters, split_parameters

N_END = 5  # readings at the end of a window of which the mean is taken: 25 ms at 200 Hz
_VERTICAL, _PITCH = 2, 3  # channels of a ground motion


@dataclass(frozen=True)
class WindowModel:
    """A model that windows are simulated with.

    Attributes
    ----------
    solver : str
        One of `null_model.MODELS`.
    structure : Structure
        As it stands at the start of the test.
    motion : GroundMotion
        Of the base through the whole test, from its first reading.
    numerics : LsDemParameters or NscdParameters
    time_step : float
        [s]
    """

    solver: str
    structure: Structure
    motion: GroundMotion
    numerics: LsDemParameters | NscdParameters
    time_step: float


def measured_motion(base):
    """The reconstructed base motion as a ground motion, its displacement a cubic spline through the readings' times."""
    displacement = base.displacement - base.displacement[0]
    return ground_motion("measured base", base.time - base.time[0], {"x": displacement}, "displacement")


def window_model(solver, structure, base, parameters, time_step, effects=()):
    """Model of a measured test.

    Parameters
    ----------
    solver : str
        One of `null_model.MODELS`.
    structure : str
        The campaign's.
    base : BaseMotion
        From `reconstruct_base`.
    parameters : dict of str to value
        Physical and numerical, by dotted name.
    time_step : float
        [s]
    effects : sequence of dict
        As of `simulated_test`.

    Returns
    -------
    WindowModel
    """
    physical, numerical = part_parameters(parameters)
    experiment = Experiment(str(structure), physical, measured_motion(base), Instruments())
    for effect in effects:
        experiment = with_effect(experiment, **effect)
    _, numerics = split_parameters({**experiment.parameters, **numerical}, solver)
    return WindowModel(solver, experiment.load(), experiment.motion, numerics, time_step)


def simulate_window(model, structure, states, place, n_steps, generator=None):
    """Joint coordinates at the end of a window.

    Parameters
    ----------
    model : WindowModel
    structure : Structure
        The campaign's: joint coordinates count from its start, whatever was varied in the model.
    states : SmoothedStates
    place : int
        Reading at which the window starts.
    n_steps : int
        Readings until its end, more than `N_END`.
    generator : numpy.random.Generator, optional
        Draws the errors of the start; without it the start is the mean.

    Returns
    -------
    float64 array, shape (2 n_joints + 2,)
        Mean over the last `N_END` readings of slip along x [m] and rotation about y [rad] of every joint, of the base's
        pitch [rad] and of its vertical displacement [m]; NaN if the run ended early.

    Notes
    -----
    Blocks are put on the model's base as they were measured to be on theirs: where the base pitches in one of the two
    and not in the other, the joints still start alike. Stops stay where they stood at the start of the test.
    """
    time = states.time
    begin = time[place] - time[0]
    started = _started(model, structure, states, place, begin, generator)
    table = _cut(model.motion, begin, time[place + n_steps] - time[0])
    ends = time[place + n_steps - N_END + 1 : place + n_steps + 1] - time[place]
    trajectory = MODELS[model.solver][0](
        started,
        GroundMotion("window", table, "displacement"),
        model.numerics,
        np.concatenate([[0.0], ends]),
        model.time_step,
    )
    rotation = rotation_matrices(trajectory.orientation[1:])
    offset = structure.mass_offset - model.structure.mass_offset
    position = trajectory.position[1:] + np.einsum("tbij,bj->tbi", rotation, offset)
    histories = joint_coordinates(
        structure,
        np.concatenate([structure.position[None], position]),
        np.concatenate([rotation_matrices(structure.orientation)[None], rotation]),
    )
    base = model.motion.evaluate(begin + ends) - model.motion.evaluate(np.zeros(1))
    return np.concatenate(
        [
            histories["slip"].sel(tangent="x").to_numpy()[1:].mean(axis=0),
            histories["rotation"].sel(axis="y").to_numpy()[1:].mean(axis=0),
            base[:, [_PITCH, _VERTICAL]].mean(axis=0),
        ]
    )


def measured_ends(histories, places, n_steps):
    """What was measured of the same, and its noise.

    Parameters
    ----------
    histories : xarray.Dataset
        From `joint_histories`.
    places : int64 array, shape (n_windows,)
    n_steps : int

    Returns
    -------
    values : float64 array, shape (n_windows, 2 n_joints + 2)
        As from `simulate_window`; NaN where nothing was read.
    noise : float64 array, same shape
        Standard deviations.
    """
    slip, rotation = histories["slip"].sel(tangent="x"), histories["rotation"].sel(axis="y")
    pitch = histories["base_rotation"].sel(axis="y")
    vertical = histories["base_displacement"].sel(axis="z")
    every = np.column_stack(
        [slip.transpose("time", "joint"), rotation.transpose("time", "joint"), pitch, vertical]
    )
    one = np.concatenate(
        [
            histories["slip_noise"].sel(tangent="x"),
            histories["rotation_noise"].sel(axis="y"),
            [
                histories["base_rotation_noise"].sel(axis="y"),
                histories["base_displacement_noise"].sel(axis="z"),
            ],
        ]
    )
    read = np.array([every[place + n_steps - N_END + 1 : place + n_steps + 1] for place in places])
    count = np.isfinite(read).sum(axis=1)
    values = np.where(count > 0, np.nansum(read, axis=1) / np.maximum(count, 1), np.nan)
    return values, one / np.sqrt(np.maximum(count, 1))


def _started(model, campaign, states, place, begin, generator):
    """The model's structure as it was measured at a reading."""
    own = model.structure
    moved, rate = states.drawn(place, generator)
    driven = states.driven
    # of the base: only pitch turns it, and its displacement counts from the window's start
    pitch, velocity = model.motion.evaluate([begin])[0, _PITCH], model.motion.evaluate([begin], 1)[0]
    home = rotation_matrices(campaign.orientation[driven])
    turn = Rotation.from_rotvec([0.0, pitch, 0.0]).as_matrix() @ home
    spin = np.array([0.0, velocity[_PITCH], 0.0])
    seen = (campaign.position - campaign.position[driven]) @ home + moved[:, :3]
    arms = seen @ turn.T
    rotation = turn @ Rotation.from_rotvec(moved[:, 3:]).as_matrix() @ home.T
    rotation = rotation @ rotation_matrices(campaign.orientation)
    angular_velocity = spin + rate[:, 3:] @ turn.T
    # from the campaign's mass centres to the model's
    lever = np.einsum("bij,bj->bi", rotation, own.mass_offset - campaign.mass_offset)
    position = campaign.position[driven] + arms + lever
    velocity = velocity[:3] + np.cross(spin, arms) + rate[:, :3] @ turn.T + np.cross(angular_velocity, lever)
    orientation = Rotation.from_matrix(rotation).as_quat(scalar_first=True)
    held = own.driven
    orientation_now = np.where(
        held[:, None], Rotation.from_matrix(turn).as_quat(scalar_first=True), orientation
    )
    set_down(own, position, orientation_now, velocity, angular_velocity)
    started = replace(
        own,
        file=own.file.model_copy(update={"stoppers": _stops(own, position, orientation_now, driven)}),
        position=np.where(held[:, None], own.position, position),
        orientation=np.where(held[:, None], own.orientation, orientation),
        velocity=np.where(held[:, None], 0.0, velocity),
        angular_velocity=np.where(held[:, None], 0.0, angular_velocity),
        touching=np.zeros_like(own.touching),
    )
    return started


def _stops(structure, position, orientation, driven):
    """Stops with the gaps that are left of those at the start of the test."""
    if not structure.file.stoppers:
        return structure.file.stoppers
    bodies, points = structure.carriers(structure.file.stoppers), structure.arms(structure.file.stoppers)
    reach = []
    for where, turned in ((structure.position, structure.orientation), (position, orientation)):
        turns = rotation_matrices(turned)
        place = where[bodies] + np.einsum("sij,sj->si", turns[bodies], points) - where[driven]
        reach.append(place @ turns[driven])
    travelled = reach[1] - reach[0]
    return tuple(
        stop.model_copy(
            update={
                "gap": stop.gap - (1.0 if stop.axis[0] == "+" else -1.0) * moved["xyz".index(stop.axis[1])]
            }
        )
        for stop, moved in zip(structure.file.stoppers, travelled, strict=True)
    )


def _cut(motion, begin, end):
    """Table of a motion from one time to another, times and displacement counted from the first; pitch as it is."""
    breaks, coefficients = motion.table
    first = max(int(np.searchsorted(breaks, begin + 1e-9, side="right")) - 1, 0)
    last = min(int(np.searchsorted(breaks, end - 1e-9)) + 1, len(breaks) - 1)
    own = coefficients[first:last].copy()
    own[:, :_PITCH, 0] -= motion.evaluate([begin])[0, :_PITCH]
    return MotionTable(breaks[first : last + 1] - begin, own)
