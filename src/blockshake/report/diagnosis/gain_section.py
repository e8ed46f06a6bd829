"""Sixth page of a diagnosis: what the extension gains on tests that nothing was fitted to."""

import numpy as np

from blockshake.report.diagnosis.figures.drift import plot_extended_drift
from blockshake.report.diagnosis.parameters_table import nominal_parameters
from blockshake.report.document.blocks import Figure, Items, Section, Table, Text
from blockshake.report.document.drawing import svg_of
from blockshake.report.document.wording import MISSING, model_label, number, sentence_case

_KINDS = {
    "nominal": "nominal",
    "recalibrated": "recalibrated",
    "discrepancy": "nominal with a discrepancy",
    "extended": "extended",
}
_MOST_FIGURES = 3  # rows of before and after


def gain_section(found):
    """Scores against three rivals, what got worse, consequence, curves before and after."""
    if found.sensor_gain is not None:
        return _of_sensor(found)
    if found.gain is None:
        reasons = found.gain_caveats or ["no gain was measured: the model was not extended"]
        return Section("Gain on sealed tests", "gain", (Text(sentence_case("; ".join(reasons))),))
    gain = found.gain
    tests = [str(name) for name in gain["test"].values]
    blocks = [
        Text(
            f"Sealed tests: {', '.join(tests)}. They were opened after the decision had been frozen (digest "
            f"{found.frozen['digest']}). Rivals of the extended model: the nominal one; the nominal "
            "one recalibrated on the open tests; the nominal one with a statistical "
            "discrepancy (Kennedy and O'Hagan 2001), which has no name. Score: continuous ranked probability score "
            "of the features, each in units of its spread; lower is better."
        ),
        _scores(gain),
        _gains(gain),
        *_laws(gain),
        _families(gain),
        Text(_worse(gain), strong=bool(gain["worse"].any())),
        _consequences(found),
    ]
    shown = [str(name) for name in found.consequences["test"].values][:_MOST_FIGURES]
    blocks.append(
        Figure(
            f"Displacement of {found.top} against the table on sealed tests, before and after: 5 to 95 % of both "
            "solvers' members together, median, and the test.",
            svg_of(plot_extended_drift, found.consequences, shown, found.top, found.measured_word),
        )
    )
    blocks.append(nominal_parameters(gain))
    caveats = found.gain_caveats
    if caveats:
        blocks.append(Items(tuple(map(sentence_case, caveats))))
    return Section("Gain on sealed tests", "gain", tuple(blocks))


def _of_sensor(found):
    """Gain of taking a sensor's fault out: its readings against those of the other sensors."""
    scores = found.sensor_gain
    unit = scores["score"].attrs["units"]
    shown, factor = ("mm", 1e3) if unit == "m" else ("ms", 1e3)
    words = {
        "nominal": "as read",
        "extended": "fault taken out",
        "discrepancy": "mean of the open tests taken off",
    }
    rows = tuple(
        (
            str(name),
            *(number(factor * float(scores["score"].sel(test=name, kind=kind)), 3) for kind in words),
            number(factor * float(scores["floor"].sel(test=name)), 3),
        )
        for name in scores["test"].values
    )
    own = found.verdict.gain.nominal
    return Section(
        "Gain on sealed tests",
        "gain",
        (
            Text(
                f"The fault is one of the observation, so the extension acts there: the estimate from the open tests "
                f"was taken out of the sealed ones, which were opened after the decision had been frozen (digest "
                f"{found.frozen['digest']}). Of what could be gained it gains {100.0 * own.estimate:.0f} % "
                f"({100.0 * own.lower:.0f} to {100.0 * own.upper:.0f} % in the single tests). No simulation enters it."
            ),
            Table(
                f"Root mean square distance of the readings of {scores.attrs['where']} from where the other sensors "
                f"put them [{shown}]; the floor is that while nothing moves.",
                ("Test", *words.values(), "floor"),
                rows,
                "lrrrr",
            ),
        ),
    )


def _scores(gain):
    models, tests = list(gain["model"].values), list(gain["test"].values)
    rows = []
    for kind, words in _KINDS.items():
        own = gain.sel(kind=kind)
        rows.append(
            (
                words,
                number(own["score"]),
                *(number(own["score_of_solver"].sel(model=model)) for model in models),
                *(number(own["score_of_test"].sel(test=test)) for test in tests),
            )
        )
    return Table(
        "Scores: both solvers together, each by itself, and test by test. A record that the extended model had made "
        f"itself would score {number(gain['floor'])} in the mean (the floor) and below {number(gain['highest'])} in 95 "
        "of 100 cases. By one solver the ensembles are half as large.",
        ("Model", "Both", *map(model_label, models), *map(str, tests)),
        tuple(rows),
        "l" + "r" * (1 + len(models) + len(tests)),
    )


