"""Findings of a sensitivity study: spreads within the noise, and variables that stand out from chance."""

from typing import NamedTuple

import numpy as np


class Influence(NamedTuple):
    """One variable's measure with its 95 % interval [1].

    Attributes
    ----------
    parameter : str
        Dotted name.
    control : bool
        Model or structure has no use for the variable.
    value, lower, upper : float
    beyond_chance : bool
        The measure is larger than the level of chance of all variables and markers.
    """

    parameter: str
    control: bool
    value: float
    lower: float
    upper: float
    beyond_chance: bool


class Influences(NamedTuple):
    """Variables from the strongest down, and the level of chance [1]."""

    ranked: tuple
    chance: float

    @property
    def beyond_chance(self):
        """Variables that stand out, from the strongest down."""
        return tuple(one for one in self.ranked if one.beyond_chance)


class Windows(NamedTuple):
    """Windows in which a variable's share stands out from chance.

    Attributes
    ----------
    parameter : str
        Dotted name.
    count : int
    first, last : float
        Middle of the first and of the last of them [s].
    largest : float
        Largest share of any window [1].
    """

    parameter: str
    count: int
    first: float
    last: float
    largest: float


class WindowFindings(NamedTuple):
    """Windows with a spread of at least the noise, the level of chance [1], and the variables that stand out."""

    count: int
    chance: float
    found: tuple


def differs(result, noise):
    """Whether samples of a `sensitivity` differ by at least a marker's noise [m], a standard deviation.

    At any marker and for any quantity; false where the spread is not known.
    """
    return bool((result["spread"] >= noise).any())


def is_known(result, measure):
    """Whether the samples of one quantity suffice for a measure and its level of chance."""
    return bool(np.isfinite(result[f"{measure}_chance"]))


def influences(result, measure):
    """`Influences`: variables of a `sensitivity` ranked by a measure, at one marker and for one quantity that is known.

    ``first_order``, ranked by the share, which is noise where negative; or ``rank_correlation``, by its magnitude.
    """
    chance, values = float(result[f"{measure}_chance"]), result[measure].to_numpy()
    strength = values if measure == "first_order" else np.abs(values)
    lower, upper = (result[f"{measure}_interval"].sel(bound=one).to_numpy() for one in ("lower", "upper"))
    order = np.argsort(-strength, kind="stable")
    names, controls = result["parameter"].values, result["control"].values
    ranked = (
        Influence(
            str(names[place]), bool(controls[place]), *map(float, (values[place], lower[place], upper[place])),
            bool(strength[place] > chance),
        )
        for place in order
    )  # fmt: skip
    return Influences(tuple(ranked), chance)


def windows_beyond_chance(result, noise):
    """`WindowFindings`: variables whose share of a window's spread stands out from chance.

    ``result`` from `sensitivity`, at one marker; windows with a smaller spread than ``noise`` [m] are left out.
    """
    chance = float(result["window_first_order_chance"])
    loud = result["window_spread"] >= noise
    shares, found = result["window_first_order"].where(loud), []
    for name in result["parameter"].values:
        one = shares.sel(parameter=name)
        beyond = one["window"].values[one.values > chance]
        if len(beyond):
            found.append(
                Windows(str(name), len(beyond), float(beyond[0]), float(beyond[-1]), float(one.max()))
            )
    return WindowFindings(int(loud.sum()), chance, tuple(found))


def quiet_markers(result, markers, noise):
    """Number of markers of a `sensitivity` whose histories differ by less than the noise [m].

    Markers without a known spread do not count.
    """
    return int((result["spread"].sel(quantity="history", marker=list(markers)) < noise).sum())
