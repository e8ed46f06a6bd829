"""The decision on tests of which it is known alone whether a body fell."""

from typing import NamedTuple

import numpy as np
import xarray as xr

from blockshake.diagnosis.answer.answer import Alternative, find_causes, share_of
from blockshake.diagnosis.answer.decide import chance, kind_of, probabilities
from blockshake.diagnosis.answer.decision import MEMBERS, Cause, Decision, Estimate, Part
from blockshake.diagnosis.answer.thresholds import by_odds
from blockshake.diagnosis.outcomes.posterior import (
    fitted_curve,
    load_outcomes,
    posterior,
    prior,
    unknowns_of,
)
from blockshake.diagnosis.outcomes.unknowns import UNKNOWNS, largest_extent, value_of
from blockshake.geometry.structure import load_structure
from blockshake.measurement.checks.outcomes import standing_body

_QUANTILES = (0.05, 0.5, 0.95)
_DECIDED = 0.02  # chance of the other outcome, below which a test tells nothing
_READINGS = "outcomes"
CAUSES = tuple(dict.fromkeys(unknown.cause for unknown in UNKNOWNS if unknown.cause))
PREDICTED = ("nominal", "recalibrated", "extended", "curve")


class DecidedOutcomes(NamedTuple):
    """A decision; and of every open test its outcome against what the models predict."""

    decision: Decision
    evidence: xr.Dataset


def decide(campaign, files, without):
    """`DecidedOutcomes` of a campaign by the files of its step, see `CampaignKind`."""
    return decide_outcomes(campaign, files.outcomes, without)


def decide_outcomes(campaign, files, without=()):
    """Decide what the outcomes of a campaign's open tests support.

    Parameters
    ----------
    campaign : Campaign
    files : list of path
        The batches of `simulate_outcomes`.
    without : sequence of str
        Effects that are left out.
    """
    outcomes, names = load_outcomes(files), list(campaign.open)
    structure = load_structure(campaign.structure)
    body = standing_body(structure)
    name, extent = structure.body_names[body], largest_extent(structure, body)
    rows, fell = outcomes.rows(names), fell_in(campaign, names)
    weighed = {}

    def weigh(causes):
        key = tuple(sorted(causes))
        if key not in weighed:
            weighed[key] = posterior(outcomes, rows, fell, key)
        return weighed[key]

    def ranked(known):
        acting = [one.cause for one in known]
        gains = {
            cause: weigh([*acting, cause]).evidence - weigh(acting).evidence
            for cause in CAUSES
            if cause not in acting and cause not in without
        }
        rivals = [Alternative(cause, name, gain, gain, (name,)) for cause, gain in gains.items()]
        return sorted(rivals, key=lambda one: -one.gain)

    groups = find_causes(ranked, lambda cause, known: by_odds(cause) + share_of(known))
    firsts = [group.rivals[0].cause for group in groups]
    parts = tuple(
        _part(name, extent, group, [other for other in firsts if other != own], weigh)
        for group, own in zip(groups, firsts, strict=True)
    )
    chances = {
        "nominal": prior(outcomes).chance(outcomes, rows),
        "recalibrated": weigh([]).chance(outcomes, rows),
        "extended": weigh(firsts).chance(outcomes, rows),
        "curve": fitted_curve(outcomes, rows, fell)[rows],
    }
    telling = [one for one, p in zip(names, chances["nominal"], strict=True) if _DECIDED < p < 1.0 - _DECIDED]
    decision = Decision(
        decision=kind_of(parts),
        parts=parts,
        probabilities=probabilities(parts, without),
        limits={},
        excluded_above={},
        p=min(1.0, sum(map(chance, parts))) if parts else 1.0,
        where=f"falls of {name}" if parts else "no departure larger than chance",
        tests=names,
        silent=(),
        n_rows=len(names),
        cannot_see=_not_seen(outcomes, names, telling, chances, fell),
    )
    return DecidedOutcomes(decision, predicted(outcomes, names, fell, chances))


def fell_in(campaign, names):
    """Whether the body fell in some tests, bool (n_tests,)."""
    return np.array([campaign.tests[name].outcome == "fell" for name in names])


def predicted(outcomes, names, fell, chances):
    """Dataset along ``test``: ``fell``, ``pga`` [m/s2], ``pgv`` [m/s] and the chance of a fall by every model."""
    rows, run = outcomes.rows(names), outcomes.runs[0]
    simulated = [np.isposinf(one["lean"].to_numpy()[rows, 0]).astype(np.int8) for one in outcomes.runs]
    return xr.Dataset(
        {
            "fell": ("test", np.asarray(fell, dtype=np.int8)),
            "pga": ("test", run["pga"].to_numpy()[rows], {"units": "m s-2"}),
            "pgv": ("test", run["pgv"].to_numpy()[rows], {"units": "m s-1"}),
            "chance": (("model", "test"), [chances[model] for model in PREDICTED]),
            "simulated": (("solver", "test"), simulated),
        },
        {"test": names, "model": list(PREDICTED), "solver": [one.attrs["model"] for one in outcomes.runs]},
    )


def _part(body, extent, group, others, weigh):
    causes = []
    for cause in (rival.cause for rival in group.rivals):
        found, own = weigh([*others, cause]), unknowns_of([cause])
        parameters, values = {}, []
        for number in own:
            unknown = UNKNOWNS[number]
            lower, middle, upper = value_of(unknown, found.quantiles(number, _QUANTILES), extent)
            parameters[unknown.name] = Estimate(estimate=middle, lower=lower, upper=upper, unit=unknown.unit)
            values.append(value_of(unknown, found.members(MEMBERS)[:, number], extent))
        names = [UNKNOWNS[number].name for number in own]
        causes.append(
            Cause(
                name=cause,
                place={"body": body},
                places=(body,),
                gain=group.gains[cause],
                odds=group.odds[cause],
                parameters=parameters,
                members=tuple(dict(zip(names, map(float, row), strict=True)) for row in np.transpose(values)),
                amplitudes=[estimate.estimate for estimate in parameters.values()],
            )
        )
    return Part(readings=_READINGS, causes=tuple(causes), odds=group.odds, gains=group.gains)


def _not_seen(outcomes, names, telling, chances, fell):
    """Lines on what the outcomes do not show."""
    lines = [
        f"{len(names) - len(telling)} of {len(names)} open tests end alike by all undamaged models, and tell little"
    ]
    unfinished = sum(int(np.isnan(run["lean"]).sum()) for run in outcomes.runs)
    if unfinished:
        lines.append(f"{unfinished} runs were not finished, and were left out")
    for run in outcomes.runs:
        if settled := int(run["settled"].sum()):
            lines.append(
                f"in {settled} of {run['settled'].size} runs by {run.attrs['model']} the body moves by more than 1 % "
                "of its size before the ground does: contacts or mass centre do not hold it as it was placed"
            )
    wrong = sum(int((p > 0.5) != outcome) for p, outcome in zip(chances["extended"], fell, strict=True))
    lines.append(f"models with the causes predict {wrong} of {len(names)} open tests wrongly")
    return tuple(lines)
