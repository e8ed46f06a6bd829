"""Section on the limit states of the study's user, and its sentences on the first page."""

from typing import NamedTuple

import numpy as np

from blockshake.pages.blocks import Section, Table, Text
from blockshake.pages.units import quantity
from blockshake.pages.wording import given, limited, model_label, percent
from blockshake.pages.words import Words
from blockshake.statistics.intervals import share_interval
from blockshake.study.fragility.figure import measure_words
from blockshake.study.limit_states.settings import LimitState

_OF_LIMITS = Words(__name__)


class Beyond(NamedTuple):
    """How the samples of a case, or of one of its levels, ended against a limit state by a model."""

    name: str  # of the limit state
    measure: str
    limit: str  # with its unit
    place: str  # the case, with its level
    model: str
    # count, known, unknown: samples beyond the limit, of those that are known, and those that are not
    count: int
    known: int
    unknown: int

    @classmethod
    def of(cls, found, place="", model=""):
        """From ``sel(limit=NAME)`` of `limit_states_of_case`, with all samples or those of a level."""
        outcomes = found["exceeded"].values
        known = int((outcomes >= 0).sum())
        measure = found["measure"].item().replace("_", " ")
        counts = int((outcomes == 1).sum()), known, len(outcomes) - known
        return cls(found["limit"].item(), measure, _shown_limit(found), place, model, *counts)

    @property
    def limits(self):
        """Interval of 95 % of the probability [1], see `share_interval`."""
        return share_interval(self.count, self.known, self.unknown)


def limit_states(content):
    """Probability of each limit state by case, level and model; None where the study has none."""
    found = _all(content.stripes)
    if not found:
        return None
    levels = any(case.levels for case in content.cases.values())
    blocks = Text(_OF_LIMITS.method()), _table(content.study["limits"], found, levels), *_fragilities(content)
    return Section("Limit states", "limit-states", blocks)


def _all(stripes):
    return [
        Beyond.of(one.limits.sel(limit=name), stripe.name, model)
        for stripe in stripes
        for model, one in stripe.responses.items()
        if one.limits is not None
        for name in one.limits["limit"].values
    ]


def sentence(found):
    """One limit state of a case by a model in words, from ``sel(limit=NAME)`` of `limit_states_of_case`."""
    return _OF_LIMITS.sentence(Beyond.of(found))


def worst_of_each(stripes, best, most):
    """Each limit state where it is exceeded most, in a sentence; of more than ``most`` the most probable ones.

    ``best``: models whose runs are the best evidence, by name of the stripe.
    """
    by_name = {}
    for one in _all(stripes):
        if one.model in best.get(one.place, ()):
            by_name.setdefault(one.name, []).append(one)
    rows = [
        (max(places, key=lambda one: (*one.limits[::-1], one.place)), len(places))
        for places in by_name.values()
    ]
    rows.sort(key=lambda row: -row[0].limits[1])
    return _OF_LIMITS.items("worst", rows[:most], max(len(rows) - most, 0))


def _shown_limit(found):
    """The limit with its unit; angles in degrees, as users state them."""
    value, unit = float(found["limit_value"]), found["unit"].item()
    return f"{given(np.degrees(value))} deg" if unit == "rad" else quantity(value, unit)


def _table(limits, found, levels):
    rows = []
    for one in found:
        low, high = one.limits
        rows.append((
            one.name, " and ".join(LimitState(**limits[one.name]).bodies), one.measure, one.limit, one.place,
            model_label(one.model), f"{one.count} of {one.known}",
            f"{percent(one.count / one.known)} %" if one.known else "not known",
            f"{percent(low)} to {percent(high)} %", str(one.unknown),
        ))  # fmt: skip
    return Table(
        _OF_LIMITS.table(levels),
        ("Limit state", "Of", "Measure", "Limit", "Case", "Model", "Beyond", "Probability", "95 %", "Not known"),
        tuple(rows), "llllllrrrr",
    )  # fmt: skip


def _fragilities(content):
    """Table of the fragilities over the intensity, where the samples draw motions."""
    found = [
        (case.name, model, one.limits.sel(limit=name))
        for case in content.cases.values()
        for model, one in case.responses.items()
        if one.limits is not None and "median" in one.limits
        for name in one.limits["limit"].values
    ]
    if not found:
        return []
    rows = [
        (
            str(one["limit"].item()), case, model_label(model), method,
            *(limited(one.sel(fit=method), name) for name in ("median", "safe", "dispersion")),
        )
        for case, model, one in found
        for method in ("regression", "counts")
    ]  # fmt: skip
    first = found[0][2]
    name, unit = measure_words(first.assign_attrs(measure=first.attrs["intensity_measure"]))
    head = ("Limit state", "Case", "Model", "By", "Median", "5 %", "Dispersion")
    return [Table(_OF_LIMITS.fragilities(name, unit), head, tuple(rows), "llllrrr")]
