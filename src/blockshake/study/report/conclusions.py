"""Conclusions of a study in computed sentences, for whoever must decide: by case, and what is not known."""

from itertools import chain, combinations

import numpy as np

from blockshake.pages.blocks import Heading, Items
from blockshake.pages.rows import face_markers
from blockshake.pages.wording import (
    given,
    millimetres,
    model_label,
    number,
    parameter_label,
    percent,
    quantile_percent,
    share_words,
)
from blockshake.statistics.intervals import CONFIDENCE, SURE_FROM, samples_needed
from blockshake.study.calibration.calibration import ALL
from blockshake.study.ensembles.coverage import is_likely
from blockshake.study.ensembles.envelope import counted_samples
from blockshake.study.ensembles.outcomes import count_outcomes, shortfall
from blockshake.study.fragility.section import words as fragility_words
from blockshake.study.sensitivity.findings import influences, is_known

_UPPER = 0.95  # quantile that stands for a large peak


def conclusions(content):
    """Blocks: what was found in every case, then what is not known."""
    blocks = []
    for case in content.cases.values():
        sentences = _case(case)
        if sentences and case.name in content.fragility:
            sentences.append(f"Fragility: {fragility_words(content, case.name)}")
        if sentences:
            blocks += [
                Heading(
                    f"{case.title}, {case.motion} x {given(case.settings['scale'])}", f"found-{case.name}"
                ),
                Items(tuple(sentences)),
            ]
    unknown = _unknown(content)
    return (
        [*blocks, Heading("Not known from this study", "not-known"), Items(tuple(unknown))]
        if unknown
        else blocks
    )


def _case(case):
    """Sentences on one case; none where no sample has a result."""
    counted = {model: one for model, one in case.responses.items() if int(one.envelope.attrs["counted"])}
    if not counted:
        return []
    body, marker = next(iter(face_markers(case.structure).items()))
    return [
        _drift(case, counted, body, marker),
        _collapse(counted),
        _joints(counted),
        *_models(counted, marker),
        *_measured(case, counted, body, marker),
        *_causes(counted, body, marker),
    ]


def _drift(case, counted, body, marker):
    """Peak of the top block, by the statistics that so many samples bear, and the share beyond the limit."""
    by_model = []
    for model, response in counted.items():
        size, peak = (
            int(response.envelope.attrs["counted"]),
            response.envelope.sel(frame="slab", marker=marker),
        )
        largest = counted_samples(response.samples)["peak"].sel(frame="slab", marker=marker).max()
        statistics = [
            f"{words} {millimetres(at['peak'])} mm [{', '.join(map(millimetres, at['peak_interval']))}]"
            for words, quantile in (("median", 0.5), (f"{quantile_percent(_UPPER)} of all below", _UPPER))
            if np.isfinite(
                (at := peak.sel(quantile=quantile, bound=["lower", "upper"]))["peak_interval"]
            ).all()
        ]
        by_model.append(
            f"{', '.join([*statistics, f'largest {millimetres(largest)} mm'])} by {model_label(model)} (n = {size})"
        )
    limit = next(iter(counted.values())).envelope["drift_probability"].attrs["largest_drift"]
    beyond = [
        f"{percent(value)} % by {model_label(model)}"
        for model, one in counted.items()
        if (value := float(one.envelope["drift_probability"].sel(marker=marker))) > 0.0
    ]
    return (
        f"Peak displacement of the top block ({body}, marker {marker}) from its place on the slab, with "
        f"{quantile_percent(CONFIDENCE)} limits where the samples bear them: {'; '.join(by_model)}. "
        + (
            f"Of the samples, beyond {millimetres(limit)} mm or fallen: {', '.join(beyond)}."
            if beyond
            else f"No sample moves it by more than {millimetres(limit)} mm."
        )
    )


