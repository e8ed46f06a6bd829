"""Statements on envelopes: their thickness, rocking, residuals, and the variables behind them."""

from blockshake.report.document.wording import (
    given,
    millimetres,
    model_label,
    number,
    parameter_label,
    share_words,
)
from blockshake.report.study.sensitivity.summary import markers_by_height, thickness_by_case
from blockshake.report.study.statements.specimens import HEIGHTS
from blockshake.report.study.statements.statement import judged, missing, unjudged
from blockshake.study.ensembles.intervals import SURE_FROM
from blockshake.study.sensitivity.findings import influences, is_known
from blockshake.study.sensitivity.thickness import growth_with_structure

_FIRST, _THIRD, _FOURTH = "configuration-1", "configuration-3", "configuration-4"
_MATTER = {"friction": "friction", "density": "density", "youngs_modulus": "stiffness"}


def upward(content, model):
    """Thickness from block to block."""
    if absent := missing(content, model):
        return unjudged(absent)
    known = {name: one for name, one in thickness_by_case(content, model).items() if one.known}
    if not known:
        return unjudged("Too few samples completed.")
    grows = [name for name, one in known.items() if one.grows_upward]
    told = "; ".join(
        f"{name} {', '.join(millimetres(spread) for spread in one.spread)} mm" for name, one in known.items()
    )
    return judged(
        len(grows) == len(known),
        f"Standard deviation from the lowest block up{_level(content)}: {told}. It grows from each block to the next "
        f"in {share_words(len(grows), len(known))} cases.",
    )


def than_first(content, model):
    """Thickness at the top of configurations 2 to 4 against configuration 1."""
    return _tops(content, model, [name for name in content.cases if name != _FIRST], _FIRST)


def fourth_than_third(content, model):
    """Thickness at the top of configuration 4 against configuration 3."""
    return _tops(content, model, [_FOURTH], _THIRD)


def _tops(content, model, thicker, thinner):
    """Finding that the tops of some cases have thicker envelopes than that of another one."""
    if absent := missing(content, model):
        return unjudged(absent)
    found = {name: one for name, one in thickness_by_case(content, model).items() if one.known}
    thicker = [name for name in thicker if name in found and name in HEIGHTS]
    if thinner not in found or not thicker:
        return unjudged(f"This study lacks one of the cases to compare: it has {', '.join(content.cases)}.")
    if len({found[name].shaking for name in (thinner, *thicker)}) > 1:
        return unjudged("The cases are shaken differently, which the structures cannot be told from.")
    base = found[thinner].spread[-1]
    told = ", ".join(f"{name} {millimetres(found[name].spread[-1])} mm" for name in thicker)
    return judged(
        all(found[name].spread[-1] > base for name in thicker),
        f"Standard deviation at the top{_level(content)}: {thinner} {millimetres(base)} mm, {told}. Another level may "
        "have another order.",
    )


def with_structure(content, models):
    """Thickness at the top with the number of blocks, model by model."""
    own = [model for model in models if model in content.study["models"]]
    if not own:
        return unjudged(missing(content, *models))
    told, holds, counted = [], True, 0
    for model in own:
        growth = growth_with_structure(thickness_by_case(content, model).values())
        counted += growth.pairs
        holds = holds and growth.thicker == growth.pairs
        told.append(f"{model_label(model)} {share_words(growth.thicker, growth.pairs)}")
    if not counted:
        return unjudged("This study has no two structures of different numbers of blocks.")
    absent = missing(content, *models)
    return judged(
        holds,
        f"Pairs of structures of which the one of more bodies is thicker at the top{_level(content)}: "
        f"{', '.join(told)}.{' ' + absent if absent else ''}",
    )


