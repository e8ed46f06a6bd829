"""The truth of the virtual table: parameters and effect, drawn by seed, hidden from the readers of the tests."""

import numpy as np
import pandas as pd

from blockshake.effects.registry import EFFECTS
from blockshake.errors import InputError
from blockshake.study.sampling.distributions import LINKED, TABLE_2, draw_true_parameters
from blockshake.study.sampling.sample_parameters import own_value, sample_parameters
from blockshake.study.stiffness.wave_speed import calibrate_stiffness, stiffness_parameters

_EFFECT, _PLACE, _VALUES = range(3)  # streams of the seed
_SIZES = (0.5, 1.5)  # of the visible size


def true_parameters(structure, seed):
    """Parameters of the tested `Structure`, drawn independently about its own values, with their contact stiffness.

    Returns
    -------
    dict of str to float
        By dotted name: those of Table 2, with its scatter, that the structure has, and that are not 0 there.
    """
    stated = {name: value for name in TABLE_2 if (value := own_value(structure, name)) > 0.0}
    drawn = sample_parameters(pd.Series(draw_true_parameters(seed, stated)), structure, LINKED)
    return drawn | stiffness_parameters(calibrate_stiffness(structure, drawn))


def hidden_effect(hidden, structure, seed):
    """Name, values and place of the effect in the data; None where there is none.

    Parameters
    ----------
    hidden : Hidden
        Values that it leaves open are drawn: any effect of the registry with the same chance, any place of it, a
        size of 0.5 to 1.5 times the visible one with either sign where the prior has both, the other
        parameters from their priors.
    structure : Structure
    seed : int

    Returns
    -------
    dict or None
        ``name``, ``values`` and ``place``.

    Raises
    ------
    InputError
        An effect without a place in this structure.
    """
    if hidden.effect == "none":
        return None
    name = hidden.effect
    if name == "drawn":
        name = list(EFFECTS)[_stream(seed, _EFFECT).integers(len(EFFECTS))]
    effect = EFFECTS[name]
    places = effect.places(structure)
    if not places:
        raise InputError(structure.source, name, "expected a structure that has a place for this effect")
    if hidden.place is None:
        place = places[_stream(seed, _PLACE).integers(len(places))]
    else:
        given = [hidden.place] if isinstance(hidden.place, dict) else hidden.place
        stated = [{kind: _listed(names) for kind, names in one.items()} for one in given]
        place = next((one for one in stated if one in places), stated[0])
    return {"name": name, "values": _values(effect, seed) | hidden.values, "place": place}


def _listed(names):
    return list(names) if isinstance(names, tuple) else names


def _values(effect, seed):
    generator = _stream(seed, _VALUES)
    size, *others = effect.parameters
    share = generator.uniform(*_SIZES)
    both = size.lower < size.null < size.upper
    sign = -1.0 if both and generator.random() < 0.5 else 1.0
    drawn = {size.name: float(size.null + sign * share * (size.visible - size.null))}
    drawn[size.name] = min(max(drawn[size.name], size.lower), size.upper)
    return drawn | {item.name: float(generator.uniform(item.lower, item.upper)) for item in others}


def _stream(seed, number):
    return np.random.default_rng([seed, number])
