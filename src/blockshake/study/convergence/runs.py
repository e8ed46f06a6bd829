"""The two short runs that convergence is read from: one block that rocks freely, and a stack under one sine."""

import dataclasses

import numpy as np

from blockshake.dynamics.motion import ground_motion
from blockshake.dynamics.system import Status
from blockshake.errors import InputError
from blockshake.simulation.energy_residual import energy_residual
from blockshake.simulation.models import model_of
from blockshake.solvers.ls_dem.driver import simulate_ls_dem
from blockshake.study.convergence.table import OBSERVABLES

_KICK = 0.5  # rad/s, turns the 1.6 m block by 2 degrees, a tenth of what overturns it
# s; such a block is upright again after 0.3 s, and turns back from the other side after 0.5 s
_KICKED_DURATION = 1.0
_LEANT = 1e-3  # rad; a block that leaned so much has left its seat
_RATE = 5000  # records a second
_ROWS = 400  # of the sine


def rocking_block(structure, model, parameters, time_step, strength):
    """Let the lowest block rock freely on the slab alone, after a kick about the edge of its base.

    Parameters
    ----------
    structure : Structure
        Its driven bodies and the first free body that touches one are taken.
    model : str
        Of the table `blockshake.simulation.models.MODELS`.
    parameters : pydantic model
        Numerical ones of the model.
    time_step : float
        [s]
    strength : float
        Multiplies the kick of 0.5 rad/s [1].

    Returns
    -------
    dict of str to float
        ``swing_time``: from the kick until the block is upright again [s]; ``impact_ratio``: angular
        velocity after its first impact over that before, the root of the ratio of the energies at the turning
        points of both swings [1]. NaN where the block does not come so far.

    Raises
    ------
    InputError
        No free body stands on a driven one.
    """
    alone, block = kicked(structure, strength)
    times = _records(_KICKED_DURATION)
    run = model_of(model).solve(alone, None, parameters, times, time_step)
    if run.status != Status.COMPLETED:
        return {"swing_time": np.nan, "impact_ratio": np.nan}
    lean = _leans(run.orientation[:, block])
    away = int(np.argmax(np.abs(lean) > _LEANT))
    upright = _zeros(times[away:], lean[away:])
    rise = run.position[:, block, 2] - run.position[0, block, 2]
    # kinetic energy too: the turning point lies between two records
    energy = run.energy[:, :2].sum(axis=1) - run.energy[0, 1]
    if len(upright) < 1:
        return {"swing_time": np.nan, "impact_ratio": np.nan}
    first = int(np.argmax(np.where(times < upright[0], rise, -np.inf)))
    second = int(np.argmax(np.where(times > upright[0], rise, -np.inf)))
    turned = lean[second] * lean[first] < 0.0 and second < len(times) - 1
    ratio = np.sqrt(energy[second] / energy[first]) if turned else np.nan
    return {"swing_time": float(upright[0]), "impact_ratio": float(ratio)}


def housner_ratio(structure):
    """Impact ratio [1] of the block of `rocking_block`, rigid and on the two edges of its flat base alone.

    Housner (1963), Bull. Seismol. Soc. Am. 53: ``1 - 2 m b^2 / I``, with half the width b of the base and the moment
    of inertia I about the far edge.
    """
    alone, block = kicked(structure, 1.0)
    vertices = alone.solid(block).vertices
    height = -vertices[:, 2].min()
    half = vertices[vertices[:, 2] < -height + 1e-9, 0].max()
    about_edge = alone.inertia[block, 1, 1] + alone.mass[block] * (half**2 + height**2)
    return float(1.0 - 2.0 * alone.mass[block] * half**2 / about_edge)


