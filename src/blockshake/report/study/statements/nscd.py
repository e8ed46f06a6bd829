"""Statements on nonsmooth contact dynamics."""

import numpy as np

from blockshake.geometry.schema import Material
from blockshake.report.document.wording import given, model_label, number, parameter_label
from blockshake.report.study.statements.statement import judged, missing, setting, unjudged
from blockshake.simulation.models import MODELS
from blockshake.solvers.nscd.contact.overlap_polygon import choose_four_into
from blockshake.study.ensembles.outcomes import count_outcomes, numerical_figure

_CONSERVED = 0.01  # of the energy in play: a residual below it counts as none
DEFORMABLE = ("nscd-elastic", "nscd-viscoelastic")
_RIGID = "nscd-rigid"


def converged(content):
    """Iteration until convergence in each step."""
    models = _models(content)
    if not models:
        return unjudged("This study has no nonsmooth model.")
    told, capped, counted = [], 0, 0
    for model in models:
        steps = sum(_figure(content, model, "numerics_steps", np.sum))
        if not steps:
            told.append(f"{model_label(model)}: no sample has figures of its steps.")
            continue
        at_cap = sum(_figure(content, model, "numerics_capped_steps", np.sum))
        worst = max(_figure(content, model, "numerics_max_residual", np.max), default=np.nan)
        tolerance = setting(content, model, f"{MODELS[model].prefix}.tolerance")
        capped, counted = capped + at_cap, counted + steps
        told.append(
            f"{model_label(model)}: of the steps of all samples {number(100.0 * at_cap / steps, 2)} % ({at_cap:.0f}) "
            f"stopped at the iteration limit before the tolerance of {given(tolerance)}, which the paper does not "
            f"state; largest relative residual {number(worst)}."
        )
    return judged(capped == 0, " ".join(told)) if counted else unjudged(" ".join(told))


def conserves(content):
    """Energy without damping."""
    if absent := missing(content, _RIGID):
        return unjudged(absent)
    theta = setting(content, _RIGID, "nscd.theta")
    residuals = _figure(content, _RIGID, "energy_residual", np.max)
    if not residuals:
        return unjudged("The runs of this study have no energy audit.")
    outcomes = [
        count_outcomes(case.responses[_RIGID].samples["status"].values) for case in content.cases.values()
    ]
    failed, every = sum(one.failed for one in outcomes), sum(sum(one) for one in outcomes)
    return judged(
        max(residuals) < _CONSERVED and not failed,
        f"With theta {given(theta)} and no damping, and the energy that impacts and friction take counted, the audit "
        f"misses {number(max(residuals))} of the energy in play at most; {given(_CONSERVED)} counts as conserved. "
        "The terms add up by the scheme itself at theta 0.5. "
        f"Numerical failures: {failed} of {every} samples.",
    )


def four_points(content):
    """Contact points of an overlap of eight corners."""
    del content
    turns = 0.25 * np.pi * np.arange(8)
    corners = np.column_stack([np.cos(turns), np.sin(turns), np.zeros(8)])
    chosen = np.empty(4, dtype=np.int64)
    kept = choose_four_into(corners, np.zeros(8), len(corners), np.array([0.0, 0.0, 1.0]), chosen)
    return judged(
        kept <= 4,
        f"Of an overlap with {len(corners)} corners the rule of choice keeps {kept}. The rigid blocks here are "
        "polyhedra without a mesh; a joint with an elastic layer has its middle as one more.",
    )


def shrunk(content):
    """Contact areas that are drawn in by an amount not stated."""
    if absent := missing(content, _RIGID):
        return unjudged(absent)
    share = setting(content, _RIGID, "nscd.shrink")
    return unjudged(
        f"The paper states no amount. The lengths of the areas are drawn in by {given(share)} here."
    )


def mesh_size(content):
    """Mesh of the deformable blocks."""
    models = [model for model in DEFORMABLE if model in content.study["models"]]
    if not models:
        return unjudged(missing(content, *DEFORMABLE))
    sizes = {setting(content, model, "nscd_deformable.mesh_size") for model in models}
    return judged(sizes == {0.2}, f"The edges of the mesh are {', '.join(map(given, sorted(sizes)))} m.")


