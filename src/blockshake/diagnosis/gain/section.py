"""Sections of a diagnosis on tests that nothing was fitted to: the gain by the cause, and what the cause changes."""

import numpy as np

from blockshake.diagnosis.gain.extended_model import acting_causes
from blockshake.diagnosis.misfit.figure import add_legend, draw_history
from blockshake.diagnosis.wording import NO_ERROR, percent_words
from blockshake.pages.blocks import Figure, Items, Listing, Section, Table, Text
from blockshake.pages.drawing import BLUE, GREY, ORANGE, new_figure, svg_of
from blockshake.pages.wording import MISSING, listed, number, quantile_percent, sentence_case
from blockshake.statistics.intervals import samples_needed
from blockshake.study.extension.changes import HIGH
from blockshake.study.extension.section import change_rows, change_sentence

_RIVALS = {
    "nominal": "the nominal model",
    "recalibrated": "the nominal model, recalibrated on the open tests",
    "discrepancy": "the nominal model with a discrepancy without a name",
    "placebo": "the same cause at another place",
}
_MOST_TESTS = 3
OF_GAIN = (
    "gain was measured",
    "nothing to gain",
    "is not proposed",
)  # by which caveats on the gain are known
# drift by these kinds of members, with their titles and colours
_SHOWN = {
    "nominal": ("without the cause", GREY),
    "recalibrated": ("without the cause, recalibrated", ORANGE),
    "extended": ("with the cause", BLUE),
}


def gain_section(diagnosed):
    """Gain on forces and responses against each rival, and the drift with and without the cause."""
    verdict, gain = diagnosed.verdict, diagnosed.gain
    title = "Gain on sealed tests"
    if verdict.gain is None and verdict.row_gain is None:
        reasons = [caveat for caveat in verdict.caveats if OF_GAIN[0] in caveat]
        words = (
            "; ".join(reasons) or "no gain was measured: nothing acts by which the model could be extended"
        )
        return Section(title, "gain", (Text(sentence_case(words)),))
    blocks = [
        Text(
            "The sealed tests were opened after the decision had been frozen; nothing was fitted to them. Gain: "
            "the share of a rival's error that the model with the cause removes; 100 % leaves no more error than the "
            f"readings have, below 0 the cause makes the prediction worse; '{NO_ERROR}' stands where the rival is "
            "within its errors by itself."
        ),
        _gains(verdict),
        *(
            Text(sentence_case(caveat))
            for caveat in verdict.caveats
            if any(words in caveat for words in OF_GAIN)
        ),
    ]
    if gain is not None and "where" in gain.attrs:
        blocks.append(_of_sensor(gain))
    return Section(title, "gain", tuple(blocks))


def _gains(verdict):
    columns = [
        contrast for contrast in ((verdict.row_gain, "Forces"), (verdict.gain, "Responses")) if contrast[0]
    ]
    rows = []
    for rival, words in _RIVALS.items():
        contrasts = [getattr(gain, rival, None) for gain, _ in columns]
        if any(contrasts):
            rows.append(
                (words, *(percent_words(contrast) if contrast else MISSING for contrast in contrasts))
            )
    return Table(
        "Gain against each rival with its interval of 90 %. Forces: those that undamaged blocks do not make, or the "
        "motion of the slab that an undamaged table does not make, at the frozen sizes. Responses: simulated rotations "
        "and slips of the joints and the drift of the top, as long as each can be predicted.",
        ("Alternative", *(name for _, name in columns)),
        tuple(rows),
        "l" + "r" * len(columns),
    )


def drift_figure(diagnosed):
    """Figure of the sealed tests before and after the cause is in the model; None where no model was extended."""
    if diagnosed.gain is None or "band" not in diagnosed.gain:
        return None
    tests = [str(name) for name in diagnosed.gain["test"].values][:_MOST_TESTS]
    return Figure(
        "Drift of the top against the table on sealed tests, without and with the cause: 5 to 95 % and median of the "
        f"members of all solvers, and {diagnosed.measured_word}. Shaded: beyond the time for which it can be "
        "predicted.",
        svg_of(plot_drift, diagnosed.gain, tests, diagnosed.measured_word),
    )


