"""Judges of what Zhou et al. (2023) say of their solvers, samples and contact stiffness: of `the_paper`."""

from pathlib import Path

import numpy as np
from scipy.stats import pearsonr, spearmanr
from timing import read_timings

from blockshake.geometry.reference_block import reference_body
from blockshake.pages.rows import face_markers
from blockshake.pages.wording import given, model_label, number, parameter_label, percent
from blockshake.simulation.models import MODELS
from blockshake.study.ensembles.outcomes import count_outcomes, numerical_figure
from blockshake.study.sampling.distributions import TABLE_2

SIZE = 50
ONE_NUMBER = 1e-3  # relative spread below which a ratio counts as one number in all samples
_SHOWN = 0.05  # chance at or below which a correlation is shown
_CONSERVED = 0.01  # of the energy in play: a residual below it counts as none
_LOW_VARIABILITY = 0.1  # half of an interval over its median
_SOFT, _RIGID = "ls-dem", "nscd-rigid"


def stable_step(content):
    """The explicit scheme with a step that is stable, Eq. (6)."""
    step = content.study["models"][_SOFT]["time_step"]
    limit = min(_figures(content, _SOFT, "numerics_stable_time_step", np.min))
    residual = max(_figures(content, _SOFT, "energy_residual", np.max))
    return step <= limit, (
        f"The step is {given(step)} s, and the smallest limit of stability among the samples, with the joints of "
        f"the start, is {number(limit)} s. "
        f"The energy audit, in which forces and moments work, misses {number(residual)} of the energy in play at most."
    )


def converged(content):
    """Iteration until convergence in each step."""
    words, capped = [], 0
    for model in (model for model in content.study["models"] if model != _SOFT):
        steps = sum(_figures(content, model, "numerics_steps", np.sum))
        at_cap = sum(_figures(content, model, "numerics_capped_steps", np.sum))
        worst = max(_figures(content, model, "numerics_max_residual", np.max))
        tolerance = _setting(content, model, f"{MODELS[model].prefix}.tolerance")
        capped += at_cap
        words.append(
            f"{model_label(model)}: of the steps of all samples {number(100.0 * at_cap / steps, 2)} % ({at_cap:.0f}) "
            f"stopped at the iteration limit before the tolerance of {given(tolerance)}, which the paper does not "
            f"state; largest relative residual {number(worst)}."
        )
    return capped == 0, " ".join(words)


def conserves(content):
    """Energy without damping."""
    residual = max(_figures(content, _RIGID, "energy_residual", np.max))
    outcomes = [
        count_outcomes(one.responses[_RIGID].samples["status"].values) for one in content.cases.values()
    ]
    failed, every = sum(one.failed for one in outcomes), sum(sum(one) for one in outcomes)
    return residual < _CONSERVED and not failed, (
        f"With theta {given(_setting(content, _RIGID, 'nscd.theta'))} and no damping, and the energy that impacts and "
        f"friction take counted, the audit misses {number(residual)} of the energy in play at most; "
        f"{given(_CONSERVED)} counts as conserved. The terms add up by the scheme itself at theta 0.5. "
        f"Numerical failures: {failed} of {every} samples."
    )


def dear_steps(content):
    """Few steps, each of them dear."""
    words, dearer = [], []
    samples = {
        (model, name): one.samples
        for name, case in content.cases.items()
        for model, one in case.responses.items()
    }
    timings = read_timings(Path("logs", content.study["name"]), samples)
    for name in content.cases:
        cost = {one.model: one.cpu_per_simulated for one in timings if one.case == name}
        steps = {
            model: cost[model] * content.study["models"][model]["time_step"] for model in (_SOFT, _RIGID)
        }
        dearer.append(steps[_RIGID] > steps[_SOFT])
        words.append(
            f"{name} {number(steps[_RIGID] / steps[_SOFT])} times a step and {number(cost[_RIGID] / cost[_SOFT])} "
            "times a simulated second"
        )
    told = ", ".join(words)
    return all(
        dearer
    ), f"CPU time of rigid NSCD over that of LS-DEM, parts of a step counted with the step: {told}."


def table_2(content):
    """Distributions of Table 2 and their samples, Fig. 8."""
    summary, asked = content.design_summary, content.distributions
    mean = max(abs(summary["mean"][name] / one.mean - 1.0) for name, one in asked.items())
    short = [1.0 - summary["cov"][name] / one.cov for name, one in asked.items()]
    other = sorted(name for name in {**asked, **TABLE_2} if asked.get(name) != TABLE_2.get(name))
    return not other, (
        f"Other than in the table: {', '.join(map(parameter_label, other)) or 'none'}. The samples' means are off by "
        f"{percent(mean)} % at most; their coefficients of variation fall short by {percent(min(short))} to "
        f"{percent(max(short))} %."
    )


def correlation_control(content):
    """Correlation of the samples against the target."""
    summary = content.design_summary
    error, chance = summary["rms_correlation_error"], 1.0 / np.sqrt(summary["size"] - 1.0)
    target = "that of the configuration" if content.study["ensemble"].get("correlation") else "none"
    return error < 0.1 * chance, (
        f"The paper states no correlation; requested here: {target}. The correlations of the samples miss it by "
        f"{number(error, 2)} rms and {number(summary['largest_correlation_error'], 2)} at most; pairs at random miss "
        f"it by {number(chance, 2)}. A tenth of that counts as controlled."
    )


