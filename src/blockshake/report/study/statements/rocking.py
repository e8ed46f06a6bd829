"""Statements on the joints that open and slip."""

from blockshake.report.document.wording import given, model_label, number
from blockshake.report.study.statements.statement import judged, missing, scale_words, unjudged

_FIRST, _SECOND, _THIRD, _FOURTH = (f"configuration-{place}" for place in (1, 2, 3, 4))


def occurrences(content):
    """Joints that open, by configuration: the first has the fewest, LS-DEM."""
    if absent := missing(content, "ls-dem"):
        return unjudged(absent)
    if _FIRST not in content.cases or len(content.cases) < 2:
        return unjudged(f"This study lacks one of the cases to compare: it has {', '.join(content.cases)}.")
    opened = {name: _moved_joints(case, "ls-dem", "joint_uplift") for name, case in content.cases.items()}
    others = [count for name, count in opened.items() if name != _FIRST]
    turned = ", ".join(f"{name} {number(1e3 * _turned(case))} mrad" for name, case in content.cases.items())
    return judged(
        opened[_FIRST] < min(others),
        f"Joints whose middle opens by more than a marker's noise, median over the samples{scale_words(content)}: "
        f"{_counts(opened)}. Largest rotation of any block: {turned}.",
    )


def complicated(content):
    """Joints that open or slip, by configuration and model: more of them in configurations 3 and 4."""
    simple = [name for name in (_FIRST, _SECOND) if name in content.cases]
    walls = [name for name in (_THIRD, _FOURTH) if name in content.cases]
    if not simple or not walls:
        return unjudged(f"This study lacks one of the cases to compare: it has {', '.join(content.cases)}.")
    told, holds = [], True
    for model in content.study["models"]:
        for name, words in (("joint_uplift", "open"), ("joint_slip", "slip")):
            moved = {case: _moved_joints(content.cases[case], model, name) for case in (*simple, *walls)}
            holds = holds and max(moved[one] for one in simple) < min(moved[one] for one in walls)
            told.append(f"{model_label(model)}, that {words} {_counts(moved)}")
    return judged(
        holds,
        "Joints at whose middle the faces part or slip by more than a marker's noise, median over the "
        f"samples{scale_words(content)}: {'; '.join(told)}.",
    )


def _moved_joints(case, model, name):
    """Joints whose figure is beyond the markers' noise, median over the samples."""
    beyond = case.responses[model].samples[name] > case.marker_noise
    return float(beyond.sum("joint").median("sample"))


def _counts(moved):
    return ", ".join(f"{name} {given(count)}" for name, count in moved.items())


def _turned(case):
    """Largest rotation of any free block by LS-DEM, median over the samples [rad]."""
    free = [
        body
        for body, driven in zip(case.structure.body_names, case.structure.driven, strict=True)
        if not driven
    ]
    rotation = case.responses["ls-dem"].samples["peak_rotation"].sel(body=free).max("body")
    return float(rotation.median("sample"))
