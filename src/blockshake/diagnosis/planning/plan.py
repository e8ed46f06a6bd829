"""The plan of a campaign: sizes from which effects are seen and distinguished, and what one measurement more would
add."""

from typing import NamedTuple

import numpy as np

from blockshake.diagnosis.answer.limits import SEEN, from_null, largest
from blockshake.diagnosis.answer.static_tests import static_tests
from blockshake.diagnosis.planning.separation import NominalCampaign
from blockshake.effects.registry import EFFECTS
from blockshake.errors import InputError

CAMPAIGNS, OF_ADDITIONS = 4, 2  # nominal campaigns: of the plan, and of one measurement more
_GRID = np.geomspace(1e-4, 1.0, 200)  # of the end of the prior, at which the chance to be seen is computed
_SIZES = (1.0, 1.6, 2.5, 4.0, 8.0)  # over the limit, at which an effect is held against its rivals
_STRONGER = 1.25
_SEPARATED = 0.5  # chance more, from which an addition is said to separate a pair


class Detectability(NamedTuple):
    """An effect of the plan."""

    place: str  # in words, where the tests tell least of it, of the places at which they tell it
    # str to float or None; by place, the size from which it is seen in nine of ten campaigns; None: not
    # within the prior
    limits: dict
    # str to (float or None); by rival, the size from which it is distinguished from that one there; under None that
    # from which it is seen
    apart: dict


class Addition(NamedTuple):
    """One measurement more: its words, the pairs of effect and rival that it separates, and which above all.

    ``pairs`` is the sum of the chances more, of effects of their visible size; the rival None is to be seen at all.
    """

    words: str
    pairs: float
    separates: tuple


def plan_of(planned, progress):
    """`Detectability` by effect, and `Addition` by falling number of pairs.

    Parameters
    ----------
    planned : PlannedCampaign
    progress : callable
        Called with a line of text as the plan goes on.

    Raises
    ------
    InputError
        A test of which no forces can be read.
    """
    campaigns, readings, tests = [], [], list(planned.motions)
    for number in range(CAMPAIGNS):
        progress(f"nominal campaign {number + 1} of {CAMPAIGNS}")
        draws = range(number * len(tests), (number + 1) * len(tests))
        readings.append(
            {test: planned.simulated(test, draw) for test, draw in zip(tests, draws, strict=True)}
        )
        campaigns.append(_campaign(planned, readings[-1]))
    detectable = {}
    for name in dict.fromkeys(name for one in campaigns for name in one.limits if one.limits[name]):
        progress(f"{name} against its rivals")
        detectable[name] = _detectability(name, campaigns)
    if not detectable:
        raise InputError(
            planned.structure.source, "markers",
            "expected sensors that show the pose of every block, such as three markers that are not on a line; these "
            "show no effect of any size",
        )  # fmt: skip
    few, readings = campaigns[:OF_ADDITIONS], readings[:OF_ADDITIONS]
    before, additions = _of_visible(few, detectable), []

    def add(words, after):
        gained = gained_chances(before, after)
        most = sorted((pair for pair in gained if gained[pair] > _SEPARATED), key=lambda pair: -gained[pair])
        additions.append(Addition(words, sum(gained.values()), tuple(most)))

    for static in static_tests(few[0].seen[0]):
        add(static.words, _of_visible(few, detectable, static))
    for words, names in planned.more.items():
        progress(words)
        add(words, _of_visible([_campaign(planned, one, names) for one in readings], detectable))
    for test in tests:
        words = f"{test} times {_STRONGER:g}"
        progress(words)
        draws = range(CAMPAIGNS * len(tests), CAMPAIGNS * len(tests) + OF_ADDITIONS)
        more = [planned.simulated(test, draw, _STRONGER) for draw in draws]
        longer = [_campaign(planned, {**one, words: test}) for one, test in zip(readings, more, strict=True)]
        add(words, _of_visible(longer, detectable))
    return detectable, sorted(additions, key=lambda one: (-one.pairs, one.words))


def gained_chances(before, after):
    """Chance more of every pair by a measurement, never below zero: who measures more may leave it out [1]."""
    return {pair: max(0.0, chance - before.get(pair, 0.0)) for pair, chance in after.items()}


def _campaign(planned, readings, more=frozenset()):
    seen = [planned.seen(name, test, more) for name, test in readings.items()]
    if None in seen:
        expected = "expected convex blocks that touch, and tests of more than a second that they survive"
        raise InputError(planned.structure.source, "", expected)
    return NominalCampaign(seen)


def _detectability(name, campaigns):
    places = dict.fromkeys(place for one in campaigns for place in one.limits.get(name, ()))
    grid, limits = largest(name) * _GRID, {}
    for place in places:
        chances = [np.mean([one.chance_seen(name, place, size) for one in campaigns]) for size in grid]
        limits[place] = _first(grid, chances)
    known = {place: size for place, size in limits.items() if size is not None}
    place, apart = max(known, key=known.get, default=next(iter(places))), {}
    if known:
        sizes = known[place] * np.array(_SIZES)
        sizes = np.append(sizes[sizes < largest(name)], largest(name))
        found = []
        for size in sizes:
            found.append(_chances(name, place, size, campaigns))
            # of larger sizes nothing more is asked
            if min(found[-1].values()) >= SEEN:
                break
        apart = {rival: _first(sizes, [one.get(rival, 0.0) for one in found]) for rival in found[-1]}
    shown = (
        {key: None if size is None else from_null(name, size) for key, size in sizes.items()}
        for sizes in (limits, apart)
    )
    return Detectability(place, *shown)


def _first(sizes, chances):
    """The first size at which a chance is `SEEN`, even in the logarithm between two; None if at none."""
    enough = np.flatnonzero(np.array(chances) >= SEEN - 1e-3)
    if not len(enough):
        return None
    first = int(enough[0])
    if first == 0:
        return float(sizes[0])
    share = np.clip((SEEN - chances[first - 1]) / (chances[first] - chances[first - 1]), 0.0, 1.0)
    return float(sizes[first - 1] ** (1.0 - share) * sizes[first] ** share)


def _of_visible(campaigns, detectable, static=None):
    """Chances by effect, of its visible size, and rival."""
    chances = {}
    for name, one in detectable.items():
        first = EFFECTS[name].parameters[0]
        for rival, chance in _chances(
            name, one.place, abs(first.visible - first.null), campaigns, static
        ).items():
            chances[name, rival] = chance
    return chances


def _chances(name, place, size, campaigns, static=None):
    """Chances of `NominalCampaign.chances`, mean of campaigns."""
    chances = [one.chances(name, place, size, static) for one in campaigns]
    rivals = dict.fromkeys(rival for one in chances for rival in one)
    return {rival: float(np.mean([one.get(rival, 0.0) for one in chances])) for rival in rivals}
