"""Section on the responses: displacement of the blocks by every model, case by case."""

import numpy as np

from blockshake.pages.blocks import Figure, Heading, Section, Table, Text
from blockshake.pages.drawing import svg_of
from blockshake.pages.rows import bodies_by_height, face_markers
from blockshake.pages.wording import (
    MISSING,
    SHOWN_QUANTILES,
    given,
    model_label,
    number,
    percent,
    quantile_percent,
    quantile_range,
    share_words,
)
from blockshake.pages.words import length, span
from blockshake.simulation.run_histories import RARELY
from blockshake.study.comparison.tables import block_tables
from blockshake.study.ensembles.displacement_figure import plot_displacements
from blockshake.study.ensembles.envelope import counted_samples
from blockshake.study.ensembles.moving import moving_samples, plot_still, usual_magnification
from blockshake.study.sensitivity.findings import quiet_markers

_HIGH = 0.95  # quantile of the figures of joints
_OF_JOINTS = {"joint_compression": "N", "joint_uplift": "m", "joint_slip": "m"}
_ROWS, _JOINTS = 4, 6  # blocks of a figure, and joints of a table: those that move most


def responses(content):
    """Displacement of the blocks by every model, case by case."""
    blocks = [
        Text(
            "Displacement along x of one marker of each block, from the top block down: that named BLOCK-face, or the "
            "block's first. A marker higher on a block that rocks moves farther. Grey: area of "
            "the samples; red: the smallest and the largest value at each time. Two bounds of n samples hold one "
            "further run of the same model at one instant with probability (n - 1) / (n + 1). For a whole record no "
            "probability is known; therefore every coverage stands beside its leave-one-out reference."
        )
    ]
    for case in content.cases.values():
        blocks += _response(case)
    return Section("Displacement of the blocks", "responses", tuple(blocks))


def _response(case):
    markers = face_markers(case.structure)
    blocks, drawn = (
        int((~case.structure.driven).sum()),
        bodies_by_height(case.structure, markers, _ROWS)[::-1],
    )
    some = "every block" if blocks == len(drawn) else f"{len(drawn)} of {blocks} blocks, one of a height"

    def figure(frame, caption):
        envelopes = {model: one.envelope for model, one in case.responses.items()}
        shown = envelopes, case.measured, [markers[body] for body in drawn], drawn, frame, case.synthetic
        return Figure(caption, svg_of(plot_displacements, *shown))

    curves = (
        []
        if case.levels
        else [figure("slab", f"{case.name}: displacement relative to the slab's marker, {some}.")]
    )
    tables = [_levels_table(case)] if case.levels else block_tables(case)
    compared = f"{case.name}: displacement in the inertial frame, in which the coverage is read."
    return [
        Heading(case.title, f"response-{case.name}"),
        Text(
            f"{case.motion}, scale {given(case.settings['scale'])}, first {given(case.settings['duration'])} s."
            + _noise(case)
        ),
        *([] if case.levels else band_remarks(case, markers.values())),
        *curves,
        *_moving(case),
        *tables,
        *(table for stripe in case.stripes for table in joints_table(stripe)),
        *([] if case.measured is None else [figure("inertial", compared), coverage_table(case)]),
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
    return Table(
        f"{case.name}: largest displacement of every block along x from its place on the slab [mm], by level: median "
        "of the runs, smallest to largest in brackets.",
        ("Level", "Block", *map(model_label, case.responses)), tuple(rows), "ll" + "r" * len(case.responses),
    )  # fmt: skip


def _moving(case):
    """Blocks of some samples in space, where any sample has a result."""
    if not any(one.shown.sizes["sample"] for one in case.responses.values()):
        return []
    times = usual_magnification(case)
    size = "not at all" if times == 1.0 else f"{given(times)} times"
    markers = f", points: markers, {case.curve_word}" if case.test is not None else ""
    return [
        Figure(
            f"{case.name}: blocks of samples by every model{markers}. Displacement is relative to the slab's marker. "
            f"In print: the median sample by the peak of all markers when a block is farthest, magnified {size}. "
            "On a screen: the median sample and the worst, fallen or of the largest peak, moving in real time; the "
            "displacement of each point is multiplied, so that blocks look bent where the magnification is large.",
            svg_of(plot_still, case),
            moving=moving_samples(case),
        )
    ]


def _noise(case):
    """Marker noise in words, with the curve that has it."""
    if case.measured is None:
        return " No measured test is compared with the samples."
    word = case.curve_word if case.synthetic else "measured curve"
    return f" Marker noise of the {word}: {given(1e3 * case.marker_noise)} mm (standard deviation)."


def band_remarks(case, markers):
    """A remark on each model whose samples are nearly one and the same run, or one only."""
    texts = []
    for model, one in case.responses.items():
        if one.envelope.attrs["counted"] == 1:
            texts.append(Text(f"{model_label(model)}: one sample, whose curve is drawn in place of a band."))
        quiet = quiet_markers(one.sensitivity, markers, case.marker_noise)
        if quiet:
            texts.append(
                Text(
                    f"{model_label(model)}: the samples of {share_words(quiet, len(markers))} blocks differ by less "
                    "than the noise of a marker (standard deviation over samples and time): their bands close to lines."
                )
            )
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
                    body, model_label(model), percent(at["coverage"]), quantile_range(at["reference"], percent),
                    number(float(at["distance"]), 2), number(float(at["curve_probability"]), 2),
                ))  # fmt: skip
    word = "virtual test" if case.synthetic else "measured curve"
    quantiles = " / ".join(f"{100 * one:.0f}" for one in SHOWN_QUANTILES)
    return Table(
        f"{case.name}: share of the time that the {word} lies within the bounds (inertial frame), beside the share of "
        "each sample in the bounds of the others (leave one out, read with the noise of the markers), quantiles "
        f"{quantiles} %; root mean square distance of the {word} from the samples, in standard deviations of noise and "
        "spread, and the chance of a distance as large for one more sample. Models with fewer than three samples are "
        "left out.",
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
    some = (
        "the joints"
        if len(chosen) == len(joints)
        else f"the {len(chosen)} of {len(joints)} joints that move most"
    )
    return [
        Table(
            f"{stripe.name}: {some}, from the top down, {quantile_percent(_HIGH)} quantile over the samples that did "
            f"not fail. Compression: normal force that is exceeded for {100.0 * RARELY:g} % of the time, so that it "
            "leaves impacts out; uplift and slip: the largest at the middle of the face.",
            ("Joint", "Model", "Compression [kN]", "Uplift [mm]", "Slip [mm]"), tuple(rows), "llrrr",
        )
    ]  # fmt: skip


def _joint_cell(value, unit):
    """A figure of a joint, a length in mm or a force in kN."""
    return length(value) if unit == "m" else number(1e-3 * value)