def shaken_stack(structure, parameters, time_step, acceleration, frequency, duration):
    """Shake a structure by one sine of ground acceleration along x.

    Parameters
    ----------
    structure : Structure
    parameters : LsDemParameters
    time_step : float
        [s]
    acceleration, frequency : float
        Amplitude [m/s2] and frequency [Hz] of the one cycle, which begins towards +x.
    duration : float
        Window; the ground rests after the cycle [s].

    Returns
    -------
    dict of str to float
        ``sink`` of the highest body in the equilibrium that the run starts from [m]; of its displacement along x
        relative to the first driven body, the drift: ``peak_drift`` [m], ``upright_time`` of its first zero
        after the peak [s] and ``end_drift`` at the end of the window [m]; ``peak_rotation`` of the lowest free
        body about y [rad]; ``energy_residual`` [1]. NaN where the run did not complete, but for the sink.
    """
    times = _records(duration)
    run = simulate_ls_dem(structure, sine(acceleration, frequency), parameters, times, time_step)
    free = np.flatnonzero(~structure.driven)
    height = structure.position[free, 2]
    top, lowest = free[np.argmax(height)], free[np.argmin(height)]
    base = int(np.flatnonzero(structure.driven)[0])
    read = {name: np.nan for name in OBSERVABLES if name not in ("swing_time", "impact_ratio")}
    read["sink"] = float(structure.position[top, 2] - run.position[0, top, 2])
    if run.status != Status.COMPLETED:
        return read
    along = run.position[:, :, 0] - structure.position[:, 0]
    drift = along[:, top] - along[:, base]
    peak = int(np.argmax(np.abs(drift)))
    upright = _zeros(times[peak:], drift[peak:])
    return read | {
        "peak_drift": float(np.abs(drift[peak])),
        "peak_rotation": float(np.abs(_leans(run.orientation[:, lowest])).max()),
        "upright_time": float(upright[0]) if len(upright) else np.nan,
        "end_drift": float(drift[-1]),
        "energy_residual": energy_residual(run.energy),
    }


def sine(acceleration, frequency):
    """One cycle of ground acceleration along x, after which the ground is at rest again elsewhere."""
    time = np.linspace(0.0, 1.0 / frequency, _ROWS + 1)
    values = acceleration * np.sin(2.0 * np.pi * frequency * time)
    return ground_motion("sine", time, {"x": values}, "acceleration")


def kicked(structure, strength):
    """The driven bodies with the block that stands on them, turning about the edge of its base at +x.

    ``strength`` multiplies the kick [1]. An `InputError` where no free body stands on a driven one.
    """
    driven, touching = structure.driven, structure.touching
    seated = np.flatnonzero(~driven & touching[:, driven].any(axis=1))
    if not len(seated):
        raise InputError(structure.source, "bodies", "expected a body that stands on a driven one")
    kept = np.append(np.flatnonzero(driven), seated[0])
    reach = structure.solid(seated[0]).vertices
    spin = _KICK * strength
    bodies = [structure.file.bodies[body] for body in kept]
    others = (
        "joints",
        "stoppers",
        "external_forces",
        "markers",
        "accelerometers",
        "displacement_transducers",
    )
    apart = {"bodies": tuple(bodies)} | dict.fromkeys(others, ())
    velocity, angular_velocity = np.zeros((2, len(kept), 3))
    velocity[-1] = [-spin * reach[:, 2].min(), 0.0, spin * reach[:, 0].max()]
    angular_velocity[-1, 1] = spin
    pairs = np.ix_(kept, kept)
    alone = dataclasses.replace(
        structure,
        file=structure.file.model_copy(update=apart),
        mass=structure.mass[kept],
        inertia=structure.inertia[kept],
        driven=structure.driven[kept],
        position=structure.position[kept],
        orientation=structure.orientation[kept],
        velocity=velocity,
        angular_velocity=angular_velocity,
        friction=structure.friction[pairs],
        touching=structure.touching[pairs],
    )
    return alone, len(kept) - 1


def _records(duration):
    return np.arange(round(duration * _RATE) + 1) / _RATE


def _leans(orientation):
    """Rotation about y [rad], of quaternions along the first axis."""
    return 2.0 * np.arctan2(orientation[:, 2], orientation[:, 0])


def _zeros(times, values):
    """Times at which a sampled curve passes zero, linear between records."""
    before = np.flatnonzero(values[:-1] * values[1:] < 0.0)
    part = values[before] / (values[before] - values[before + 1])
    return times[before] + part * (times[before + 1] - times[before])
