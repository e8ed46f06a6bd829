"""Statements on the responses: thickness of the envelopes, residuals, joints, and the variables behind them."""

from itertools import combinations

import numpy as np

from blockshake.geometry.structure import load_structure
from blockshake.pages.wording import given, millimetres, model_label, parameter_label, percent, share_words
from blockshake.statistics.intervals import SURE_FROM, quantile_interval, sample_quantiles
from blockshake.study.analyses import OF_THE_PAPER
from blockshake.study.ensembles.ensemble import RESIDUAL_WINDOW
from blockshake.study.ensembles.envelope import counted_samples
from blockshake.study.sensitivity.findings import influences, is_known, markers_by_height
from blockshake.study.statements.order import Limited, all_of, ordered
from blockshake.study.statements.statement import judged, scale_words, unjudged

FIRST, SECOND, THIRD, FOURTH = OF_THE_PAPER
STACKS_AND_WALLS = [(stack, walls) for stack in (FIRST, SECOND) for walls in (THIRD, FOURTH)]
_MATTER = {"friction": "friction", "density": "density", "youngs_modulus": "stiffness"}
_BRACKET = 0.05 * 9.81  # m/s2; shaking beyond it is strong


def upward(content, model):
    """Thickness of the envelopes from block to block."""
    spreads = {}
    for name, case in content.cases.items():
        chosen = {"quantity": "history", "marker": list(markers_by_height(case).values())}
        spread = case.responses[model].sensitivity["spread"].sel(chosen).to_numpy()
        if np.isfinite(spread).all() and len(spread) > 1:
            spreads[name] = spread
    if not spreads:
        return unjudged("Too few samples completed.")
    grows = sum((np.diff(spread) > 0.0).all() for spread in spreads.values())
    shown = "; ".join(f"{name} {', '.join(map(millimetres, spread))} mm" for name, spread in spreads.items())
    return judged(
        grows == len(spreads),
        f"Standard deviation from the lowest block up{scale_words(content)}: {shown}. It grows from each block to the "
        f"next in {share_words(grows, len(spreads))} cases. There are no limits: "
        "the blocks of a structure move together in each sample.",
    )


def thicker_tops(content, model, pairs):
    """Thickness of the envelopes at the top: of each pair of cases, the second has the thicker one."""
    words = "Mean difference of two samples at the top in mm"
    return ordered(content, _at_top(content, model, "width"), pairs, words, millimetres)


def with_structure(content, models):
    """Thickness of the envelopes at the top with the number of blocks, model by model."""
    blocks = {name: int((~load_structure(name).driven).sum()) for name in OF_THE_PAPER}
    pairs = [pair for pair in combinations(OF_THE_PAPER, 2) if blocks[pair[0]] < blocks[pair[1]]]
    return all_of({model_label(model): thicker_tops(content, model, pairs) for model in models})


def _at_top(content, model, name):
    """A figure of a model's samples at the top with its limits [m], by case with samples enough for limits."""
    tops = {}
    for case in content.cases.values():
        top = list(markers_by_height(case).values())[-1]
        at = case.differences.sel(model=model, marker=top)
        limits = at[f"{name}_interval"].transpose("bound").to_numpy()
        if int(at["counted"]) >= SURE_FROM and np.isfinite(limits).all():
            tops[case.name] = Limited(float(at[name]), *map(float, limits))
    return tops


def parameters_matter(content):
    """Friction, density and stiffness behind the envelopes of LS-DEM."""
    shown, levels = {}, []
    for case in content.cases.values():
        top = list(markers_by_height(case).values())[-1]
        result = case.responses["ls-dem"].sensitivity.sel(marker=top)
        for quantity, measure in (("history", "first_order"), ("peak", "rank_correlation")):
            at = result.sel(quantity=quantity)
            if not is_known(at, measure):
                continue
            known = influences(at, measure)
            levels.append(known.chance)
            for one in known.beyond_chance:
                if not one.control:
                    shown.setdefault(case.name, {})[one.parameter] = None
    if not levels:
        return unjudged("The samples are too few for a sensitivity.")
    variables = "; ".join(
        f"{name}: {', '.join(map(parameter_label, names))}" for name, names in shown.items()
    )
    lacking = [
        words
        for key, words in _MATTER.items()
        if not any(key in name for names in shown.values() for name in names)
    ]
    words = f"Beyond chance at the top{scale_words(content)}: {variables or 'no variable'}."
    if not lacking:
        return judged(True, words)
    return unjudged(
        f"{words} Not so: {', '.join(lacking)}. Chance alone makes a share or a correlation of {min(levels):.2f} to "
        f"{max(levels):.2f}; no evidence of a smaller influence is no evidence against it."
    )


def residuals(content):
    """Scatter of the residual displacement, largest in configuration 4."""
    shaken = [name for name, case in content.cases.items() if _still_shaken(content, case)]
    if shaken:
        return unjudged(
            f"The table shakes by more than {given(_BRACKET / 9.81)} g, the bracket of Bolt (1969), in the last "
            f"{given(RESIDUAL_WINDOW)} s of the runs, whose mean is the residual: {', '.join(shaken)}."
        )
    pairs = [(other, FOURTH) for other in (FIRST, SECOND, THIRD)]
    words = "From the 5 to the 95 % quantile of the residual at the top in mm"
    return all_of(
        {
            model_label(model): ordered(
                content, _at_top(content, model, "residual_range"), pairs, words, millimetres
            )
            for model in content.study["models"]
        }
    )


def _still_shaken(content, case):
    """Whether strong shaking lasts into the window of the residual."""
    motion = content.motions[case.motion]["acceleration"]
    end = case.settings["duration"]
    last = motion.sel(time=slice(end - RESIDUAL_WINDOW, end))
    return bool((abs(case.settings["scale"] * last) > _BRACKET).any())


def occurrences(content):
    """Share of the joints that open by LS-DEM, smallest in configuration 1."""
    pairs = [(FIRST, other) for other in (SECOND, THIRD, FOURTH)]
    return _joints_move(content, "ls-dem", ["joint_uplift"], pairs, "whose middle opens")


def complicated(content):
    """Share of the joints that open or slip, larger in configurations 3 and 4, model by model."""
    names, words = ["joint_uplift", "joint_slip"], "at whose middle the faces part or slip"
    return all_of(
        {
            model_label(model): _joints_move(content, model, names, STACKS_AND_WALLS, words)
            for model in content.study["models"]
        }
    )


def _joints_move(content, model, names, pairs, words):
    """Share of the joints that move beyond the markers' noise: of each pair of cases, the second has the larger one.

    A larger structure has more joints, so that their number would follow from the structure alone. A block that rocks
    moves the middle of its joint along the face too, so that slip alone would count it.
    """
    shares, joints = {}, []
    for name, case in content.cases.items():
        samples = counted_samples(case.responses[model].samples)
        joints.append(f"{samples.sizes['joint']} of {name}")
        if samples.sizes["sample"] >= SURE_FROM:
            beyond = samples[names].to_dataarray().max("variable") > case.marker_noise
            by_sample = beyond.mean("joint").values
            median, limits = sample_quantiles(by_sample, [0.5])[0], quantile_interval(by_sample, [0.5])[:, 0]
            shares[name] = Limited(float(median), *map(float, limits))
    sentence = f"Share of the joints ({', '.join(joints)}) {words} by more than a marker's noise in %"
    return ordered(content, shares, pairs, f"{sentence}, median over the samples", percent, ceiling=1.0)
