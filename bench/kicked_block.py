"""One block that rocks freely after a kick: the impact that a model makes, with Housner's."""

import dataclasses

import numpy as np

from blockshake.dynamics.system import Status
from blockshake.errors import InputError
from blockshake.simulation.models import model_of

_KICK = 0.5  # rad/s, turns the 1.6 m block by 2 degrees, a tenth of what overturns it
# s; such a block is upright again after 0.3 s, and turns back from the other side after 0.5 s
_KICKED_DURATION = 1.0
_LEANT = 1e-3  # rad; a block that leaned so much has left its seat
RATE = 5000  # records a second


def rocking_block(structure, model, parameters, time_step, strength):
    """Let the lowest block rock freely on the slab alone, after a kick about the edge of its base.

    Parameters
    ----------
    structure : Structure
        Its driven bodies and the first free body that touches one are taken.
    model : str
        The table `blockshake.simulation.models.MODELS`.
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
    alone, block = _kicked(structure, strength)
    times = np.arange(round(_KICKED_DURATION * RATE) + 1) / RATE
    run = model_of(model).solve(alone, None, parameters, times, time_step)
    if run.status != Status.COMPLETED:
        return {"swing_time": np.nan, "impact_ratio": np.nan}
    lean = leans(run.orientation[:, block])
    away = int(np.argmax(np.abs(lean) > _LEANT))
    upright = zeros(times[away:], lean[away:])
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
    alone, block = _kicked(structure, 1.0)
    vertices = alone.solid(block).vertices
    height = -vertices[:, 2].min()
    half = vertices[vertices[:, 2] < -height + 1e-9, 0].max()
    about_edge = alone.inertia[block, 1, 1] + alone.mass[block] * (half**2 + height**2)
    return float(1.0 - 2.0 * alone.mass[block] * half**2 / about_edge)


def _kicked(structure, strength):
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


def leans(orientation):
    """Rotation about y [rad], of quaternions along the first axis."""
    return 2.0 * np.arctan2(orientation[:, 2], orientation[:, 0])


def zeros(times, values):
    """Times at which a sampled curve passes zero, linear between records."""
    before = np.flatnonzero(values[:-1] * values[1:] < 0.0)
    part = values[before] / (values[before] - values[before + 1])
    return times[before] + part * (times[before + 1] - times[before])
