"""Section on the limit states of the study's user."""

import numpy as np

from blockshake.pages.blocks import Items, Section, Table, Text
from blockshake.pages.units import quantity
from blockshake.pages.wording import limited, model_label, number, percent, share_words
from blockshake.study.fragility.figure import measure_words
from blockshake.study.limit_states.settings import LimitState


def limit_states(content):
    """Probability of each limit state by case and model; None where the study has none."""
    found = [
        (case.name, model, one.limits.sel(limit=name))
        for case in content.cases.values()
        for model, one in case.responses.items()
        if one.limits is not None
        for name in one.limits["limit"].values
    ]
    if not found:
        return None
    return Section(
        "Limit states",
        "limit-states",
        (
            Text(
                "Share of the samples in which a measure exceeds its limit, with limits of 95 % of the probability "
                "(Clopper and Pearson). They hold either outcome of samples whose run ended before it was known."
            ),
            Items(tuple(f"{case}, {model_label(model)}: {sentence(one)}." for case, model, one in found)),
            _table(content.study["limits"], found),
            *_fragilities(found),
        ),
    )


def sentence(found):
    """One limit state of a case by a model in words, from ``sel(limit=NAME)`` of `limit_states_of_case`."""
    outcomes = found["exceeded"].values
    known, count = int((outcomes >= 0).sum()), int((outcomes == 1).sum())
    low, high = found["probability_interval"].values
    left = f"; {len(outcomes) - known} not known" if known < len(outcomes) else ""
    return (
        f"{found['limit'].item()} ({found['measure'].item().replace('_', ' ')} over {_shown_limit(found)}): "
        f"{share_words(count, known)} samples{left}; probability {percent(low)} to {percent(high)} %"
    )


def _shown_limit(found):
    """The limit with its unit; angles in degrees, as users state them."""
    value, unit = float(found["limit_value"]), found["unit"].item()
    return f"{number(np.degrees(value))} deg" if unit == "rad" else quantity(value, unit)


def _table(limits, found):
    rows = []
    for case, model, one in found:
        name = str(one["limit"].item())
        state, outcomes = LimitState(**limits[name]), one["exceeded"].values
        low, high = one["probability_interval"].values
        share = "not known" if one["probability"].isnull() else f"{percent(float(one['probability']))} %"
        rows.append((
            name, " and ".join(state.bodies), state.measure.replace("_", " "),
            _shown_limit(one), case, model_label(model),
            f"{int((outcomes == 1).sum())} of {int((outcomes >= 0).sum())}", share,
            f"{percent(low)} to {percent(high)} %", str(int((outcomes < 0).sum())),
        ))  # fmt: skip
    return Table(
        "Limit states: samples beyond the limit of those that are known, and the probability.",
        ("Limit state", "Of", "Measure", "Limit", "Case", "Model", "Beyond", "Probability", "95 %", "Not known"),
        tuple(rows), "llllllrrrr",
    )  # fmt: skip


def _fragilities(found):
    """Table of the fragilities over the intensity, where the samples draw motions."""
    rows = []
    for case, model, one in found:
        if "median" not in one:
            continue
        for method, label in (("regression", "regression"), ("counts", "counts")):
            fit = one.sel(fit=method)
            rows.append((
                str(one["limit"].item()), case, model_label(model), label,
                limited(fit, "median"), limited(fit, "safe"), limited(fit, "dispersion"),
            ))  # fmt: skip
    if not rows:
        return []
    first = next(one for _, _, one in found if "median" in one)
    name, unit = measure_words(first.assign_attrs(measure=first.attrs["intensity_measure"]))
    return [
        Table(
            f"Fragilities of the limit states over {name} [{unit}]: intensity that half, and that 5 % of the samples "
            "exceed, with limits of 95 %.",
            ("Limit state", "Case", "Model", "By", "Median", "5 %", "Dispersion"),
            tuple(rows),
            "llllrrr",
        )
    ]
