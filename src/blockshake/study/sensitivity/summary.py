"""Sensitivities over all cases and models: the strongest variables."""

from blockshake.pages.blocks import Table
from blockshake.pages.rows import bodies_by_height, face_markers
from blockshake.pages.wording import MISSING, model_label, number
from blockshake.study.sensitivity.figure import SHOWN
from blockshake.study.sensitivity.findings import differs, influences, is_known
from blockshake.study.sensitivity.words import influence_words


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


def shaking(case):
    """Whatever tells the shaking of two cases apart: motion, scale, window."""
    return case.motion, case.settings["scale"], case.settings["duration"]