def _gains(gain):
    rows = []
    for rival in ("recalibrated", "nominal", "discrepancy"):
        own = gain.sel(rival=rival)
        there = np.isfinite(own["gain"])
        rows.append(
            (
                _KINDS[rival],
                _with_interval(own, "fall"),
                _with_interval(own, "gain") if there else "nothing to gain",
            )
        )
    confirmed = (
        "each solver by itself shows at least half of the fall against the recalibrated model"
        if bool(gain["confirmed"])
        else "not each solver by itself shows half of the fall against the recalibrated model"
    )
    return Table(
        "Against each rival, with intervals of 90 %: fall of the score, and gain, the fall over what there is to gain "
        f"between the rival and the floor; 1 leaves nothing to gain (by chance it can be more), below 0 the "
        f"extension is worse. Both solvers: {confirmed}.",
        ("Rival", "Fall of the score", "Gain [1]"),
        tuple(rows),
        "lrr",
    )


def _laws(gain):
    """Distances of the broken laws before and after, where sealed tests tell any; nothing of tests without laws."""
    if "law_distance" not in gain or not gain.sizes["law_cell"]:
        return []
    kinds = [str(kind) for kind in gain["law_kind"].values]
    rows = []
    for place in range(gain.sizes["law_cell"]):
        own = gain.isel(law_cell=place)
        away = [number(own["law_distance"].sel(law_kind=kind), 2) for kind in kinds]
        rows.append((str(own["cell_test"].item()), str(own["cell_law"].item()), *away))
    gains = []
    for rival in map(str, gain["law_rival"].values):
        own = gain.sel(law_rival=rival)
        words = _with_interval(own, "law_gain") if np.isfinite(own["law_gain"]) else "nothing to gain"
        gains.append(f"{_KINDS[rival]}: {words}")
    return [
        Table(
            "Laws of the joints that the open tests break, on the sealed tests: departure from each ensemble in "
            "standard deviations of the nominal model. Laws are statics, and no chaos blurs them. Gain of the extended "
            f"model on them, against {'; '.join(gains)} (1 leaves what chance leaves; interval of 90 %).",
            ("Test", "Law", *(_KINDS[kind] for kind in kinds)),
            tuple(rows),
            "ll" + "r" * len(kinds),
        )
    ]


def _families(gain):
    rows = []
    for family in gain["family"].values:
        own = gain.sel(family=family)
        rows.append(
            (
                str(family),
                *(number(own["score_of_family"].sel(kind=kind)) for kind in _KINDS),
                _with_interval(own, "fall_of_family"),
                "worse" if bool(own["worse"]) else "",
            )
        )
    return Table(
        "Scores by family of features, and the fall against the recalibrated model with its interval of 90 %; worse: "
        "the whole interval is below 0.",
        ("Family", *_KINDS.values(), "Fall", ""),
        tuple(rows),
        "lrrrrrl",
    )


def _worse(gain):
    worse = [str(name) for name in gain["family"].values[gain["worse"].to_numpy()]]
    if not worse:
        return "No family of features is predicted worse than by the recalibrated model beyond its interval."
    return f"What got worse than by the recalibrated model: {', '.join(worse)}."


def _consequences(found):
    rows = []
    for test in found.consequences["test"].values:
        own = found.consequences.sel(test=test)
        rows.append(
            (
                str(test),
                *(_drift(own.sel(kind=kind)) for kind in own["kind"].values),
                number(1e3 * own["measured"]),
                *(_millimetres(own["crps"].sel(kind=kind, body=found.top)) for kind in own["kind"].values),
            )
        )
    kinds = [str(kind) for kind in found.consequences["kind"].values]
    return Table(
        f"What it means for the user: median drift, the largest displacement of {found.top} against the table that "
        "half of the members exceed, with its limits of 95 % by order statistics; the largest of the "
        f"{'virtual test' if found.synthetic else 'test'}; score of the drift over time. All in mm.",
        (
            "Test", *(f"Median drift, {kind}" for kind in kinds), "Read off the test",
            *(f"Score, {kind}" for kind in kinds),
        ),
        tuple(rows), "l" + "r" * (2 * len(kinds) + 1),
    )  # fmt: skip


def _drift(own):
    return f"{number(1e3 * own['drift'])} ({number(1e3 * own['drift_lower'])} to {number(1e3 * own['drift_upper'])})"


def _millimetres(value):
    return number(1e3 * float(value)) if np.isfinite(value) else MISSING


def _with_interval(own, name):
    value, lower, upper = (float(own[key]) for key in (name, f"{name}_lower", f"{name}_upper"))
    return f"{number(value)} ({number(lower)} to {number(upper)})"
