"""Section on the responses: displacement of the blocks by every model, case by case."""

import numpy as np

from blockshake.pages.blocks import Figure, Heading, Section, Table, Text
from blockshake.pages.drawing import svg_of
from blockshake.pages.rows import bodies_by_height, face_markers
from blockshake.pages.wording import (
    MISSING,
    SHOWN_QUANTILES,
    model_label,
    number,
    percent,
    quantile_percent,
)
from blockshake.pages.words import Words, length, span, whole_percent
from blockshake.simulation.run_histories import RARELY
from blockshake.study.comparison.tables import block_tables
from blockshake.study.ensembles.displacement_figure import plot_displacements
from blockshake.study.ensembles.envelope import counted_samples
from blockshake.study.ensembles.moving import moving_samples, plot_still, usual_magnification
from blockshake.study.sensitivity.findings import quiet_markers

_RESULTS = Words(__name__)
_HIGH = 0.95  # quantile of the figures of joints
_OF_JOINTS = {"joint_compression": "N", "joint_uplift": "m", "joint_slip": "m"}
_ROWS, _JOINTS = 4, 6  # blocks of a figure, and joints of a table: those that move most


def responses(content):
    """Displacement of the blocks by every model, case by case."""
    blocks = [Text(_RESULTS.method())]
    for case in content.cases.values():
        blocks += _response(case)
    return Section("Displacement of the blocks", "responses", tuple(blocks))


def displacements(case):
    """Figure of the blocks relative to the slab's marker, in a list; none of a case with levels."""
    blocks = int((~case.structure.driven).sum())
    return [] if case.levels else [_figure(case, "slab", _RESULTS.curves(case, len(_drawn(case)), blocks))]


def _drawn(case):
    """Blocks of a figure, from the top row down."""
    return bodies_by_height(case.structure, face_markers(case.structure), _ROWS)[::-1]


def _figure(case, frame, caption):
    """Displacement of the blocks in a frame."""
    markers, drawn = face_markers(case.structure), _drawn(case)
    envelopes = {model: one.envelope for model, one in case.responses.items()}
    shown = envelopes, case.measured, [markers[body] for body in drawn], drawn, frame, case.synthetic
    return Figure(caption, svg_of(plot_displacements, *shown))


def _response(case):
    markers = face_markers(case.structure)
    tables = [_levels_table(case)] if case.levels else block_tables(case)
    return [
        Heading(case.title, f"response-{case.name}"),
        Text(_RESULTS.case(case)),
        *([] if case.levels else band_remarks(case, markers.values())),
        *displacements(case),
        *_moving(case),
        *tables,
        *(table for stripe in case.stripes for table in joints_table(stripe)),
        *(
            []
            if case.measured is None
            else [_figure(case, "inertial", _RESULTS.inertial(case)), coverage_table(case)]
        ),
    ]


def _levels_table(case):
    """Largest displacement of every block by level, median of the runs with the smallest and the largest."""
    rows = []
    for stripe in case.stripes:
        counted = {model: counted_samples(one.samples)["peak"] for model, one in stripe.responses.items()}
        for body, marker in face_markers(case.structure).items():
            peaks = [one.sel(frame="slab", marker=marker) for one in counted.values()]
            cells = (f"{length(one.median())} ({span(one.values)})" if one.size else MISSING for one in peaks)
            rows.append((stripe.name, body, *cells))
    head = ("Level", "Block", *map(model_label, case.responses))
    return Table(_RESULTS.levels(case), head, tuple(rows), "ll" + "r" * len(case.responses))


def _moving(case):
    """Blocks of some samples in space, where any sample has a result."""
    if not any(one.shown.sizes["sample"] for one in case.responses.values()):
        return []
    words = _RESULTS.moving(case, usual_magnification(case))
    return [Figure(words, svg_of(plot_still, case), moving=moving_samples(case))]


def band_remarks(case, markers):
    """A remark on each model whose samples are nearly one and the same run, or one only."""
    texts = []
    for model, one in case.responses.items():
        if one.envelope.attrs["counted"] == 1:
            texts.append(Text(_RESULTS.alone(model)))
        quiet = quiet_markers(one.sensitivity, markers, case.marker_noise)
        if quiet:
            texts.append(Text(_RESULTS.quiet(model, quiet, len(markers))))
    return texts


def coverage_table(case):
    """Coverage with its reference, and distance with its chance."""
    rows = []
    for body, marker in face_markers(case.structure).items():
        for model, one in case.responses.items():
            if marker not in one.comparison["marker"].values:
                continue
            at = one.comparison.sel(marker=marker)
            if np.isfinite(at["coverage"]):  # not of too few samples
                rows.append((
                    body, model_label(model), percent(at["coverage"]), span(at["reference"].values, whole_percent),
                    number(float(at["distance"]), 2), number(float(at["curve_probability"]), 2),
                ))  # fmt: skip
    word = "virtual test" if case.synthetic else "measured curve"
    return Table(
        _RESULTS.coverage(case, word, SHOWN_QUANTILES[0], SHOWN_QUANTILES[-1]),
        ("Block", "Model", f"Coverage of the {word} [%]", "Reference, leave one out [%]", "Distance", "Chance"),
        tuple(rows), "llrrrr",
    )  # fmt: skip


def joints_table(stripe):
    """Table of the joints of a case or of one of its levels that open and slip most, in a list; empty without runs."""
    envelopes = {
        model: one.envelope.sel(quantile=_HIGH)
        for model, one in stripe.responses.items()
        if int(one.envelope.attrs["counted"])
    }
    if not envelopes:
        return []
    moved = sum(
        (one["joint_uplift"] + one["joint_slip"]).fillna(0.0) for one in envelopes.values()
    ).to_numpy()
    joints = next(iter(envelopes.values()))["joint"].values
    chosen = sorted(np.argsort(-moved, kind="stable")[:_JOINTS], reverse=True)
    rows = [
        (
            str(joints[at]),
            model_label(model),
            *(_joint_cell(one[name][at], unit) for name, unit in _OF_JOINTS.items()),
        )
        for at in chosen
        for model, one in envelopes.items()
    ]
    words = _RESULTS.joints(stripe.name, len(chosen), len(joints), quantile_percent(_HIGH), 100.0 * RARELY)
    return [
        Table(words, ("Joint", "Model", "Compression [kN]", "Uplift [mm]", "Slip [mm]"), tuple(rows), "llrrr")
    ]


def _joint_cell(value, unit):
    """A figure of a joint, a length in mm or a force in kN."""
    return length(value) if unit == "m" else number(1e-3 * value)