def no_restitution(content):
    """Impacts without rebound."""
    if not _models(content):
        return unjudged("This study has no nonsmooth model.")
    values = {case.structure.file.nscd_restitution for case in content.cases.values()}
    words = ", ".join(map(given, sorted(values)))
    return judged(values == {0.0}, f"Newton's coefficient of restitution is {words}.")


def steepness(content):
    """Contacts of infinite steepness against springs of finite steepness, Fig. 3: the laws, not the steps' errors."""
    if absent := missing(content, "ls-dem", _RIGID):
        return unjudged(absent)
    deepest = max(_figure(content, _RIGID, "numerics_max_penetration", np.max), default=np.nan)
    if not np.isfinite(deepest):
        return unjudged("The runs of this study do not say how deep rigid blocks overlap.")
    sinks = [
        _sink(content.cases[name].structure, float(calibrated.waves["stiffness"].sel(direction="normal")))
        for calibrated in content.calibrated
        for name in calibrated.cases
        if all(
            content.cases[name].structure.file.shapes[one.shape].box
            for one in content.cases[name].structure.file.bodies
        )
    ]
    if not sinks:
        return unjudged("The structures of this study are not of boxes alone.")
    springs = {
        label: MODELS[name].stiffness for name, label in (("ls-dem", "LS-DEM"), (_RIGID, "rigid NSCD"))
    }
    return judged(
        bool(springs["LS-DEM"]) and not springs["rigid NSCD"],
        f"Stiffnesses of contact: {', '.join(f'{len(names)} of {label}' for label, names in springs.items())}. Under "
        f"its own weight a stack sinks by {number(1e6 * min(sinks))} to {number(1e6 * max(sinks))} micrometres into "
        f"the springs of its lowest joint. The deepest penetration by NSCD, {number(1e6 * deepest)} micrometres, is an "
        "error of its steps.",
    )


def no_modulus(content):
    """No elastic modulus in the rigid model."""
    if absent := missing(content, "ls-dem", _RIGID):
        return unjudged(absent)
    unused = {model: MODELS[model].without_effect for model in ("ls-dem", _RIGID)}
    words = "; ".join(
        f"{model_label(model)} has no use for "
        + " and ".join(
            parameter_label(f"materials.the blocks.{name}") for name in names if name in Material.model_fields
        )
        for model, names in unused.items()
    )
    holds = "youngs_modulus" in unused[_RIGID] and "youngs_modulus" not in unused["ls-dem"]
    return judged(holds, f"{words}.")


def dear_steps(content):
    """Few steps, each of them dear."""
    if absent := missing(content, "ls-dem", _RIGID):
        return unjudged(absent)
    ratios = []
    for name in content.cases:
        cost = {one.model: one.cpu_per_simulated for one in content.timings if one.case == name}
        by_step = {
            model: cost[model] * content.study["models"][model]["time_step"] for model in ("ls-dem", _RIGID)
        }
        ratios.append((name, by_step[_RIGID] / by_step["ls-dem"], cost[_RIGID] / cost["ls-dem"]))
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


def _models(content):
    return [model for model in content.study["models"] if model.startswith("nscd")]


def _figure(content, model, name, statistic):
    """A figure of the computation by a model, one for each case that has it."""
    found = [
        numerical_figure(case.responses[model].samples, name, statistic) for case in content.cases.values()
    ]
    return [one for one in found if np.isfinite(one)]


def _sink(structure, stiffness):
    """Depth to which the weight of the free bodies presses the lowest joints [m]."""
    free = ~structure.driven
    lowest = min(structure.centroid[free, 2])
    area = 0.0
    for body in (index for index in free.nonzero()[0] if structure.centroid[index, 2] < lowest + 1e-6):
        shape = structure.file.shapes[structure.file.bodies[body].shape]
        width, depth = (edge - 2.0 * shape.chamfer for edge in shape.box[:2])
        area += width * depth
    return float(structure.mass[free].sum() * abs(structure.file.gravity[2]) / (stiffness * area))
