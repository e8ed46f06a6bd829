"""Gain on sealed tests of which it is known alone whether a body fell: by the Brier score of the chances of a fall."""

import numpy as np

from blockshake.diagnosis.gain.campaign_gain import CampaignGain
from blockshake.diagnosis.outcomes.decide import PREDICTED, fell_in, predicted
from blockshake.diagnosis.outcomes.posterior import fitted_curve, load_outcomes, posterior, prior
from blockshake.diagnosis.verdict.verdict import Contrast, Gain, MeasuredGain
from blockshake.statistics.resampling import resampled_weights


def measure_gain(campaign, decision, effort, files):
    """`CampaignGain` of a campaign by the files of its step, see `CampaignKind`."""
    return outcome_gain(campaign, files.outcomes, decision)


def outcome_gain(campaign, files, decision):
    """`CampaignGain` of a decision's causes on sealed tests.

    Parameters
    ----------
    campaign : Campaign
    files : list of path
        The batches of `simulate_outcomes`.
    decision : Decision

    Notes
    -----
    Nothing is fitted to a sealed outcome: every chance follows from simulated leans of the sealed tests and from the
    open outcomes. The Brier score is the mean square of chance less outcome (Brier 1950, Mon. Weather Rev. 78). The
    discrepancy without a name is a logistic curve over peak acceleration and velocity.
    """
    outcomes, opened, sealed = load_outcomes(files), list(campaign.open), list(campaign.sealed)
    rows, fell = outcomes.rows(opened), fell_in(campaign, opened)
    acting = [part.causes[0].name for part in decision.parts]
    sealed_rows = outcomes.rows(sealed)
    chances = {
        "nominal": prior(outcomes).chance(outcomes, sealed_rows),
        "recalibrated": posterior(outcomes, rows, fell, ()).chance(outcomes, sealed_rows),
        "extended": posterior(outcomes, rows, fell, acting).chance(outcomes, sealed_rows),
        "curve": fitted_curve(outcomes, rows, fell)[sealed_rows],
    }
    scores = predicted(outcomes, sealed, fell_in(campaign, sealed), chances)
    squares = {
        model: (scores["chance"].sel(model=model) - scores["fell"]).to_numpy() ** 2 for model in PREDICTED
    }
    weights = resampled_weights(len(sealed), np.random.default_rng([len(sealed), 44])) / len(sealed)
    means = {model: weights @ own for model, own in squares.items()}
    contrasts = {
        rival: Contrast.of_errors(means[model], means["extended"])
        for rival, model in (
            ("recalibrated", "recalibrated"),
            ("nominal", "nominal"),
            ("discrepancy", "curve"),
        )
    }
    runs = sum(run["lean"].size for run in outcomes.runs)
    return CampaignGain(MeasuredGain(gain=Gain(**contrasts), runs=runs), scores)
