"""Section on an extended study: what the cause changes, beside what was measured, and whether naming it predicts."""

import numpy as np

from blockshake.pages.blocks import Figure, Heading, Section, Table, Text
from blockshake.pages.drawing import svg_of
from blockshake.pages.rows import face_markers, main_bodies
from blockshake.pages.wording import MISSING, SQUARED, given, millimetres, model_label, number, percent
from blockshake.statistics.intervals import samples_needed
from blockshake.study.ensembles.displacement_figure import interactive_displacements, plot_displacements
from blockshake.study.extension.changes import HIGH, QUANTITIES
from blockshake.study.fragility.fragility import SAFE

_WORDS = {
    "median_drift": ("drift, median [mm]", millimetres),
    "drift": (f"drift, {percent(HIGH)} % quantile [mm]", millimetres),
    "uplift": (f"uplift, {percent(HIGH)} % quantile [mm]", millimetres),
    "slip": (f"slip, {percent(HIGH)} % quantile [mm]", millimetres),
    "collapse": ("probability of collapse [%]", percent),
    "safe_scale": (f"safe factor of the motion ({percent(SAFE)} % fail) [1]", number),
}


def extension(content):
    """Changes by a cause; None where no case has one more than another."""
    if not content.changes:
        return None
    blocks = [
        Text(
            "Every sample was simulated twice, with the same values of all other variables: by the structure as it is "
            "drawn, and by the structure with the cause that measured tests speak for. Drift: largest displacement "
            "along x of any block's markers from the slab. Uplift and slip: largest of any joint, at the middle of "
            "the face. Limits of 95 % in brackets, by drawing the pairs of samples again; those of shares are Clopper "
            f"and Pearson's. Limits of a {percent(HIGH)} % quantile hold less often than stated where fewer than "
            f"{samples_needed(HIGH)} samples bear them. Peaks of samples that fell are lower limits."
        )
    ]
    for extended, nominal in content.study["extension"]["cases"].items():
        blocks += _case(content, content.cases[extended], content.cases[nominal])
    return Section("Effect of the cause", "extension", (*blocks, *_transfer(content)))


def _case(content, case, nominal):
    """Words, table and figure of one pair of cases."""
    result = content.changes[case.name]
    rows = [
        (
            model_label(model),
            _WORDS[name][0],
            *_cells(result.sel(model=model, quantity=name), _WORDS[name][1]),
        )
        for model in result["model"].values
        for name in QUANTITIES
        if np.isfinite(result["change"].sel(model=model, quantity=name))
    ]
    scale = given(case.settings["scale"])
    return [
        Heading(f"{nominal.title}, with {case.structure.file.extension}", f"extension-{case.name}"),
        *(Text(sentence) for sentence in sentences(content, case.name)),
        Table(
            f"{case.name} beside {nominal.name}, {case.motion} x {scale}. Change: with the cause less without it.",
            ("Model", "Quantity", "Without the cause", "With the cause", "Change"), tuple(rows), "llrrr",
        ),
        _figure(case, nominal),
    ]  # fmt: skip


def _cells(at, show):
    return [
        f"{show(at[name])} [{', '.join(show(limit) for limit in at[f'{name}_interval'].values)}]"
        for name in ("without", "extended", "change")
    ]


def _figure(case, nominal):
    markers = face_markers(case.structure)
    bodies = main_bodies(case.structure, markers)
    envelopes = {
        f"{model_label(model)}, {word}": one.responses[model].envelope
        for model in case.responses
        for word, one in (("without", nominal), ("with the cause", case))
    }
    shown = envelopes, case.measured, [markers[body] for body in bodies], bodies, "slab", case.synthetic
    measured = "" if case.measured is None else f"; dashed: {case.curve_word}"
    return Figure(
        f"{case.name}: displacement relative to the slab without and with the cause{measured}.",
        svg_of(plot_displacements, *shown),
        interactive=interactive_displacements(*shown),
    )


def sentences(content, name):
    """Sentences for whoever must decide, a model each: which quantities the cause changes beyond their limits."""
    result, found = content.changes[name], []
    unit = content.motions[content.cases[name].motion].attrs["peak_acceleration"]
    for model in result["model"].values:
        told, silent = [], []
        for quantity in QUANTITIES:
            at = result.sel(model=model, quantity=quantity)
            if not np.isfinite(at["change"]):
                continue
            words, show = _WORDS[quantity]
            low, high = (float(limit) for limit in at["change_interval"])
            if low <= 0.0 <= high or not np.isfinite([low, high]).all():
                silent.append(words.partition(" [")[0])
                continue
            levels = ", ".join(f"{number(float(at[side]) * unit)}" for side in ("without", "extended"))
            told.append(
                f"{words} from {show(at['without'])} to {show(at['extended'])}, by {show(at['change'])} "
                f"[{show(low)}, {show(high)}]"
                + (f" (peak accelerations {levels} m/s{SQUARED})" if quantity == "safe_scale" else "")
            )
        changed = "; ".join(told) or "nothing beyond its limits"
        unchanged = f" Not told from no change: {', '.join(silent)}." if silent else ""
        count = int(result["paired"].sel(model=model))
        found.append(
            f"{model_label(model)}, {count} pairs of samples: the cause changes {changed}.{unchanged}"
        )
    return found


def _transfer(content):
    """Gain of the cause on measured tests, those that it was named by and those that it was not; none without tests."""
    rows = []
    for name, result in content.changes.items():
        case = content.cases[name]
        if case.measured is None:
            continue
        named = name in content.study["extension"]["named_by"]
        for model in result["model"].values:
            at = result.sel(model=model)
            limits = ", ".join(number(limit, 2) for limit in at["gain_interval"].values)
            gain = f"{number(at['gain'], 2)} [{limits}]" if np.isfinite(at["gain"]) else MISSING
            rows.append((
                name, f"{case.settings['measured']['test']}, {case.curve_word}", "yes" if named else "no",
                model_label(model), *(millimetres(score) for score in at["score"].values), gain,
            ))  # fmt: skip
    if not rows:
        return []
    caption = (
        "Does naming the cause predict other tests? Score: continuous ranked probability score of the samples against "
        "the measured curves, relative to the slab, mean over blocks and times; smaller is better. Gain: share of the "
        "error without the cause that the cause removes, 1 where nothing is left; none where the samples without the "
        "cause fit within chance, or are too few. A test that the cause was named by is no test of a prediction."
    )
    header = ("Case", "Test", "Named by it", "Model", "Score without [mm]", "Score with [mm]", "Gain [1]")
    return [Heading("Transfer", "transfer"), Table(caption, header, tuple(rows), "llllrrr")]
