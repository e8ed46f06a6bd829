"""Section on the fragility: how the probability of a potential collapse grows with the intensity."""

import numpy as np

from blockshake.dynamics.system import FALLEN
from blockshake.pages.blocks import Figure, Items, Section, Text
from blockshake.pages.drawing import svg_of
from blockshake.pages.wording import (
    SQUARED,
    count_words,
    given,
    limited,
    millimetre_range,
    model_label,
    number,
    percent,
    quantile_percent,
)
from blockshake.statistics.intervals import CONFIDENCE
from blockshake.study.ensembles.drift_limits import limits_joints
from blockshake.study.ensembles.outcomes import count_outcomes
from blockshake.study.fragility.cloud_section import cloud_blocks
from blockshake.study.fragility.figure import measure_words, plot_fragility
from blockshake.study.fragility.fragility import SAFE


def fragility(content):
    """Samples that climb the ladder of intensities or draw their motions; None where the study has neither."""
    blocks = [*(_climbs(content) if content.fragility else []), *cloud_blocks(content)]
    return Section("Fragility", "fragility", tuple(blocks)) if blocks else None


def _climbs(content):
    """Blocks on the samples that climb."""
    settings = content.study["fragility"]
    limits = millimetre_range(np.hstack([one["largest_drift"] for one in content.fragility.values()]))
    joints = limits_joints(content.study["ladder"]["largest_drift"])
    one = any(content.cases[name].settings.get("intensity") is None for name in content.fragility)
    return [
        Text(
            f"Samples that climb the ladder by {model_label(settings['model'])}: each is shaken by the case's "
            f"commanded "
            "motion at rising factors, from the restored stack each time, until it collapses, still falls as its "
            f"window ends, or the mass centre of a block moves from the slab by more than its limit, {limits} mm"
            f"{', or a joint slips by more than its own' if joints else ''}, "
            "which counts as a potential collapse. The capacity of a sample lies between the last factor that it "
            "passed and the first that it did not. Where these tell one, the figure has the lognormal distribution "
            "of largest likelihood for such bounds (incremental dynamic analysis, Vamvatsikos and Cornell 2002; "
            "fragility by maximum likelihood, Shinozuka et al. 2000). The spread is that of the sampled variables"
            + (
                ". The motion is one: another motion of the same peak has another fragility."
                if one
                else " and of the motions that the samples draw."
            )
        ),
        Items(tuple(words(content, name) for name in content.fragility)),
        Figure(
            "Largest displacement of the mass centre of a block from the slab over the limit of that block, up to "
            "twice of it, and probability of a potential collapse, by the factor of the motion. Its limits of 95 % "
            "are those of Clopper and Pearson, and hold either outcome of samples whose run ended for a numerical "
            f"reason. Dotted: {percent(SAFE)} %. The numbers of every level are in "
            f"results/{content.study['name']}/fragility.",
            svg_of(plot_fragility, content.fragility),
        ),
    ]


def words(content, name):
    """Factors at which samples reach a potential collapse, and what they do not tell, of one case in sentences."""
    result, case = content.fragility[name], content.cases[name]
    unit, measure = _unit(content, case)
    size = result.sizes["sample"]
    model = model_label(content.study["fragility"]["model"])
    who = f"{name}, {case.motion}, {size} samples by {model}"
    ended = count_outcomes(result["status"])
    less = _kinds(result) + "".join(
        f" The last run of {count_words(count, 'sample')} {how}."
        for count, how in (
            (ended.falling, "still fell when the window ended, which counts as a fall"),
            (ended.failed, "ended for a numerical reason"),
        )
        if count
    )
    median = float(result["median"])
    if not np.isfinite(median):
        passed = float(result["capacity_lower"].min())
        side = (
            f"all pass the highest factor that was climbed, {given(passed)}"
            if passed
            else f"none passes the lowest factor, {given(result['scale'][0])}"
        )
        return f"{who}: {side}, so that there is no fragility.{less}"
    if float(result["dispersion"]) == 0.0:
        low, high = float(result["capacity_lower"].max()), float(result["capacity_upper"].min())
        return (
            f"{who}: all samples reach a potential collapse between {given(low)} and {given(high)} times the motion "
            f"({number(low * unit)} and {number(high * unit)} {measure}). The levels are too far apart to tell "
            f"more.{less}"
        )
    # of a uniform spread over one step of the scales
    smallest_known = float(result["scale"][1] - result["scale"][0]) / median / np.sqrt(12.0)
    if float(result["dispersion"]) < smallest_known:
        less += (
            " The factors differ by less than the levels are apart: the dispersion, and with it the factor that "
            f"{percent(SAFE)} % are below, is bounded by the level below alone."
        )
    return (
        f"{who}: half of the samples reach a potential collapse below {limited(result, 'median')} times the motion "
        f"({number(median * unit)} {measure}), {percent(SAFE)} % below {limited(result, 'safe_scale')} "
        f"({number(float(result['safe_scale']) * unit)} {measure}); limits of {quantile_percent(CONFIDENCE)} in "
        f"brackets. Dispersion: {limited(result, 'dispersion')}.{less}"
    )


def _kinds(result):
    """How many potential collapses are falls and how many displacements, with their limit, and the ladder's step."""
    step = float(result["scale"][1] - result["scale"][0]) if result.sizes["scale"] > 1 else 0.0
    reached = np.isfinite(result["capacity_upper"].to_numpy())
    fell = int((reached & np.isin(result["status"].values, FALLEN)).sum())
    slid, limits = int(reached.sum()) - fell, millimetre_range(result["largest_drift"])
    words = f" The ladder climbs in steps of {given(step)}." if step else ""
    if not reached.any():
        return words
    if not fell:
        return f" None fell: every potential collapse is a displacement of more than the limit, {limits} mm.{words}"
    beyond = f" and {slid} displacements of more than the limit, {limits} mm" if slid else ""
    return f" The potential collapses are {count_words(fell, 'fall')}{beyond}.{words}"


def _unit(content, case):
    """Intensity of the factor 1, and its unit in words: peak acceleration, or the level that records are scaled to."""
    clouds = [one.cloud for one in case.responses.values() if one.cloud is not None]
    if not clouds or not clouds[0].attrs["levels"]:
        return content.motions[case.motion].attrs["peak_acceleration"], f"m/s{SQUARED}"
    name, unit = measure_words(clouds[0])
    return case.settings["intensity"]["levels"][0], f"{unit}, {name}"
