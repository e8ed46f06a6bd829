"""Statements on the models beside each other and beside the tests."""

import numpy as np

from blockshake.report.document.rows import face_markers
from blockshake.report.document.wording import model_label, number, percent, share_words
from blockshake.report.study.models.words import order_words
from blockshake.report.study.statements.specimens import HEIGHTS
from blockshake.report.study.statements.statement import against_tests, compared, judged, missing, unjudged
from blockshake.study.comparison.ranking import CLAIMS, MET, OPEN, judge
from blockshake.study.ensembles.coverage import is_likely

_RIGID, _ELASTIC, _VISCOELASTIC = "nscd-rigid", "nscd-elastic", "nscd-viscoelastic"
_NO_TEST = "This study has no measured test."


def resemblance(content):
    """Measured curves within the envelopes, Figs. 11 to 14."""
    cases = compared(content)
    if not cases:
        return unjudged(_NO_TEST)
    told, holds = [], True
    for case in cases:
        for model, one in case.responses.items():
            found = one.comparison
            chance = float(found["curve_probability"].median())
            if np.isnan(chance):
                continue  # too few samples
            holds = holds and is_likely(chance, found.attrs["counted"])
            told.append(
                f"{case.name}, {model_label(model)}: {percent(found['coverage'].median())} % of the time inside "
                f"(members {percent(found['reference'].sel(quantile=0.5).median())} %), chance {number(chance, 2)}"
            )
    return against_tests(cases, holds, f"Medians over the markers: {'; '.join(told)}.")


def best_model(content):
    """Viscoelastic blocks nearest to the tests."""
    models = (_RIGID, _ELASTIC, _VISCOELASTIC)
    if absent := missing(content, *models):
        return unjudged(f"{absent} config/paper.yaml has them.")
    cases = compared(content)
    if not cases:
        return unjudged(_NO_TEST)
    found = judge(CLAIMS[0], {case.name: case.differences for case in cases})
    words = f"By continuous ranked probability scores, {order_words(found)}."
    if found.by_scores == OPEN:
        return unjudged(words)
    return against_tests(cases, found.by_scores == MET, words)


def satisfactory(content, model, fits, fails=()):
    """A model that fits some configurations and not others, named by their numbers."""
    if absent := missing(content, model):
        return unjudged(f"{absent} config/paper.yaml has it.")
    cases = [
        case
        for case in compared(content)
        if case.name in HEIGHTS and case.responses[model].comparison["curve_probability"].notnull().any()
    ]
    if not cases:
        return unjudged(_NO_TEST)
    expected = {f"configuration-{place}": place in fits for place in (*fits, *fails)}
    told, holds = [], True
    for case in cases:
        found = case.responses[model].comparison
        chance = float(found["curve_probability"].median())
        holds = holds and expected.get(case.name, True) == is_likely(chance, found.attrs["counted"])
        told.append(f"{case.name} {number(chance, 2)}")
    absent = sorted(set(expected) - {case.name for case in cases})
    words = f"Chance of the measured curves, median over the markers: {', '.join(told)}."
    return against_tests(
        cases,
        holds,
        words
        + (f" Not in this study, or of fewer than three samples: {', '.join(absent)}." if absent else ""),
    )


def alike(content):
    """LS-DEM beside rigid blocks in contact dynamics."""
    if absent := missing(content, "ls-dem", _RIGID):
        return unjudged(absent)
    told, holds = [], True
    for case in content.cases.values():
        markers = list(face_markers(case.structure).values())
        peaks = [case.responses[model].envelope["peak"].sel(frame="slab") for model in ("ls-dem", _RIGID)]
        inside = sum(_overlap(*(one.sel(marker=marker) for one in peaks)) for marker in markers)
        holds = holds and inside == len(markers)
        top = [1e3 * float(one.sel(marker=markers[0], quantile=0.5)) for one in peaks]
        told.append(
            f"{case.name} {share_words(inside, len(markers))}, median at the top {number(top[0])} and "
            f"{number(top[1])} mm"
        )
    return judged(
        holds,
        "Blocks of which the peaks of LS-DEM and of rigid NSCD have ranges from 5 to 95 % that overlap: "
        f"{'; '.join(told)}.",
    )


def _overlap(first, second):
    """Whether two models' peaks of one block have ranges in common."""
    low, high = ([float(one.sel(quantile=quantile)) for one in (first, second)] for quantile in (0.05, 0.95))
    return max(low) <= min(high)


def rotations(content):
    """Rotations within the noise of the measurement."""
    told, holds = [], True
    for case in compared(content):
        floors, turned = [], []
        for body, driven in zip(case.structure.body_names, case.structure.driven, strict=True):
            places = [np.array(one.position) for one in case.structure.file.markers if one.body == body]
            if driven or len(places) < 2:
                continue
            reach = max(np.hypot(*(a - b)[[0, 2]]) for a in places for b in places)
            floors.append(np.sqrt(2.0) * case.marker_noise / reach)
            turned.append(
                max(
                    float(one.samples["peak_rotation"].sel(body=body).median("sample"))
                    for one in case.responses.values()
                )
            )
        if floors:
            holds = holds and max(floors) > max(turned)
            told.append(
                f"{case.name} {number(1e3 * max(floors), 2)} mrad beside {number(1e3 * max(turned))} mrad"
            )
    if not told:
        return unjudged("No block of a measured test has two markers.")
    return against_tests(
        compared(content),
        holds,
        "Standard deviation of a rotation from the two markers of a block that are furthest apart, beside the largest "
        f"rotation of the models, median over samples: {'; '.join(told)}.",
    )