def _collapse(counted):
    """Probability of collapse with its limits, and the samples that still fell when the window ended."""
    shares, falling = [], []
    for model, response in counted.items():
        one, size = response.envelope, int(response.envelope.attrs["counted"])
        share = float(one["collapse_probability"])
        lower, upper = map(percent, one["collapse_probability_interval"].sel(bound=["lower", "upper"]))
        words = f"{percent(share)} % [{lower}, {upper}]" if share else f"below {upper} %"
        shares.append(f"{words} by {model_label(model)} (n = {size})")
        if still := count_outcomes(response.samples["status"]).falling:
            falling.append(f"{still} of {size} by {model_label(model)}")
    any_fell = any(float(one.envelope["collapse_probability"]) > 0.0 for one in counted.values())
    verdict = "Collapse is found" if any_fell else "No sample collapses"
    words = f"{verdict}. Probability of collapse, {quantile_percent(CONFIDENCE)} limits: {', '.join(shares)}."
    if falling:
        words += f" Counted as collapsed, but still falling when the window ended: {', '.join(falling)}."
    return words


def _joints(counted):
    """The joint that opens most and the one that slips most by any model."""
    words = []
    for name, motion in (("joint_uplift", "opening"), ("joint_slip", "slip")):
        largest = []
        for model, response in counted.items():
            values = response.envelope[name].sel(quantile=0.5).dropna("joint")
            if values.size:
                at = values[values.argmax("joint")]
                largest.append((float(at), str(at["joint"].values), model_label(model)))
        if largest:
            value, joint, model = max(largest)
            words.append(f"the largest {motion} is that of {joint}, {millimetres(value)} mm ({model})")
    if not words:
        return "The structure has no joints at its start."
    return f"T{' and '.join(words)[1:]}, median over the samples at the middle of the face."


def _models(counted, marker):
    """Whether the medians of the models, of samples enough for limits, differ by more than these."""
    at = {"frame": "slab", "marker": marker, "quantile": 0.5}
    known = [model for model, one in counted.items() if int(one.envelope.attrs["counted"]) >= SURE_FROM]
    if len(known) < 2:
        return []
    medians = {model: float(counted[model].envelope["peak"].sel(at)) for model in known}
    limits = {model: counted[model].envelope["peak_interval"].sel(at).to_numpy() for model in known}
    apart = [
        f"{model_label(one)} and {model_label(other)}"
        for one, other in combinations(known, 2)
        if max(limits[one].min(), limits[other].min()) > min(limits[one].max(), limits[other].max())
    ]
    low, high = min(medians, key=medians.get), max(medians, key=medians.get)
    spread = (
        f"Median peaks of the models lie between {millimetres(medians[low])} mm ({model_label(low)}) and "
        f"{millimetres(medians[high])} mm ({model_label(high)})"
    )
    if not apart:
        return [f"{spread}; the limits of every two of them overlap."]
    pairs = ", ".join(apart)
    return [f"{spread}; the limits of these do not overlap: {pairs}. The choice of the model matters here."]


def _measured(case, counted, body, marker):
    """Measured peak beside the models, whether the measured curve may be one of the samples, and the lowest score."""
    if case.measured is None or marker not in case.measured["marker"].values:
        return []
    word = case.curve_word
    peak = millimetres(case.measured["peak"].sel(frame="slab", marker=marker))
    fits, misses = [], []
    for model, response in counted.items():
        chance = float(response.comparison["curve_probability"].sel(marker=marker))
        if np.isfinite(chance):
            likely = is_likely(chance, int(response.comparison.attrs["counted"]))
            size = int(response.comparison.attrs["counted"])
            (fits if likely else misses).append(
                f"{model_label(model)} (chance {number(chance, 2)}, n = {size})"
            )
    words = f"The {word} of {body} peaks at {peak} mm."
    if fits:
        words += f" As a whole the curve may be one more sample: {', '.join(fits)}."
    if misses:
        words += f" It is farther from the samples than they are from each other: {', '.join(misses)}."
    scores = case.differences["score"].dropna("model")
    if scores.size > 1:
        best = model_label(str(scores["model"].values[scores.argmin("model")]))
        words += f" The lowest score against all blocks is that of {best}."
    return [words]


