"""Open questions of a study, and measures that would answer some: each with the figure that it follows from."""

from itertools import chain, count

import numpy as np

from blockshake.pages.rows import face_markers
from blockshake.pages.words import Words
from blockshake.statistics.intervals import samples_needed, share_interval
from blockshake.study.calibration.calibration import ALL
from blockshake.study.comparison.paired import ALIKE
from blockshake.study.ensembles.outcomes import count_outcomes
from blockshake.study.report.case_outcomes import evidence, outcomes
from blockshake.study.sensitivity.findings import influences, is_known

MOST = 3  # sentences on the first page
_UPPER = 0.95  # quantile that stands for a large peak
_RARE = 0.05  # probability of a collapse that more samples are to exclude
_WIDE = 0.2  # width of the limits of a probability from which on more samples are advised
_PHRASES = Words(__name__)


def next_steps(content, stripes, found, apart, theory):
    """Measures that would tell more, the most telling first.

    ``stripes``: `Stripe` by name; ``found``, ``apart`` and ``theory``: what `answer` tells of them.
    """
    cases, best = content.cases, {name: evidence(ended) for name, ended in found.items()}
    in_cases = {name: {} for name in cases}
    for name, ended in best.items():
        in_cases[stripes[name].case.name][name] = ended
    short = [name for name, case in cases.items() if case.settings["duration"] < strong_until(content, case)]
    moving = [
        name
        for name, of_case in in_cases.items()
        if name not in short
        and any(
            not one.collapsed and np.isnan(one.end) for ended in of_case.values() for one in ended.values()
        )
    ]
    parted = next((theory[one.stripe] for one in apart if len(theory[one.stripe].kept) > 1), None)
    if parted and abs(np.subtract(*parted.kept.values())) <= ALIKE:
        parted = None
    return _PHRASES.items(
        "next",
        every=len(cases),
        short=short,
        until=max((strong_until(content, cases[name]) for name in short), default=0.0),
        moving=moving,
        parted=parted,
        samples=_samples(stripes, best),
        climb=not content.fragility
        and any(one.collapsed for ended in found.values() for one in ended.values()),
        strongest=_strongest(stripes, best),
        unmeasured=[case.name for case in cases.values() if case.measured is None or case.synthetic],
    )


def _samples(stripes, best):
    """Samples that would narrow the widest probability, and what is known of it now; None if there are enough."""
    enough = next(size for size in count(1) if share_interval(0, size)[1] <= _RARE)
    open_now = []
    for name, ended in best.items():
        for model, one in ended.items():
            lower, upper = one.limits
            # samples that differ by less than a marker tells are one run, and more of them say no more
            differ = (
                one.counted == 1 or one.collapsed or one.most - one.least > stripes[name].case.marker_noise
            )
            if differ and (upper - lower > _WIDE if one.collapsed else one.counted < enough):
                open_now.append((upper - lower, name, model, one))
    if not open_now:
        return None
    _, name, model, one = max(open_now, key=lambda item: item[0])
    levels = len(stripes[name].case.stripes)
    # limits of a share shrink with the root of the number: four times as many halve them
    size = 4 * one.counted if one.collapsed else enough
    return {"size": size * levels, "levels": levels, "place": name, "model": model, "one": one, "rare": _RARE}


def _strongest(stripes, best):
    """The variable that explains most of the spread of a block, of spreads beyond a marker's noise; None without."""
    shares = []
    for name, ended in best.items():
        for model, one in ended.items():
            case = stripes[name].case
            history = stripes[name].responses[model].sensitivity.sel(quantity="history", marker=one.marker)
            if not float(history["spread"]) >= case.marker_noise or not is_known(history, "first_order"):
                continue
            first = influences(history, "first_order")[0]
            if first.beyond_chance and not first.control:
                shares.append((first.value, first.parameter, one.block, name, model))
    return max(shares, default=None)


def strong_until(content, case):
    """End of the strong motion of a case [s]."""
    return float(content.motions[case.motion].attrs["significant_end"])


def unknown(content):
    """Sentences on what the results leave open, the gravest first."""
    cases = list(content.cases.values())
    calibrated = chain.from_iterable((content.study.get("calibration") or {"cases": {}})["cases"].values())
    bare = {
        case.structure.file.name: blocks - marked
        for case in cases
        if (marked := len(face_markers(case.structure))) < (blocks := int((~case.structure.driven).sum()))
    }
    parameters = (content.calibration or {"parameters": {}})["parameters"]
    few_from = samples_needed(_UPPER)
    counted = [int(one.envelope.attrs["counted"]) for case in cases for one in case.responses.values()]
    return _PHRASES.items(
        "unknown",
        every=len(cases),
        unmeasured=[case.name for case in cases if case.measured is None],
        synthetic=[case.name for case in cases if case.synthetic],
        short=[case.name for case in cases if case.settings["duration"] < strong_until(content, case)],
        alike=_alike(content.stripes),
        falling=_by_model(cases, lambda ended: ended.falling),
        assumed=sorted({case.name for case in cases} - set(calibrated)),
        bare=bare,
        cut=sum(some for *_, some, _ in _by_model(cases, lambda ended: ended.collapsed + ended.falling)),
        failed=_by_model(cases, lambda ended: ended.failed),
        chaotic=_chaotic(content.stripes),
        unanswered=[
            name
            for name, one in parameters.items()
            if name.startswith("friction.") and not one["answers"][ALL]["told"]
        ],
        few_from=few_from if min(counted) < few_from else 0,
        upper=_UPPER,
    )


def _alike(stripes):
    """Stripes in which no variable changes the displacement of any block by more than the noise of a marker."""

    def is_alike(end, noise):
        return end.counted > 1 and not end.collapsed and end.most - end.least <= noise

    found = {one.name: (outcomes(one).values(), one.case.marker_noise) for one in stripes}
    return [
        name for name, (ended, noise) in found.items() if ended and all(is_alike(end, noise) for end in ended)
    ]


def _by_model(cases, count):
    """Case, model, the samples that ``count`` finds among the outcomes, and of how many."""
    return [
        (case.name, model, some, one.samples.sizes["sample"])
        for case in cases
        for model, one in case.responses.items()
        if (some := count(count_outcomes(one.samples["status"])))
    ]


def _chaotic(stripes):
    """Time by case, or level, and model at which a sample and its replicate part within the window [s]."""
    return [
        (stripe.name, model, float(time))
        for stripe in stripes
        for model in stripe.responses
        if (time := stripe.differences["horizon"].sel(model=model)) < stripe.case.settings["duration"]
    ]
