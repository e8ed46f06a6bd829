"""Open questions of a study, and measures that would tell more, in computed sentences."""

from itertools import chain, count

import numpy as np

from blockshake.pages.rows import face_markers
from blockshake.pages.wording import (
    count_words,
    listed,
    model_label,
    number,
    parameter_label,
    percent,
    quantile_percent,
    share_words,
)
from blockshake.statistics.intervals import samples_needed, share_interval
from blockshake.study.calibration.calibration import ALL
from blockshake.study.ensembles.outcomes import count_outcomes
from blockshake.study.report.case_outcomes import models_apart, shares_at_impacts
from blockshake.study.sensitivity.findings import influences, is_known

MOST = 3  # sentences on the first page
ALIKE = 0.05  # of shares of the spin that impacts keep
_UPPER = 0.95  # quantile that stands for a large peak
_RARE = 0.05  # probability of a collapse that more samples are to exclude


def next_steps(content, found):
    """Measures that would tell more, the most telling first, each with the figure that it follows from."""
    steps, cases = [], content.cases
    short = [name for name in found if (one := cases[name]).settings["duration"] < strong_until(content, one)]
    for name in short[:1]:
        steps.append(
            f"Simulate {_named(short, cases)} until the strong motion ends: "
            f"{number(strong_until(content, cases[name]))} s of the record (key duration)."
        )
    moving = [
        name
        for name, ended in found.items()
        if any(not one.collapsed and np.isnan(one.end) for one in ended.values()) and name not in short
    ]
    if moving:
        steps.append(
            f"Simulate {_named(moving, cases)} for longer (key duration): blocks still move as the window ends."
        )
    apart = [one for name in found for one in models_apart(cases[name], found[name])]
    impacts = shares_at_impacts(cases[max(apart).case], max(apart)[-2:]) if apart else None
    if impacts and abs(impacts[1][0] - impacts[1][1]) > ALIKE:
        near, far = map(model_label, max(apart)[-2:])
        steps.append(
            f"Let a block rock and measure the spin that impacts keep: {impacts[1][0]:.2f} by {near}, "
            f"{impacts[1][1]:.2f} by {far} ({impacts[0]})."
        )
    # samples that differ by less than a marker tells are one run, and more of them say no more
    stand = [
        one.counted
        for name, ended in found.items()
        for one in ended.values()
        if not one.collapsed and (one.counted == 1 or one.most - one.least > cases[name].marker_noise)
    ]
    enough = next(size for size in count(1) if share_interval(0, size)[1] <= _RARE)
    fewest = min(stand, default=enough)
    if fewest < enough:
        now = f"now {100.0 * share_interval(0, fewest)[1]:.0f} % ({count_words(fewest, 'sample')})"
        steps.append(
            f"Run {enough} samples a model (key ensemble.size): if none collapses, the probability is below "
            f"{100.0 * _RARE:.0f} %, {now}."
        )
    if not content.fragility and any(one.collapsed for ended in found.values() for one in ended.values()):
        steps.append("Let samples climb a ladder of intensities until each falls (key fragility).")
    by_variable = {}
    for name, ended in found.items():
        for model, one in ended.items():
            history = cases[name].responses[model].sensitivity.sel(quantity="history", marker=one.marker)
            # a spread below a marker's noise needs no explanation
            seen = float(history["spread"]) >= cases[name].marker_noise
            if seen and is_known(history, "first_order"):
                first = influences(history, "first_order")[0]
                if first.beyond_chance:
                    by_variable.setdefault(first.parameter, []).append((first.value, one.block, name, model))
    for parameter, shares in sorted(by_variable.items(), key=lambda item: -max(item[1])[0])[:1]:
        value, block, name, model = max(shares)
        steps.append(
            f"Measure {parameter_label(parameter)}: it explains {percent(value)} % of the spread of {block} "
            f"({name}, {model_label(model)})."
        )
    if real := [case.name for case in cases.values() if case.measured is None or case.synthetic]:
        has = "has" if len(real) == 1 else "have"
        steps.append(f"Compare with a measured test (key measured): {_named(real, cases)} {has} none.")
    return steps