def _causes(counted, body, marker):
    """The variable that explains most of the spread beyond chance, models of the same variable together."""
    by_variable, silent = {}, []
    for model, response in counted.items():
        history = response.sensitivity.sel(quantity="history", marker=marker)
        if not is_known(history, "first_order"):
            continue
        beyond = influences(history, "first_order").beyond_chance
        if beyond:
            by_variable.setdefault(beyond[0].parameter, []).append(
                f"{percent(beyond[0].value)} % by {model_label(model)}"
            )
        else:
            silent.append(model_label(model))
    words = [f"{parameter_label(name)}, {', '.join(shares)}" for name, shares in by_variable.items()]
    if words:
        explained = (
            f"Largest share of the spread of {body} over the window by one variable: {'; '.join(words)}."
        )
        return [
            explained + (f" No variable stands out from chance by {', '.join(silent)}." if silent else "")
        ]
    return [f"No single variable is shown to explain the spread of {body} over the window."] if silent else []


def _unknown(content):
    """Sentences on what these results leave open."""
    cases = list(content.cases.values())
    sentences = []
    without = [case.name for case in cases if case.measured is None]
    synthetic = [case.name for case in cases if case.synthetic]
    if without or synthetic:
        named = [f"{', '.join(without)} (no measured test)"] if without else []
        named += [f"{', '.join(synthetic)} (synthetic tests)"] if synthetic else []
        sentences.append(f"Whether any model is right about real blocks: {'; '.join(named)}.")
    few, few_from = {}, samples_needed(_UPPER)
    for case in cases:
        for model, one in case.responses.items():
            size = int(one.envelope.attrs["counted"])
            if size < few_from:
                few.setdefault(f"{model_label(model)} (n = {size})", []).append(case.name)
    if few:
        words = "; ".join(f"{model}, {', '.join(names)}" for model, names in few.items())
        sentences.append(
            f"How large the {quantile_percent(_UPPER)} quantile is, of which fewer than {few_from} samples bear no "
            f"limits: {words}."
        )
    short = [
        f"{case.name} ({given(case.settings['duration'])} s of a motion that is strong until {number(end)} s)"
        for case in cases
        if case.settings["duration"] < (end := float(content.motions[case.motion].attrs["significant_end"]))
    ]
    if short:
        sentences.append(
            f"Whether blocks fall after the window, which ends in the strong motion: {', '.join(short)}."
        )
    cut = [
        f"{model_label(model)}, {case.name}"
        for case in cases
        for model, one in case.responses.items()
        if float(one.envelope["collapse_probability"]) > 0.0
    ]
    if cut:
        sentences.append(
            f"How far blocks of samples that fell would have moved, peaks are lower limits: {'; '.join(cut)}."
        )
    failed = [
        f"{model_label(model)}, {case.name} ({share_words(lost, one.samples.sizes['sample'])})"
        for case in cases
        for model, one in case.responses.items()
        if (lost := shortfall(one.envelope).failed)
    ]
    if failed:
        sentences.append(
            f"How samples end that failed for a numerical reason: {'; '.join(failed)}. No statistic counts them; the "
            "limits of probabilities allow for either end."
        )
    chaotic = _chaotic(cases)
    if chaotic:
        sentences.append(
            "Single histories after the time at which twins, alike to one part in a million of the motion or run at "
            f"half the time step, are told apart: {'; '.join(chaotic)}. Bounds and quantiles remain."
        )
    calibrated = chain.from_iterable((content.study.get("calibration") or {"cases": {}})["cases"].values())
    assumed = sorted({case.name for case in cases} - set(calibrated))
    if assumed:
        sentences.append(f"The mean friction, which is assumed and not calibrated: {', '.join(assumed)}.")
    unanswered = [
        parameter_label(name)
        for name, one in (content.calibration or {"parameters": {}})["parameters"].items()
        if name.startswith("friction.") and not one["answers"][ALL]["told"]
    ]
    if unanswered:
        sentences.append(f"Frictions of which the open tests tell nothing: {'; '.join(unanswered)}.")
    return sentences


def _chaotic(cases):
    """Models with the earliest time at which their twins part within the window [s], in words by case."""
    by_case = []
    for case in cases:
        horizons = case.differences["horizon"].min("twin")
        parted = [
            f"{model_label(model)} {number(horizons.sel(model=model))} s"
            for model in horizons["model"].values
            if float(horizons.sel(model=model)) < case.settings["duration"]
        ]
        if parted:
            by_case.append(f"{case.name}, {', '.join(parted)}")
    return by_case
