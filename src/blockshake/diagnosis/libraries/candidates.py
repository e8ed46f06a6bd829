"""The candidates of a diagnosis: every physical effect of the registry at every place of the structure."""

from dataclasses import dataclass

import numpy as np

from blockshake.effects.registry import EFFECTS

_GOLDEN = (np.sqrt(5.0) - 1.0) / 2.0
_FIRST_SIZE = 0.2  # of the prior: the middle would be the null of an effect with a sign
NOMINAL = "nominal"  # key of what has no candidate in it


@dataclass(frozen=True)
class Candidate:
    """An effect at a place.

    Attributes
    ----------
    effect : str
        Name in the registry.
    place : dict
        One of its places.
    """

    effect: str
    place: dict

    @property
    def key(self):
        """Name for files and tables, such as ``weak-joint@block-1-block-2``."""
        words = [
            name for value in self.place.values() for name in ([value] if isinstance(value, str) else value)
        ]
        return "@".join([self.effect, *(["-".join(words)] if words else [])])

    def as_effect(self, values):
        """The effect as an experiment is given it."""
        return {"name": self.effect, "values": values, "place": self.place}

    def values(self, number):
        """Parameter values of a library draw, and the size in units of the visible one.

        The sizes fill the prior evenly however many draws there are (multiples of the golden section, modulo 1); the
        other parameters are drawn from their priors.
        """
        size = EFFECTS[self.effect].parameters[0]
        value = size.lower + (size.upper - size.lower) * ((_FIRST_SIZE + number * _GOLDEN) % 1.0)
        return self._with_others(size, value, number), float((value - size.null) / (size.visible - size.null))

    def values_at(self, visible, number):
        """Parameter values of a size in units of the visible one; the others are those of a library draw."""
        size = EFFECTS[self.effect].parameters[0]
        return self._with_others(size, size.null + visible * (size.visible - size.null), number)

    def _with_others(self, size, value, number):
        generator = np.random.default_rng([number, *self.key.encode()])
        others = EFFECTS[self.effect].parameters[1:]
        drawn = {item.name: float(generator.uniform(item.lower, item.upper)) for item in others}
        return {size.name: float(value)} | drawn


def effect_of(key):
    """Effect of a candidate's key."""
    return key.partition("@")[0]


def candidates(structure):
    """Candidates in a structure, in the registry's order; what only the sensors do is left to the parity checks."""
    return [
        Candidate(name, place)
        for name, effect in EFFECTS.items()
        if effect.acts != "observation"
        for place in effect.places(structure)
    ]