def rocking(content):
    """Rotations by configuration, LS-DEM."""
    if absent := missing(content, "ls-dem"):
        return unjudged(absent)
    if _FIRST not in content.cases or len(content.cases) < 2:
        return unjudged(f"This study lacks one of the cases to compare: it has {', '.join(content.cases)}.")
    turned = {}
    for name, case in content.cases.items():
        free = [
            body
            for body, driven in zip(case.structure.body_names, case.structure.driven, strict=True)
            if not driven
        ]
        rotation = case.responses["ls-dem"].samples["peak_rotation"].sel(body=free).max("body")
        turned[name] = float(rotation.median("sample"))
    told = ", ".join(f"{name} {number(1e3 * value)} mrad" for name, value in turned.items())
    others = [value for name, value in turned.items() if name != _FIRST]
    return judged(
        turned[_FIRST] < min(others),
        f"Largest rotation of any block, median over the samples{_level(content)}: {told}.",
    )


def parameters_matter(content):
    """Friction, density and stiffness behind the envelopes of LS-DEM."""
    if absent := missing(content, "ls-dem"):
        return unjudged(absent)
    shown, seconds, known = {}, [], False
    for case in content.cases.values():
        top = list(markers_by_height(case).values())[-1]
        result = case.responses["ls-dem"].sensitivity.sel(marker=top)
        beyond = (result["window_first_order"] > result["window_first_order_chance"]).sum("window")
        seconds += [
            f"{case.name} {parameter_label(str(name))} {int(count)}"
            for name, count, control in zip(
                result["parameter"].values, beyond.values, result["control"].values, strict=True
            )
            if count and not control
        ]
        for quantity, measure in (("history", "first_order"), ("peak", "rank_correlation")):
            at = result.sel(quantity=quantity)
            if not is_known(at, measure):
                continue
            known = True
            for one in influences(at, measure).beyond_chance:
                if not one.control:
                    shown.setdefault(case.name, {})[one.parameter] = None
    if not known:
        return unjudged("The samples are too few for a sensitivity.")
    told = "; ".join(f"{name}: {', '.join(map(parameter_label, names))}" for name, names in shown.items())
    lacking = [
        words
        for key, words in _MATTER.items()
        if not any(key in name for names in shown.values() for name in names)
    ]
    words = f"Beyond chance at the top{_level(content)} over the whole window: {told or 'no variable'}."
    if lacking:
        words += f" Not so: {', '.join(lacking)}."
    if seconds:
        words += f" Beyond chance in so many single seconds: {'; '.join(seconds)}."
    return judged(not lacking, words)


def residuals(content):
    """Scatter of the residual displacement, largest in configuration 4."""
    if _FOURTH not in content.cases or len(content.cases) < 2:
        return unjudged(f"This study lacks one of the cases to compare: it has {', '.join(content.cases)}.")
    told, holds = [], True
    for model in content.study["models"]:
        scatter = {}
        for name, case in content.cases.items():
            top = list(markers_by_height(case).values())[-1]
            at = case.responses[model].envelope["residual"].sel(frame="slab", marker=top)
            if int(case.responses[model].envelope.attrs["counted"]) >= SURE_FROM:
                scatter[name] = float(at.sel(quantile=0.95) - at.sel(quantile=0.05))
        if _FOURTH not in scatter or len(scatter) < 2:
            continue  # too few samples
        holds = holds and max(scatter, key=scatter.get) == _FOURTH
        told.append(
            f"{model_label(model)} "
            + ", ".join(f"{name} {millimetres(value)} mm" for name, value in scatter.items())
        )
    if not told:
        return unjudged(f"No model has {SURE_FROM} samples of configuration 4 and of another case.")
    return judged(
        holds,
        f"From the 5 to the 95 % quantile of the residual at the top{_level(content)}, by models with at least "
        f"{SURE_FROM} samples: {'; '.join(told)}.",
    )


def _level(content):
    """Level of shaking of the cases, in words."""
    scales = sorted({case.settings["scale"] for case in content.cases.values()})
    return f" at scale {' and '.join(map(given, scales))}"