def _named(names, cases):
    """Some cases by name, or that it is all of many."""
    return f"all {len(cases)} cases" if len(names) == len(cases) > MOST else listed(names)


def strong_until(content, case):
    """End of the strong motion of a case [s]."""
    return float(content.motions[case.motion].attrs["significant_end"])


def unknown(content):
    """Sentences on what the results leave open, the gravest first."""
    cases, sentences = list(content.cases.values()), []
    named = [
        (word, [case.name for case in cases if is_so(case)])
        for word, is_so in (
            ("no measured test", lambda case: case.measured is None),
            ("synthetic tests alone", lambda case: case.synthetic),
        )
    ]
    if any(names for _, names in named):
        words = "; ".join(f"{_named(names, cases)} ({word})" for word, names in named if names)
        sentences.append(f"Whether any model is right about real blocks: {words}.")
    if short := [case.name for case in cases if case.settings["duration"] < strong_until(content, case)]:
        sentences.append(
            f"Whether blocks fall after the window, which ends in the strong motion: {_named(short, cases)}."
        )
    falling = _by_model(cases, lambda one: _ended(one).falling)
    if falling:
        sentences.append(
            f"Whether samples that fall as the window ends, and count as collapses, are caught: {listed(falling)}."
        )
    calibrated = chain.from_iterable((content.study.get("calibration") or {"cases": {}})["cases"].values())
    if assumed := sorted({case.name for case in cases} - set(calibrated)):
        sentences.append(f"The mean friction, which is assumed and not calibrated: {_named(assumed, cases)}.")
    bare = {
        case.structure.file.name: f"{int((~case.structure.driven).sum()) - marked} of {case.structure.file.name}"
        for case in cases
        if (marked := len(face_markers(case.structure))) < int((~case.structure.driven).sum())
    }
    if bare:
        sentences.append(f"How far blocks without a marker move: {listed(list(bare.values()))}.")
    cut = _by_model(cases, lambda one: _ended(one).collapsed + _ended(one).falling)
    if cut:
        sentences.append(f"How far blocks that fell would have moved, peaks are lower limits: {listed(cut)}.")
    failed = _by_model(cases, lambda one: _ended(one).failed)
    if failed:
        sentences.append(
            f"How samples end that failed for a numerical reason: {listed(failed)}. No statistic counts them; the "
            "limits of probabilities allow for either end."
        )
    if chaotic := _chaotic(cases):
        sentences.append(
            f"How a single run goes on: {'; '.join(chaotic)}. From then on half the time step leads elsewhere; medians "
            "and bands remain."
        )
    unanswered = [
        parameter_label(name)
        for name, one in (content.calibration or {"parameters": {}})["parameters"].items()
        if name.startswith("friction.") and not one["answers"][ALL]["told"]
    ]
    if unanswered:
        sentences.append(f"Frictions of which the open tests tell nothing: {'; '.join(unanswered)}.")
    few_from = samples_needed(_UPPER)
    if any(
        int(one.envelope.attrs["counted"]) < few_from for case in cases for one in case.responses.values()
    ):
        sentences.append(
            f"How large the {quantile_percent(_UPPER)} quantile of a peak is: fewer than {few_from} samples bear no "
            "limits."
        )
    return sentences


def _ended(one):
    return count_outcomes(one.samples["status"])


def _by_model(cases, count):
    """Cases with the models of which some samples count, and their share of all samples, in words."""
    return [
        f"{case.name} by {model_label(model)} ({share_words(some, one.samples.sizes['sample'])})"
        for case in cases
        for model, one in case.responses.items()
        if (some := count(one))
    ]


def _chaotic(cases):
    """Models with the time at which a sample and its twin part within the window [s], in words by case."""
    by_case = []
    for case in cases:
        horizons = case.differences["horizon"]
        parted = [
            f"{number(horizons.sel(model=model))} s by {model_label(model)}"
            for model in horizons["model"].values
            if float(horizons.sel(model=model)) < case.settings["duration"]
        ]
        if parted:
            by_case.append(f"{case.name} after {listed(parted)}")
    return by_case
