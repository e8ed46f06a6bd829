"""The friction calibration of one case: replicated ensembles for every candidate mean, against its measured test."""

import numpy as np
import pandas as pd

from blockshake.simulation.models import model_of
from blockshake.sources import script_sources, source_digest
from blockshake.study.ensembles.batch import CaseRuns, simulate_samples
from blockshake.study.ensembles.case_input import driving_motions, measured_on_clock
from blockshake.study.ensembles.coverage import coverage, is_likely
from blockshake.study.ensembles.ensemble import join_batches
from blockshake.study.friction.calibration import mean_score, search_mean, with_mean
from blockshake.study.friction.replicates import replicate_seed, replicated_designs
from blockshake.study.sampling.distributions import load_distributions
from blockshake.study.stiffness.wave_speed import calibrate_design


def calibrate_case(case, named, base, given, store):
    """Friction calibration of one case of a configuration.

    Parameters
    ----------
    case : dict
        As for `measured_input`.
    named : dict
        Entries ``campaign``, a folder, and ``test``: the measured test.
    base : path
        File from `measured_input`.
    given : dict
        Entries ``search``, ``models``, ``ensemble`` and ``output_rate`` of the configuration.
    store : Store
        Its folder is shared with the study's batches.

    Returns
    -------
    dict
        From `friction_summary`.
    """
    search, ensemble = given["search"], given["ensemble"]
    model = search["model"]
    measured, noise = measured_on_clock(named, base)
    runs = CaseRuns(case, model, given["models"][model], ensemble["linked"], given["output_rate"])
    drawn_from = {
        "distributions": load_distributions(ensemble["distributions"], "ensemble"),
        "seed": ensemble["seed"],
    }
    store = store._replace(source=source_digest(*script_sources("simulate_batch", model)))
    found, beside = calibrate_friction(runs, base, drawn_from, search, measured, noise, store)
    return friction_summary(found, beside, search, measured)


def calibrate_friction(runs, base, ensemble, search, measured, marker_noise, store):
    """Search the mean coefficient of friction of a case.

    Parameters
    ----------
    runs : CaseRuns
    base : as for `driving_motions`
    ensemble : dict
        ``distributions``, ``seed``.
    search : dict
        ``variables``, ``lowest``, ``highest``, ``step``, ``finest`` [1]; ``size`` of an ensemble, ``replicates``.
    measured : xarray.Dataset
        The measured test, on the clock of the input.
    marker_noise : float
        [m]
    store : Store
        Of samples, so that a search that was cut goes on; it says a line for every mean.

    Returns
    -------
    FrictionCalibration
    beside : pandas.DataFrame
        By mean, medians over the replicates: ``coverage`` of the measured curves, its leave-one-out ``reference``
        and ``chance`` of whole curves, medians over the markers [1]; ``residual``, the largest over the markers of
        the samples' median residual relative to the slab [m].
    """
    distributions = ensemble["distributions"]
    drawn = replicated_designs(
        search["replicates"], search["size"], ensemble["seed"], distributions=distributions
    )
    designs = [one.values for one in drawn]
    if model_of(runs.model).calibrated:
        waves = store._replace(source=source_digest(*script_sources("calibrate_stiffness")))
        designs = [
            pd.concat([design, calibrate_design(runs.case["structure"], design, runs.linked, waves)], axis=1)
            for design in designs
        ]
    seeds = [replicate_seed(ensemble["seed"], place) for place in range(1, len(designs) + 1)]
    motions = [driving_motions(runs.case, base, seed) for seed in seeds]
    beside = {}

    def evaluate(mean):
        scores, covered = [], []
        for index, design in enumerate(designs):
            rows = with_mean(design, distributions, search["variables"], mean)
            quiet = store._replace(say=lambda line: None)
            members = join_batches(simulate_samples(runs, motions[index], rows, quiet))
            scores.append(mean_score(members, measured, marker_noise, seed=index))
            covered.append(_beside(members, measured, marker_noise))
        beside[mean] = pd.DataFrame(covered).median()
        store.say(
            f"mean friction {mean:g}: score {1e3 * sum(scores) / len(scores):.3f} mm of {len(scores)} ensembles"
        )
        return scores

    found = search_mean(evaluate, search["lowest"], search["highest"], search["step"], search["finest"])
    store.say(found.answer)
    return found, pd.DataFrame(beside).T.rename_axis("mean").sort_index()


def friction_summary(found, beside, search, measured):
    """A calibration as JSON-like values, with what it was made of; refused bounds that are missing are null.

    Where the measured curves are unlike those of the best mean's ensembles too, the differences between means say
    nothing of friction, and the answer is that no mean fits.
    """
    fits = is_likely(beside["chance"].loc[found.best], search["size"])
    return {
        "answer": found.answer if fits else "unknown: no mean fits the measured curves",
        "best": found.best,
        "lower": None if np.isnan(found.lower) else found.lower,
        "upper": None if np.isnan(found.upper) else found.upper,
        "synthetic": int(measured.attrs.get("synthetic", 0)),
        **search,
        "means": found.table.join(beside).reset_index().to_dict("list"),
    }


def _beside(members, measured, marker_noise):
    """Figures told beside the score of one ensemble."""
    compared = coverage(measured, members, marker_noise)
    residual = np.abs(members["residual"].sel(frame="slab")).median("sample")
    return {
        "chance": float(compared["curve_probability"].median()),
        "coverage": float(compared["coverage"].median()),
        "reference": float(compared["reference"].sel(quantile=0.5).median()),
        "residual": float(residual.max()),
    }
