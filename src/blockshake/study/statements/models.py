"""Statements on the models beside each other and beside the tests."""

import numpy as np

from blockshake.pages.rows import face_markers
from blockshake.pages.wording import model_label, number, percent, share_words
from blockshake.statistics.intervals import SURE_FROM
from blockshake.study.analyses import OF_THE_PAPER
from blockshake.study.ensembles.coverage import UNLIKELY, is_likely
from blockshake.study.ensembles.envelope import counted_samples
from blockshake.study.statements.solvers import RIGID
from blockshake.study.statements.statement import PaperVerdict, against_tests, compared, judged, unjudged

_ELASTIC, _VISCOELASTIC = "nscd-elastic", "nscd-viscoelastic"
_NEARER, _FARTHER, _UNDECIDED, _UNKNOWN = "nearer", "farther", "not told apart", "too few samples"
_NO_FIT = f"A chance of {percent(UNLIKELY)} % or less, or the lowest that the samples tell, counts as no fit."


def resemblance(content):
    """Measured curves within the envelopes, Figs. 11 to 14."""
    cases = compared(content)
    words, likely = [], []
    for case in cases:
        for model in case.responses:
            at = _of_blocks(case, model)
            chance = float(at["curve_probability"].median())
            if np.isnan(chance):
                continue  # too few samples
            likely.append(is_likely(chance, at.attrs["counted"]))
            words.append(
                f"{case.name}, {model_label(model)}: {percent(at['coverage'].median())} % of the time inside "
                f"(members {percent(at['reference'].sel(quantile=0.5).median())} %), chance {number(chance, 2)}"
            )
    if not words:
        return unjudged("The samples are too few to hold the curves against them.")
    sentence = f"Medians over the markers of the blocks: {'; '.join(words)}. {_NO_FIT}"
    return against_tests(cases, all(likely), sentence)


def best_model(content):
    """Viscoelastic blocks nearest to the tests of all configurations."""
    cases = {case.name: case for case in compared(content)}
    sides = [_side(cases.get(name), other) for name in OF_THE_PAPER for other in (RIGID, _ELASTIC)]
    nearer, farther, undecided, unknown = map(sides.count, (_NEARER, _FARTHER, _UNDECIDED, _UNKNOWN))
    words = (
        f"By continuous ranked probability scores, of {len(sides)} comparisons of two models {nearer} bear the "
        f"statement out, {farther} contradict it, {undecided} are not told apart by the intervals of their scores, and "
        f"{unknown} are of fewer than {SURE_FROM} samples or of cases that were not run."
    )
    if not farther and nearer < len(sides):
        return unjudged(words)
    return against_tests(cases.values(), not farther, words)


def _side(case, other):
    """Side of viscoelastic blocks from other ones, seen from the test of a case, by the interval of the difference of
    their scores, which holds a zero where they are not told apart."""
    if case is None or (case.differences["counted"].sel(model=[_VISCOELASTIC, other]) < SURE_FROM).any():
        return _UNKNOWN
    interval = case.differences["score_difference_interval"].sel(model=_VISCOELASTIC, other=other)
    lower, upper = (float(interval.sel(bound=one)) for one in ("lower", "upper"))
    if not np.isfinite(lower):
        return _UNKNOWN
    return _NEARER if lower > 0.0 else _FARTHER if upper < 0.0 else _UNDECIDED


def satisfactory(content, model, fails=()):
    """A model that fits all configurations but those that are named."""
    cases = [
        case
        for case in compared(content)
        if case.name in OF_THE_PAPER and case.responses[model].comparison["curve_probability"].notnull().any()
    ]
    if not cases:
        return unjudged("The samples are too few to hold the curves against them.")
    words, as_stated = [], []
    for case in cases:
        at = _of_blocks(case, model)
        chance = float(at["curve_probability"].median())
        as_stated.append(is_likely(chance, at.attrs["counted"]) == (case.name not in fails))
        words.append(f"{case.name} {number(chance, 2)}")
    absent = sorted(set(OF_THE_PAPER) - {case.name for case in cases})
    sentence = f"Chance of the measured curves, median over the markers of the blocks: {', '.join(words)}."
    if absent:
        sentence += f" Not in this study, or of fewer than three samples: {', '.join(absent)}."
    finding = against_tests(cases, all(as_stated), f"{sentence} {_NO_FIT}")
    return unjudged(f"{sentence} {_NO_FIT}") if absent and finding.verdict == PaperVerdict.MET else finding


