"""Statements on the solvers: stability, convergence, energy and cost of their steps."""

import numpy as np

from blockshake.pages.wording import given, model_label, number
from blockshake.simulation.models import MODELS
from blockshake.study.ensembles.outcomes import count_outcomes, numerical_figure
from blockshake.study.statements.statement import judged, unjudged

_CONSERVED = 0.01  # of the energy in play: a residual below it counts as none
RIGID = "nscd-rigid"


def stable_step(content):
    """Eq. (6) and the explicit scheme with a step that is stable."""
    samples = [case.responses["ls-dem"].samples for case in content.cases.values()]
    step = content.study["models"]["ls-dem"]["time_step"]
    limit = min(numerical_figure(one, "numerics_stable_time_step", np.min) for one in samples)
    residual = max(numerical_figure(one, "energy_residual", np.max) for one in samples)
    if not np.isfinite(limit):
        return unjudged("The runs of this study do not say which step is stable.")
    return judged(
        step <= limit,
        f"The step is {given(step)} s, and the smallest limit of stability among the samples, with the joints of "
        f"the start, is {number(limit)} s. "
        f"The energy audit, in which forces and moments work, misses {number(residual)} of the energy in play at most.",
    )


def converged(content):
    """Iteration until convergence in each step."""
    models = [model for model in content.study["models"] if model.startswith("nscd")]
    if not models:
        return unjudged("This study has no nonsmooth model.")
    words, capped, counted = [], 0, 0
    for model in models:
        steps = sum(_figure(content, model, "numerics_steps", np.sum))
        if not steps:
            words.append(f"{model_label(model)}: no sample has figures of its steps.")
            continue
        at_cap = sum(_figure(content, model, "numerics_capped_steps", np.sum))
        worst = max(_figure(content, model, "numerics_max_residual", np.max), default=np.nan)
        tolerance = _setting(content, model, f"{MODELS[model].prefix}.tolerance")
        capped, counted = capped + at_cap, counted + steps
        words.append(
            f"{model_label(model)}: of the steps of all samples {number(100.0 * at_cap / steps, 2)} % ({at_cap:.0f}) "
            f"stopped at the iteration limit before the tolerance of {given(tolerance)}, which the paper does not "
            f"state; largest relative residual {number(worst)}."
        )
    return judged(capped == 0, " ".join(words)) if counted else unjudged(" ".join(words))


def conserves(content):
    """Energy without damping."""
    theta = _setting(content, RIGID, "nscd.theta")
    residuals = _figure(content, RIGID, "energy_residual", np.max)
    if not residuals:
        return unjudged("The runs of this study have no energy audit.")
    outcomes = [
        count_outcomes(case.responses[RIGID].samples["status"].values) for case in content.cases.values()
    ]
    failed, every = sum(one.failed for one in outcomes), sum(sum(one) for one in outcomes)
    return judged(
        max(residuals) < _CONSERVED and not failed,
        f"With theta {given(theta)} and no damping, and the energy that impacts and friction take counted, the audit "
        f"misses {number(max(residuals))} of the energy in play at most; {given(_CONSERVED)} counts as conserved. "
        "The terms add up by the scheme itself at theta 0.5. "
        f"Numerical failures: {failed} of {every} samples.",
    )


def dear_steps(content):
    """Few steps, each of them dear."""
    ratios = []
    for name in content.cases:
        cost = {one.model: one.cpu_per_simulated for one in content.timings if one.case == name}
        by_step = {
            model: cost[model] * content.study["models"][model]["time_step"] for model in ("ls-dem", RIGID)
        }
        ratios.append((name, by_step[RIGID] / by_step["ls-dem"], cost[RIGID] / cost["ls-dem"]))
    if not all(np.isfinite(ratio) for _, *pair in ratios for ratio in pair):
        return unjudged("Logs of this study's jobs do not tell their cost.")
    told = ", ".join(
        f"{name} {number(step)} times a step and {number(whole)} times a simulated second"
        for name, step, whole in ratios
    )
    return judged(
        all(step > 1.0 for _, step, _ in ratios),
        f"CPU time of rigid NSCD over that of LS-DEM, parts of a step counted with the step: {told}.",
    )


def _figure(content, model, name, statistic):
    """A figure of the computation by a model, one for each case that has it."""
    found = [
        numerical_figure(case.responses[model].samples, name, statistic) for case in content.cases.values()
    ]
    return [one for one in found if np.isfinite(one)]


def _setting(content, model, name):
    """Value of a numerical parameter of a model in the study, by dotted name: its default unless it is set."""
    chosen = content.study["models"][model].get("parameters", {})
    return chosen.get(name, MODELS[model].numerical_parameters()[name][0])
