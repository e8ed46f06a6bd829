"""Sensitivities over all cases and models: the strongest variables, and the two statements of the paper."""

from blockshake.report.document.blocks import Items, Table, Text
from blockshake.report.document.rows import bodies_by_height, face_markers
from blockshake.report.document.wording import MISSING, given, model_label, number, share_words
from blockshake.report.study.sensitivity.figure import SHOWN
from blockshake.report.study.sensitivity.words import influence_words
from blockshake.study.sensitivity.findings import differs, influences, is_known
from blockshake.study.sensitivity.thickness import growth_with_structure, thickness


def markers_by_height(case):
    """Bodies that stand for the heights of a structure, with their markers, from the lowest up."""
    markers = face_markers(case.structure)
    return {body: markers[body] for body in bodies_by_height(case.structure, markers)}


def summary_table(content):
    """The strongest variable of every case and model, at its lowest and highest block, with interval and chance."""
    rows = []
    marks = {
        "line": "Line: samples that differ by less than the noise of a marker.",
        MISSING: "None: too few samples.",
    }
    for case in content.cases.values():
        shown = list(markers_by_height(case).items())
        for model, response in case.responses.items():
            for body, marker in (shown[0], shown[-1]):
                at = response.sensitivity.sel(marker=marker)
                spread = number(1e3 * at["spread"].sel(quantity="history"))
                rows.append((case.name, model_label(model), body, spread, *_strongest(at, case.marker_noise)))
    told = {cell for row in rows for cell in row}
    return Table(
        "Strongest variables at the lowest and the highest block. Spread: of the displacement relative to the slab, "
        "standard deviation over samples and time. Then the variable of the largest first-order share of the spread, "
        "and that of the largest partial rank correlation with the peak, each with its 95 % interval and, in round "
        f"brackets, the level of chance.{''.join(f' {words}' for mark, words in marks.items() if mark in told)}",
        ("Case", "Model", "Block", "Spread [mm]", "Largest share by itself [1]", "Largest rank correlation [1]"),
        tuple(rows), "lllrll",
    )  # fmt: skip


def _strongest(result, noise):
    """Strongest variable by each measure, in words."""
    history = result.sel(quantity="history")
    if is_known(history, "first_order") and not differs(history, noise):
        return ["line"] * len(SHOWN)
    cells = []
    for measure, (quantity, *_) in SHOWN.items():
        one = result.sel(quantity=quantity)
        if not is_known(one, measure):
            cells.append(MISSING)
            continue
        found = influences(one, measure)
        side = "beyond" if found.beyond_chance else "within"
        cells.append(f"{influence_words(found.ranked[0])} ({side} {found.chance:.2f})")
    return cells


def thickness_by_case(content, model):
    """`Thickness` of every case by a model, by the case's name."""
    return {
        case.name: thickness(
            case.responses[model].sensitivity, markers_by_height(case).values(), (~case.structure.driven).sum(),
            shaking(case),
        )
        for case in content.cases.values()
    }  # fmt: skip


def paper_discussion(content):
    """The two statements of the paper on thickness: it grows upward, and with the complexity of the structure."""
    cases = content.cases.values()
    told = []
    for model in content.study["models"]:
        told.append(f"{model_label(model)}: {_growth_words(thickness_by_case(content, model))}")
    return [
        Text(
            "Zhou et al. (2023) state that envelopes thicken upward and with the complexity of the structure, here "
            "taken as its number of free bodies. Thickness: standard deviation of the completed samples over "
            f"samples and time. {_shaking_words(cases)}"
        ),
        Items(tuple(told)),
    ]


def shaking(case):
    """Whatever tells the shaking of two cases apart: motion, scale, window."""
    return case.motion, case.settings["scale"], case.settings["duration"]


def _shaking_words(cases):
    shaken = {case.name: shaking(case) for case in cases}
    if len(set(shaken.values())) == 1:
        motion, scale, _ = next(iter(shaken.values()))
        return (
            f"All cases are shaken alike ({motion}, scale {given(scale)}), so that a difference between them is one "
            "of the structures."
        )
    words = ", ".join(
        f"{name} by {motion} at scale {given(scale)} for {given(duration)} s"
        for name, (motion, scale, duration) in shaken.items()
    )
    return (
        f"The cases are shaken differently ({words}), so that a difference between them has other causes too."
    )


def _growth_words(found):
    """Spreads of the cases by one model, and whether they bear both statements out."""
    known = {name: one for name, one in found.items() if one.known}
    few = ", ".join(name for name in found if name not in known)
    few = f" Too few completed samples: {few}." if few else ""
    if not known:
        return few.strip()
    spreads = ", ".join(
        f"{name} {number(1e3 * one.spread[0], 2)} mm at the foot and {number(1e3 * one.spread[-1], 2)} mm at the top"
        for name, one in known.items()
    )
    upward, growth = sum(one.grows_upward for one in known.values()), growth_with_structure(known.values())
    words = f"{spreads}. The thickness grows from each block to the next in {share_words(upward, len(known))} cases."
    if growth.pairs:
        side = (
            "as the paper states"
            if growth.thicker == growth.pairs
            else "against the statement of the paper"
            if 2 * growth.thicker < growth.pairs
            else "which bears the statement of the paper out in part"
        )
        words += (
            f" Of the pairs of cases with different numbers of free bodies, the one of more is thicker at the top "
            f"in {share_words(growth.thicker, growth.pairs)}, {side}."
        )
    return words + few
