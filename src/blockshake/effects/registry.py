"""The registry of effects: their names, each with its entry."""

from blockshake.effects import (
    base_compliance,
    block_mass,
    eccentricity,
    impact_restitution,
    joint_compliance,
    reduced_bearing,
    stopper_contact,
    table_pitch,
    vertical_motion,
)
from blockshake.effects.friction import (
    friction_asymmetry,
    rate_weakening_friction,
    slip_weakening_friction,
    weak_joint,
)
from blockshake.effects.sensor_faults import FAULTS
from blockshake.errors import InputError

_EFFECTS = (
    table_pitch.EFFECT,
    vertical_motion.EFFECT,
    *FAULTS,
    stopper_contact.EFFECT,
    impact_restitution.EFFECT,
    reduced_bearing.EFFECT,
    eccentricity.EFFECT,
    block_mass.EFFECT,
    weak_joint.EFFECT,
    rate_weakening_friction.EFFECT,
    slip_weakening_friction.EFFECT,
    friction_asymmetry.EFFECT,
    joint_compliance.EFFECT,
    base_compliance.EFFECT,
)
EFFECTS = {effect.name: effect for effect in _EFFECTS}


def title_of(name):
    """Name of an effect in words; a sensor fault that is not in the registry goes by its own name."""
    return EFFECTS[name].title if name in EFFECTS else name.replace("-", " ")


def with_effect(experiment, name, values, place):
    """An experiment with an effect in it.

    Parameters
    ----------
    experiment : Experiment
    name : str
        `EFFECTS`.
    values : dict of str to float
        By parameter; one that is left out has its null value.
    place : dict
        One of the effect's places in the structure.

    Raises
    ------
    InputError
        An effect, parameter or place that does not exist.
    """
    if name not in EFFECTS:
        raise InputError("effect", name, f"expected one of {', '.join(EFFECTS)}")
    effect = EFFECTS[name]
    known = {parameter.name: parameter.null for parameter in effect.parameters}
    for key in values:
        if key not in known:
            raise InputError("effect", f"{name}.{key}", f"expected one of {', '.join(known)}")
    places = effect.places(experiment.structure)
    if place not in places:
        raise InputError("effect", f"{name}.place", f"expected one of {places}, not {place}")
    return effect.act(experiment, {**known, **values}, place)
