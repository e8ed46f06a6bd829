"""The plan of a campaign: sizes from which effects are seen and told apart, and what one measurement more would add."""

from typing import NamedTuple

import numpy as np
from blockshake.diagnosis.answer.limits import SEEN, limit_of
from blockshake.diagnosis.answer.static_tests import static_tests
from blockshake.diagnosis.planning.separation import NominalCampaign
from blockshake.effects.registry import EFFECTS
from blockshake.errors import InputError
from blockshake.files import load_yaml
from blockshake.validation import Positive, Strict, validated

CAMPAIGNS, OF_ADDITIONS = 4, 2  # nominal campaigns: of the plan, and of one measurement more
_SIZES = (1.0, 1.6, 2.5, 4.0, 8.0)  # over the limit, at which an effect is held against its rivals
_STRONGER = 1.25
_SEPARATED = 0.5  # chance more, from which an addition is said to separate a pair
SHAKE, SENSOR = "shake", "sensor"


class Costs(Strict):
    """Costs of one measurement more, over that of a shake; a laboratory has its own."""

    shake: Positive = 1.0
    sensor: Positive = 0.5
    weighing: Positive = 1.0
    slow_tilt: Positive = 1.5
    snap_release: Positive = 1.0
    jack: Positive = 1.0

    def of(self, kind):
        """Cost of a measurement of a kind."""
        return getattr(self, kind.replace(" ", "_"))


def load_costs(path):
    """`Costs` of a YAML file; what it leaves out has its default."""
    if path is None:
        return Costs()
    mapping = load_yaml(path)
    if not isinstance(mapping, dict):
        raise InputError(path, "", f"expected costs by kind: {', '.join(Costs.model_fields)}")
    return validated(Costs, mapping, path)


class Told(NamedTuple):
    """An effect of the plan.

    Attributes
    ----------
    place : str
        Where the tests tell least of it, in words; of the places at which they tell it.
    limits : dict of str to float or None
        By place, the size from which it is seen in nine of ten campaigns; None beyond the largest of the prior.
    apart : dict of str to (float or None)
        By rival, the size from which it is told from that one in nine of ten campaigns; None: never.
    """

    place: str
    limits: dict
    apart: dict


class Addition(NamedTuple):
    """One measurement more: its kind, in words, cost, effects more that it separates of their rivals, and which."""

    kind: str
    words: str
    cost: float
    pairs: float
    separates: tuple


def plan_campaign(asked, costs, progress):
    """`Told` by effect, and `Addition` by falling worth for their costs.

    Parameters
    ----------
    asked : Asked
    costs : Costs
    progress : callable
        Called with a line of text as the plan goes on.

    Raises
    ------
    InputError
        A test of which no forces can be read.
    """
    campaigns, readings = [], []
    for number in range(CAMPAIGNS):
        progress(f"nominal campaign {number + 1} of {CAMPAIGNS}")
        readings.append({
            test: asked.simulated(test, number * len(asked.motions) + at) for at, test in enumerate(asked.motions)
        })  # fmt: skip
        campaigns.append(_campaign(asked, readings[-1]))
    told = {}
    for name in dict.fromkeys(name for one in campaigns for name in one.visible if one.visible[name]):
        progress(f"{name} against its rivals")
        told[name] = _told(name, campaigns)
    few, readings = campaigns[:OF_ADDITIONS], readings[:OF_ADDITIONS]
    before, additions = _chances(few, told), []

    def add(kind, words, after):
        gained = {pair: chance - before.get(pair, 0.0) for pair, chance in after.items()}
        most = sorted((pair for pair in gained if gained[pair] > _SEPARATED), key=lambda pair: -gained[pair])
        additions.append(Addition(kind, words, costs.of(kind), sum(gained.values()), tuple(most)))

    for static in static_tests(few[0].seen[0]):
        add(static.kind, static.words, _chances(few, told, static))
    for words, names in asked.more.items():
        progress(words)
        add(SENSOR, words, _chances([_campaign(asked, one, names) for one in readings], told))
    for test in asked.motions:
        for factor, words in ((1.0, f"{test} once more"), (_STRONGER, f"{test} times {_STRONGER:g}")):
            progress(words)
            draws = range(CAMPAIGNS * len(asked.motions), CAMPAIGNS * len(asked.motions) + OF_ADDITIONS)
            more = [
                {**one, words: asked.simulated(test, draw, factor)}
                for one, draw in zip(readings, draws, strict=True)
            ]
            add(SHAKE, words, _chances([_campaign(asked, one) for one in more], told))
    return told, sorted(additions, key=lambda one: (-one.pairs / one.cost, one.words))


def _campaign(asked, readings, more=frozenset()):
    seen = [asked.seen(name, test, more) for name, test in readings.items()]
    if None in seen:
        expected = "expected convex blocks that touch, and tests of more than a second that they survive"
        raise InputError(asked.structure.source, "", expected)
    return NominalCampaign(seen)


def _told(name, campaigns):
    first = EFFECTS[name].parameters[0]
    places = dict.fromkeys(place for one in campaigns for place in one.visible.get(name, ()))
    limits = {place: limit_of(name, [one.visible_at(name, place) for one in campaigns]) for place in places}
    known = {place: abs(limit - first.null) for place, limit in limits.items() if limit is not None}
    if not known:
        return Told(next(iter(places)), limits, {})
    place = max(known, key=known.get)
    sizes = known[place] * np.array(_SIZES)
    end = campaigns[0].visible_at(name, place).distance[-1]
    sizes = np.append(sizes[sizes < end], end)
    found = [_chances_of(name, place, size, campaigns) for size in sizes]
    apart = {}
    for rival in found[-1]:
        chances = np.array([chance.get(rival, 0.0) for chance in found])
        enough = np.flatnonzero(chances >= SEEN - 1e-6)
        size = sizes[enough[0]] if len(enough) else None
        if size is not None and enough[0]:
            below, above = chances[enough[0] - 1 : enough[0] + 1]
            share = (SEEN - below) / (above - below)
            size = sizes[enough[0] - 1] ** (1.0 - share) * size**share
        side = np.sign(first.visible - first.null)
        apart[rival] = None if size is None else float(first.null + side * size)
    return Told(place, limits, apart)


def _chances(campaigns, told, static=None):
    """Chances to see every effect of its visible size, as a rival None, and to tell it from each rival."""
    chances = {}
    for name, one in told.items():
        first = EFFECTS[name].parameters[0]
        size = abs(first.visible - first.null)
        for rival, chance in _chances_of(name, one.place, size, campaigns, static).items():
            chances[name, rival] = chance
    return chances


def _chances_of(name, place, size, campaigns, static=None):
    """Chance to see an effect of a size, as that of a rival None, and to tell it from each rival: mean of campaigns."""
    chances = []
    for one in campaigns:
        seen = one.chance_seen(name, place, size, static)
        rivals = one.rivals(name, place, size)
        apart = {rival: one.chance_apart(name, place, size, (rival, odds), static) for rival, odds in rivals.items()}
        chances.append({None: seen, **{rival: min(seen, chance) for rival, chance in apart.items()}})
    every = dict.fromkeys(rival for one in chances for rival in one)
    return {rival: float(np.mean([one.get(rival, 0.0) for one in chances])) for rival in every}
