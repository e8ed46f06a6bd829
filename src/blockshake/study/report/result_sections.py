"""Section on the responses: displacement of the blocks by every model, case by case."""

import numpy as np

from blockshake.pages.blocks import Figure, Heading, Section, Table, Text
from blockshake.pages.drawing import svg_of
from blockshake.pages.rows import face_markers
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
from blockshake.simulation.run_histories import RARELY
from blockshake.study.comparison.tables import block_tables
from blockshake.study.ensembles.displacement_figure import plot_displacements
from blockshake.study.report.moving import moving_samples, plot_still, usual_magnification
from blockshake.study.sensitivity.findings import quiet_markers

_HIGH = 0.95  # quantile of the figures of joints
_OF_JOINTS = {"joint_compression": 1e-3, "joint_uplift": 1e3, "joint_slip": 1e3}  # factors from SI


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
    envelopes = {model: one.envelope for model, one in case.responses.items()}
    blocks, marked = int((~case.structure.driven).sum()), len(markers)
    every = "every block" if marked == blocks else f"the {marked} of {blocks} blocks that have a marker"

    def figure(frame, caption):
        shown = envelopes, case.measured, list(markers.values()), list(markers), frame, case.synthetic
        return Figure(caption, svg_of(plot_displacements, *shown))

    beside = f"{case.name}: displacement in the inertial frame, in which the coverage is read."
    return [
        Heading(case.title, f"response-{case.name}"),
        Text(
            f"{case.motion}, scale {given(case.settings['scale'])}, first {given(case.settings['duration'])} s."
            + _noise(case)
        ),
        *band_remarks(case, markers.values()),
        figure("slab", f"{case.name}: displacement relative to the slab's marker, {every}."),
        *_moving(case),
        *block_tables(case),
        *joints_table(case),
        *([] if case.measured is None else [figure("inertial", beside), coverage_table(case)]),
    ]


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


def joints_table(case):
    """Table of a case's joints, in a list; an empty one where no sample of any model has a result."""
    envelopes = {
        model: one.envelope for model, one in case.responses.items() if int(one.envelope.attrs["counted"])
    }
    if not envelopes:
        return []
    rows = [
        (str(joint), *(_joint_cell(one.sel(joint=joint, quantile=_HIGH)) for one in envelopes.values()))
        for joint in reversed(next(iter(envelopes.values()))["joint"].values)
    ]
    labels = (f"{model_label(model)} (n = {int(one.attrs['counted'])})" for model, one in envelopes.items())
    return [
        Table(
            f"{case.name}: compression [kN] / uplift [mm] / slip [mm] of the joints from the top down, "
            f"{quantile_percent(_HIGH)} quantile over the samples that did not fail. Compression: normal force that "
            f"is exceeded for {100.0 * RARELY:g} % of the time, so that it leaves impacts out; uplift and slip: the "
            "largest at the middle of the face.",
            ("Joint", *labels),
            tuple(rows),
            "l" + "r" * len(envelopes),
        )
    ]


def _joint_cell(at):
    shown = [factor * float(at[name]) for name, factor in _OF_JOINTS.items()]
    return " / ".join(map(number, shown)) if np.isfinite(shown).all() else MISSING