def size(content):
    """Number of samples."""
    counts = [
        f"{count} of {case.name} by {model_label(model)}"
        for case in content.cases.values()
        for model in content.study["models"]
        if (count := case.responses[model].samples.sizes["sample"]) != len(content.design)
    ]
    fewer = f" Fewer: {', '.join(counts)}." if counts else ""
    return len(content.design) == SIZE and not counts, f"{len(content.design)} samples.{fewer}"


def low_variability(content):
    """Estimates of small designs that vary little: of ensembles of the whole design."""
    if len(content.design) != SIZE:
        return None, f"This study has {len(content.design)} samples, not {SIZE}."
    halves, fewer = {}, []
    for case in content.cases.values():
        at = {"frame": "slab", "marker": next(iter(face_markers(case.structure).values())), "quantile": 0.5}
        for model in content.study["models"]:
            one = case.responses[model]
            name, counted = f"{case.name}, {model_label(model)}", int(one.envelope.attrs["counted"])
            if counted < SIZE:
                fewer.append(f"{name} {counted}")
                continue
            limits = one.envelope["peak_interval"].sel(at)
            halves[name] = float(limits.max() - limits.min()) / (2.0 * float(one.envelope["peak"].sel(at)))
    smaller = f" Of fewer samples and not judged: {'; '.join(fewer)}." if fewer else ""
    return (bool(halves) and max(halves.values()) < _LOW_VARIABILITY) or None, (
        "Half of the 95 % interval, by order statistics, of the median peak at the top, over that median, of "
        f"{SIZE} samples: {'; '.join(f'{name} {percent(half)} %' for name, half in halves.items()) or 'none'}. "
        f"{percent(_LOW_VARIABILITY)} % counts as low. The interval takes the samples as independent; those of a Latin "
        f"hypercube vary less.{smaller}"
    )


def follow_moduli(content):
    """Stiffness and moduli over the samples: whether their ratio is one number."""
    words, one_number = [], []
    for calibrated in content.calibrated:
        material, moduli = _of_the_tower(content, calibrated, "youngs_modulus")
        shear = moduli / (2.0 + 2.0 * material.poisson_ratio)
        for label, column, modulus in (("k_n / E", "normal", moduli), ("k_s / G", "shear", shear)):
            stiffness = calibrated.stiffness[f"ls_dem.{column}_stiffness"].to_numpy()
            one_number.append(_spread(stiffness / modulus) < ONE_NUMBER)
            words.append(
                f"{label} {number((stiffness / modulus).mean(), 4)} per m, smallest and largest of {len(modulus)} "
                f"samples {number(100.0 * _spread(stiffness / modulus), 2)} % apart, correlation "
                f"{pearsonr(stiffness, modulus).statistic:.4f}"
            )
    return not any(one_number), (
        f"{'; '.join(words)}. A spread below {number(100.0 * ONE_NUMBER, 1)} % counts as one number."
    )


def heavier_blocks(content):
    """Stiffness at an equal modulus, and density over the samples."""
    words, rises = [], []
    for calibrated in content.calibrated:
        _, moduli = _of_the_tower(content, calibrated, "youngs_modulus")
        _, density = _of_the_tower(content, calibrated, "density")
        ratio = calibrated.stiffness["ls_dem.normal_stiffness"].to_numpy() / moduli
        found = spearmanr(ratio, density) if _spread(ratio) >= ONE_NUMBER else None  # else one number
        rises.append(found is not None and found.statistic > 0.0 and found.pvalue <= _SHOWN)
        words.append(
            f"k_n / E differs by {number(100.0 * _spread(ratio), 2)} % at most over densities from "
            f"{number(density.min(), 4)} to {number(density.max(), 4)} kg/m3"
        )
    return all(rises), (
        f"At an equal modulus {'; '.join(words)}. At an equal speed of the waves the modulus grows as the density, and "
        "k_n with it."
    )


def _figures(content, model, name, statistic):
    """A figure of the computation by a model, one for each case that has it; NaN where none has it."""
    found = [
        numerical_figure(one.responses[model].samples, name, statistic) for one in content.cases.values()
    ]
    return [one for one in found if np.isfinite(one)] or [np.nan]


def _setting(content, model, name):
    """Value of a numerical parameter of a model in the study: its default unless it is set."""
    chosen = content.study["models"][model].get("parameters", {})
    return chosen.get(name, MODELS[model].numerical_parameters()[name][0])


def _of_the_tower(content, calibrated, name):
    """Material of the blocks of a wave test, and the sampled values of one of its properties, shape (n_samples,)."""
    structure = content.cases[calibrated.cases[0]].structure
    material = structure.file.bodies[reference_body(structure)].material
    return structure.file.materials[material], content.design[f"materials.{material}.{name}"].to_numpy()


def _spread(ratio):
    """Largest over smallest of an array, less 1."""
    return ratio.max() / ratio.min() - 1.0
