"""Tables of what differs between the models: blocks, pairs of models, scores."""

from itertools import chain, combinations, product

import numpy as np

from blockshake.pages.blocks import Table, Text
from blockshake.pages.rows import face_markers, top_markers
from blockshake.pages.wording import MISSING, given, limited, millimetres, model_label, number, sentence_case
from blockshake.pages.words import Words, fine_length
from blockshake.simulation.models import solver_of
from blockshake.statistics.intervals import SURE_FROM
from blockshake.study.comparison.comparison import CHANGES, MOST
from blockshake.study.ensembles.ensemble import RESIDUAL_WINDOW
from blockshake.study.ensembles.envelope import is_moving, still_moves

MOVING = "still moving"  # in place of a residual
_CAPTIONS = Words(__name__)


def block_tables(case):
    """Peak and residual of every block by every model, a table each, or a sentence where all blocks still move."""
    captions = {
        "peak": _CAPTIONS.peak(case.name, SURE_FROM),
        "residual": _CAPTIONS.residual(case.name, SURE_FROM, RESIDUAL_WINDOW),
    }
    return [_block_table(case, name, words) for name, words in captions.items()]


def _block_table(case, name, caption):
    rows, read = [], [] if case.measured is None else [sentence_case(case.curve_word)[:-1]]
    for body, marker in face_markers(case.structure).items():
        known = bool(read) and marker in case.measured["marker"].values
        cells = [_measured(case, name, marker) if known else MISSING] * len(read)
        rows.append((body, *cells, *(_shown(case, model, name, marker) for model in case.responses)))
    counted = case.differences["counted"]
    labels = (f"{model_label(model)} (n = {int(counted.sel(model=model))})" for model in case.responses)
    header = ("Block", *read, *labels)
    if {cell for row in rows for cell in row[1:]} == {MOVING}:
        return Text(_CAPTIONS.all_move(case.name))
    return Table(caption, header, tuple(rows), "l" + "r" * (len(header) - 1))


def _shown(case, model, name, marker, alone=False):
    """A figure of a block by a model in words [mm], with its limits or ``alone``; none of a block that still moves."""
    if name == "residual" and is_moving(case.responses[model].envelope, marker):
        return MOVING
    at = case.differences.sel(model=model, marker=marker)
    return millimetres(at[name]) if alone else limited(at, name, millimetres)


def _measured(case, name, marker):
    """A figure of the measured curve of a marker relative to the slab in words [mm]."""
    at = case.measured.sel(frame="slab", marker=marker)
    moves = name == "residual" and still_moves(at["displacement"], at["peak"], case.marker_noise)
    return MOVING if moves else millimetres(at[name])


def pairs_table(content):
    """Distances of every pair of models in every case, against chance and the floor of their numerics."""
    rows = []
    for stripe in content.stripes:
        found = stripe.differences
        for own, other in combinations(found["model"].values, 2):
            at = found.sel(model=own, other=other)
            floors = [found["floor"].sel(model=model) for model in (own, other)]
            rows.append((
                stripe.name, f"{model_label(own)} and {model_label(other)}", fine_length(at["distance"]),
                fine_length(at["distance_chance"]), limited(at, "history_difference", fine_length),
                str(int(at["common"])), " / ".join(map(fine_length, floors)),
                _seconds(at["parting_time"], stripe.case),
            ))  # fmt: skip
    return Table(
        _CAPTIONS.pairs(MISSING),
        (
            "Case", "Models", "Distance [mm]", "Chance [mm]", "Difference [mm]", "n", "Floors [mm]", "Parting [s]",
        ),
        tuple(rows), "llrrrrrr",
    )  # fmt: skip


def two_levels_table(content):
    """Mean displacement by each model with fewer samples than rigid NSCD, alone and with its help; None without any."""
    rows = []
    for stripe in content.stripes:
        for model in stripe.responses:
            at = stripe.differences.sel(model=model)
            if np.isfinite(at["two_level_peak"]):
                rows.append((
                    stripe.name, model_label(model), str(int(at["counted"])), millimetres(at["mean_peak"]),
                    limited(at, "two_level_peak", millimetres), number(at["peak_correlation"]),
                    number(at["coefficient"]), number(at["variance_gain"]),
                ))  # fmt: skip
    if not rows:
        return None
    return Table(
        _CAPTIONS.two_levels(MOST),
        ("Case", "Model", "n", "Mean [mm]", "With the help [mm]", "Correlation", "Coefficient", "Variance ratio"),
        tuple(rows), "llrrrrrr",
    )  # fmt: skip


def other_settings_table(content):
    """Changes by other settings of a solver at the top block of every leaf; None where no model has any."""
    models, rows = content.study["models"], []
    others = [model for model in models if model != (plain := solver_of(model).name) and plain in models]
    if not others:
        return None
    tops = [(one, top) for one in content.stripes for top in top_markers(one.case.structure).items()]
    for (stripe, (body, marker)), model in product(tops, others):
        plain, own = solver_of(model).name, stripe.differences.sel(marker=marker, model=model)
        pairs = (
            (_shown(stripe, plain, name, marker, alone=True), limited(own, f"{name}_change", millimetres))
            for name in CHANGES
        )
        rows.append((f"{stripe.name}, {body}", model_label(model), str(int(own["changed"])), *chain(*pairs)))
    heads = (f"{head} [mm]" for name in CHANGES for head in (name.capitalize(), "Change"))
    return Table(
        _CAPTIONS.other_settings(MISSING),
        ("Case, block", "Model", "n", *heads),
        tuple(rows),
        "llrrrrrrr",
    )


def scores_table(content):
    """Score of every model against the measured curves of every case; None where no case is compared with any."""
    compared = [case for case in content.cases.values() if case.measured is not None]
    if not compared:
        return None
    models = content.study["models"]
    rows = []
    for case in compared:
        at = case.differences
        known = at["score"].dropna("model")
        best = model_label(str(known["model"].values[known.argmin("model")])) if known.size else MISSING
        cells = (limited(at.sel(model=model), "score", millimetres) for model in models)
        rows.append((case.name, case.curve_word, *cells, best))
    return Table(
        _CAPTIONS.scores(SURE_FROM, MISSING),
        ("Case", "Curves", *map(model_label, models), "Lowest"), tuple(rows), "ll" + "r" * len(models) + "l",
    )  # fmt: skip


def _seconds(value, case):
    """A time at which something parts [s]; nothing that parts within the window of a case is beyond its end."""
    return f"> {given(case.settings['duration'])}" if np.isposinf(float(value)) else number(value)