def _of_sensor(scores):
    """Gain of taking a sensor's fault out: its readings against those of the other sensors."""
    words = {
        "nominal": "As read",
        "extended": "Fault taken out",
        "discrepancy": "Mean of the open tests taken off",
    }
    rows = [
        (
            str(name), *(number(1e3 * float(scores["score"].sel(test=name, kind=kind))) for kind in words),
            number(1e3 * float(scores["floor"].sel(test=name))),
        )
        for name in scores["test"].values
    ]  # fmt: skip
    return Table(
        f"Root mean square distance of the readings of {scores.attrs['where']} from where the other sensors put them "
        f"[m{scores['score'].attrs['units']}]; the floor is that while nothing moves.",
        ("Test", *words.values(), "Floor"),
        tuple(rows),
        "lrrrr",
    )


def effect_section(diagnosed):
    """Changes that the cause makes in the sealed tests, for whoever must decide; None where no model is proposed."""
    gain = diagnosed.gain
    if gain is None or "largest" not in gain or not diagnosed.verdict.extension:
        return None
    cause = listed([one.title for one in acting_causes(diagnosed.decision)])
    effect = gain[["value", "value_interval", "paired", "largest"]].rename(response="quantity")
    tests = {str(name): effect.sel(test=name) for name in effect["test"].values}
    rows = [(name, *row) for name, of_test in tests.items() for row in change_rows(of_test)]
    measured = "Virtual test" if diagnosed.synthetic else "Measured"
    caption = (
        "Largest displacement along x of any block from the table, and largest opening of any joint at the middle of "
        "its face, of the nominal members without the cause and of the same members with it, conditioned on the open "
        "tests, all solvers together. Limits of 95 % in brackets, by drawing the pairs again; those of a share are "
        f"Clopper and Pearson's. Fewer than {samples_needed(HIGH)} pairs tell the limits of a "
        f"{quantile_percent(HIGH)} quantile too narrow."
    )
    header = ("Test", "Quantity", "Without the cause", "With the cause", "Change", measured)
    return Section(
        "Effect of the cause",
        "effect",
        (
            Items(tuple(change_sentence(name, cause, of_test) for name, of_test in tests.items())),
            Table(caption, header, tuple(rows), "llrrrr"),
            Text(
                "Other motions and levels, more samples, and the safe level are a study with the cause in it. It is "
                "written from the verdict of this diagnosis and the study of your decision, and run, by:"
            ),
            Listing(
                "Commands",
                "blockshake extend-study verdict.json STUDY.yaml --output extended.yaml\n"
                "blockshake study extended.yaml",
            ),
        ),
    )


def plot_drift(gain, tests, measured_word):
    """Figure of the drift of the top without and with the cause side by side, one row a sealed test."""
    figure = new_figure(0.02 + 0.034 * len(tests))
    panels = figure.subplots(len(tests), len(_SHOWN), sharey="row", squeeze=False)
    top = gain.isel(cell=np.flatnonzero(gain["quantity"].to_numpy() == "drift")[-1])
    for row, test in zip(panels, tests, strict=True):
        of_test = top.sel(test=test)
        for axes, (kind, (_, color)) in zip(row, _SHOWN.items(), strict=True):
            draw_history(axes, of_test.assign(band=of_test["band"].sel(kind=kind)), color)
        row[0].set_ylabel(f"{test}\ndrift [mm]")
    for axes, (title, _) in zip(panels[0], _SHOWN.values(), strict=True):
        axes.set_title(title)
    for axes in panels[-1]:
        axes.set_xlabel("time [s]")
    figure.align_ylabels(panels[:, 0])
    add_legend(figure, [color for _, color in _SHOWN.values()], measured_word)
    return figure