def alike(content):
    """LS-DEM beside rigid and viscoelastic blocks in contact dynamics."""
    words, few, apart, beyond = [], [], 0, 0
    for case in content.cases.values():
        for other in (model for model in (RIGID, _VISCOELASTIC) if model in content.study["models"]):
            both = ["ls-dem", other]
            if int(case.differences["counted"].sel(model=both).min()) < SURE_FROM:
                few.append(f"{case.name}, {model_label(other)}")
                continue
            pair = case.differences.sel(model="ls-dem", other=other)
            distance, width = float(pair["distance"]), case.differences["width"].sel(model=both)
            widest = float(width.mean("marker").max())
            apart, beyond = apart + (distance > widest), beyond + (distance > float(pair["distance_chance"]))
            marker = next(iter(face_markers(case.structure).values()))
            at = {"frame": "slab", "marker": marker, "quantile": 0.5}
            peaks = [number(1e3 * float(case.responses[model].envelope["peak"].sel(at))) for model in both]
            words.append(
                f"{case.name}, {model_label(other)} {number(1e3 * distance)} mm beside {number(1e3 * widest)} mm, "
                f"median peaks at the top {' and '.join(peaks)} mm"
            )
    if not words:
        return unjudged("The samples are too few to hold the models against each other.")
    fewer = f" Of fewer than {SURE_FROM} samples, and not judged: {'; '.join(few)}." if few else ""
    return judged(
        not apart,
        "Energy distance of an ensemble of NSCD from that of LS-DEM, beside the mean difference of two samples of "
        f"the wider of both, means over times and the markers of all blocks: {'; '.join(words)}. Alike counts where "
        "the distance is the smaller one: two equal normal distributions may be about two standard deviations apart. "
        f"It is the larger one in {share_words(apart, len(words))} comparisons, and beyond that of samples "
        f"exchanged at random in {share_words(beyond, len(words))}.{fewer}",
    )


def _of_blocks(case, model):
    """A model's comparison with the measured curves at the markers of the blocks: the slab's own say nothing of it."""
    free = [
        body
        for body, driven in zip(case.structure.body_names, case.structure.driven, strict=True)
        if not driven
    ]
    comparison = case.responses[model].comparison
    on_blocks = {one.name for one in case.structure.file.markers if one.body in free}
    return comparison.sel(marker=[name for name in comparison["marker"].values if name in on_blocks])


def rotations(content):
    """Rotations within the noise of the measurement."""
    words, largest, cases = [], [], []
    for case in compared(content):
        shown = []
        for body, driven in zip(case.structure.body_names, case.structure.driven, strict=True):
            places = [np.array(one.position) for one in case.structure.file.markers if one.body == body]
            reach = max((np.hypot(*(a - b)[[0, 2]]) for a in places for b in places), default=0.0)
            if driven or reach == 0.0:
                continue
            turned = max(
                float(counted_samples(one.samples)["peak_rotation"].sel(body=body).median("sample"))
                for one in case.responses.values()
            )
            shown.append(turned / (np.sqrt(2.0) * case.marker_noise / reach))
        if shown:
            cases.append(case)
            largest.append(max(shown))
            words.append(f"{case.name} {number(min(shown), 2)} to {number(max(shown), 2)} times")
    if not words:
        return unjudged("No block of a measured test has two markers apart.")
    return against_tests(
        cases,
        max(largest) < 1.0,
        "Largest rotation of a block, the largest of the models' medians over samples, over the standard deviation of "
        "a rotation from the two markers of the block that are furthest apart, from block to block: "
        f"{'; '.join(words)}. Below 1 for all blocks counts as lost in the noise.",
    )
