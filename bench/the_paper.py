"""Statements of Zhou et al. (2023) that a finished study decides, for docs/results/the-paper.md.

A judge takes the `Content` of a study to a verdict and the numbers that it rests on: true where the study finds or does
the same, false where it does not, None where it cannot tell. Statements that no study decides are a table of the page.
"""

from dataclasses import replace
from itertools import combinations
from pathlib import Path

import numpy as np
from scipy.stats import pearsonr, spearmanr
from timing import read_timings

from blockshake.geometry.reference_block import reference_body
from blockshake.geometry.structure import load_structure
from blockshake.pages.rows import face_markers
from blockshake.pages.wording import (
    given,
    millimetres,
    model_label,
    number,
    parameter_label,
    percent,
    share_words,
)  # fmt: skip
from blockshake.simulation.models import MODELS
from blockshake.statistics.intervals import SURE_FROM, quantile_interval, sample_quantiles
from blockshake.study.analyses import OF_THE_PAPER
from blockshake.study.ensembles.envelope import counted_samples
from blockshake.study.ensembles.outcomes import count_outcomes, numerical_figure
from blockshake.study.sampling.distributions import TABLE_2
from blockshake.study.sensitivity.findings import influences, is_known, markers_by_height

HEADER = ("Place", "Statement of the paper", "Verdict", "Finding")
VERDICTS = {True: "met", False: "not met", None: "cannot be judged"}
FIRST, SECOND, THIRD, FOURTH = OF_THE_PAPER
STACKS_AND_WALLS = [(stack, walls) for stack in (FIRST, SECOND) for walls in (THIRD, FOURTH)]
SIZE = 50
ONE_NUMBER = 1e-3  # relative spread below which a ratio counts as one number in all samples
_SHOWN = 0.05  # chance at or below which a correlation is shown
_CONSERVED = 0.01  # of the energy in play: a residual below it counts as none
_LOW_VARIABILITY = 0.1  # half of an interval over its median
_MATTER = {"friction": "friction", "density": "density", "youngs_modulus": "stiffness"}
_SOFT, _RIGID, _ELASTIC, _VISCOELASTIC = "ls-dem", "nscd-rigid", "nscd-elastic", "nscd-viscoelastic"


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
        f"The paper states no correlation; asked for here: {target}. The correlations of the samples miss it by "
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


def upward(content):
    """Thickness of LS-DEM's envelopes from block to block."""
    spreads = {}
    for name, case in content.cases.items():
        chosen = {"quantity": "history", "marker": list(markers_by_height(case).values())}
        spread = case.responses[_SOFT].sensitivity["spread"].sel(chosen).to_numpy()
        if np.isfinite(spread).all():
            spreads[name] = spread
    grows = sum((np.diff(spread) > 0.0).all() for spread in spreads.values())
    shown = "; ".join(f"{name} {', '.join(map(millimetres, spread))} mm" for name, spread in spreads.items())
    return grows == len(spreads), (
        f"Standard deviation from the lowest block up{_at_scale(content)}: {shown}. It grows from each block to the "
        f"next in {share_words(grows, len(spreads))} cases. There are no limits: "
        "the blocks of a structure move together in each sample."
    )


def thicker(model, pairs):
    """Judge of the thickness of a model's envelopes at the top: of each pair the second case has the larger one."""

    def judge(content):
        tops = {}
        for case in content.cases.values():
            at = case.differences.sel(model=model, marker=list(markers_by_height(case).values())[-1])
            limits = at["width_interval"].transpose("bound").to_numpy()
            if int(at["counted"]) >= SURE_FROM and np.isfinite(limits).all():
                tops[case.name] = (float(at["width"]), *limits)
        return _ordered(content, tops, pairs, "Mean difference of two samples at the top in mm", millimetres)

    return judge


def with_structure(content):
    """Thickness of the envelopes at the top with the number of blocks, by every kind of block."""
    blocks = {name: int((~load_structure(name).driven).sum()) for name in OF_THE_PAPER}
    pairs = [pair for pair in combinations(OF_THE_PAPER, 2) if blocks[pair[0]] < blocks[pair[1]]]
    return _worst({model: thicker(model, pairs)(content) for model in (_RIGID, _ELASTIC, _VISCOELASTIC)})


def parameters_matter(content):
    """Friction, density and stiffness behind the envelopes of LS-DEM."""
    shown, levels = {}, []
    for case in content.cases.values():
        result = case.responses[_SOFT].sensitivity.sel(marker=list(markers_by_height(case).values())[-1])
        for quantity, measure in (("history", "first_order"), ("peak", "rank_correlation")):
            at = result.sel(quantity=quantity)
            if is_known(at, measure):
                known = influences(at, measure)
                levels.append(known.chance)
                found = [one.parameter for one in known.beyond_chance if not one.control]
                shown.setdefault(case.name, {}).update(dict.fromkeys(found))
    if not levels:
        return None, "The samples are too few for a sensitivity."
    told = [f"{name}: {', '.join(map(parameter_label, names))}" for name, names in shown.items() if names]
    lacking = [
        words
        for key, words in _MATTER.items()
        if not any(key in one for names in shown.values() for one in names)
    ]
    words = f"Beyond chance at the top{_at_scale(content)}: {'; '.join(told) or 'no variable'}."
    if not lacking:
        return True, words
    return None, (
        f"{words} Not so: {', '.join(lacking)}. Chance alone makes a share or a correlation of {min(levels):.2f} to "
        f"{max(levels):.2f}; no evidence of a smaller influence is no evidence against it."
    )


def occurrences(content):
    """Share of the joints that open by LS-DEM, smallest in configuration 1."""
    pairs = [(FIRST, other) for other in (SECOND, THIRD, FOURTH)]
    return _joints_move(content, _SOFT, ["joint_uplift"], pairs, "whose middle opens")


def complicated(content):
    """Share of the joints that open or slip, larger in configurations 3 and 4, model by model."""
    moves, words = ["joint_uplift", "joint_slip"], "at whose middle the faces part or slip"
    models = content.study["models"]
    return _worst({one: _joints_move(content, one, moves, STACKS_AND_WALLS, words) for one in models})


def alike(content):
    """LS-DEM beside rigid and viscoelastic blocks in contact dynamics."""
    words, few, apart, beyond = [], [], 0, 0
    for case in content.cases.values():
        for other in (model for model in (_RIGID, _VISCOELASTIC) if model in content.study["models"]):
            both = [_SOFT, other]
            if int(case.differences["counted"].sel(model=both).min()) < SURE_FROM:
                few.append(f"{case.name}, {model_label(other)}")
                continue
            pair = case.differences.sel(model=_SOFT, other=other)
            distance, width = float(pair["distance"]), case.differences["width"].sel(model=both)
            widest = float(width.mean("marker").max())
            apart, beyond = apart + (distance > widest), beyond + (distance > float(pair["distance_chance"]))
            at = {
                "frame": "slab",
                "marker": next(iter(face_markers(case.structure).values())),
                "quantile": 0.5,
            }
            peaks = [number(1e3 * float(case.responses[model].envelope["peak"].sel(at))) for model in both]
            words.append(
                f"{case.name}, {model_label(other)} {number(1e3 * distance)} mm beside {number(1e3 * widest)} mm, "
                f"median peaks at the top {' and '.join(peaks)} mm"
            )
    if not words:
        return None, "The samples are too few to hold the models against each other."
    fewer = f" Of fewer than {SURE_FROM} samples, and not judged: {'; '.join(few)}." if few else ""
    return not apart, (
        "Energy distance of an ensemble of NSCD from that of LS-DEM, beside the mean difference of two samples of "
        f"the wider of both, means over times and the markers of all blocks: {'; '.join(words)}. Alike counts where "
        "the distance is the smaller one: two equal normal distributions may be about two standard deviations apart. "
        f"It is the larger one in {share_words(apart, len(words))} comparisons, and beyond that of samples "
        f"exchanged at random in {share_words(beyond, len(words))}.{fewer}"
    )


def _joints_move(content, model, names, pairs, words):
    """Share of the joints that move beyond the markers' noise: of each pair of cases the second has the larger one.

    A larger structure has more joints, so that their number would follow from the structure alone. A block that rocks
    moves the middle of its joint along the face too, so that slip alone would count it.
    """
    shares, joints = {}, []
    for name, case in content.cases.items():
        samples = counted_samples(case.responses[model].samples)
        joints.append(f"{samples.sizes['joint']} of {name}")
        if samples.sizes["sample"] >= SURE_FROM:
            moved = (samples[names].to_dataarray().max("variable") > case.marker_noise).mean("joint").values
            shares[name] = (sample_quantiles(moved, [0.5])[0], *quantile_interval(moved, [0.5])[:, 0])
    words = f"Share of the joints ({', '.join(joints)}) {words} by more than a marker's noise in %, median over the"
    return _ordered(content, shares, pairs, f"{words} samples", percent, ceiling=1.0)


def _ordered(content, found, pairs, words, written, ceiling=np.inf):
    """Whether of each pair of cases the second has the larger quantity: met beyond the limits in all, not met against
    them in one.

    ``found`` has value and limits of 95 % by case, without those of too few samples. A first case whose quantity is at
    the ceiling has no larger one: its pairs say nothing.
    """
    lacking = sorted({name for pair in pairs for name in pair} - set(found))
    pairs = [pair for pair in pairs if not set(pair) & set(lacking)]
    names = sorted({name for pair in pairs for name in pair})
    absent = f" Not in this study, or of too few samples: {', '.join(lacking)}." if lacking else ""
    if not pairs:
        return None, f"This study lacks the cases to compare.{absent}"
    if (
        len(
            {
                (content.cases[one].motion, *map(content.cases[one].settings.get, ("scale", "duration")))
                for one in names
            }
        )
        > 1
    ):
        return None, "The cases are shaken differently, which the structures cannot be told from."
    full = sorted({less for less, _ in pairs if found[less][0] >= ceiling})
    pairs = [pair for pair in pairs if pair[0] not in full]
    larger = sum(found[more][1] > found[less][2] for less, more in pairs)
    smaller = sum(found[more][2] < found[less][1] for less, more in pairs)
    told = ", ".join("{} {} [{}, {}]".format(name, *map(written, found[name])) for name in names)
    words = f"{words} at scale {given(content.cases[names[0]].settings['scale'])}, with 95 % limits: {told}. "
    if full:
        words += f"Nothing can be larger than that of {', '.join(full)}. "
    words += (
        f"Pairs of structures in the stated order beyond the limits, all of which met asks for: {larger} of "
        f"{len(pairs)}; in the opposite one, of which one is enough for not met: {smaller}.{absent}"
        if pairs
        else f"No pair of structures is left.{absent}"
    )
    if smaller:
        return False, words
    return (larger == len(pairs) and not (lacking or full)) or None, words


def _worst(findings):
    """Finding of several models: the worst verdict is that of all."""
    verdicts = [verdict for verdict, _ in findings.values()]
    words = [f"{model_label(model)}: {words}" for model, (_, words) in findings.items()]
    worst = next(one for one in (False, None, True) if one in verdicts)
    return worst, " ".join([*words, "The worst of the models counts."])


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


def _at_scale(content):
    scales = sorted({case.settings["scale"] for case in content.cases.values()})
    return f" at scale {' and '.join(map(given, scales))}"


_FIGURES = "Results, Figs. 11 to 14"
_CALIBRATION = "Model Calibration"
# by heading: place, claim in the words of this program, judge, and the models without which no study decides it
STATEMENTS = {
    "Solvers": (
        ("LS-DEM, Eq. (6)", "Forces and moments drive explicit steps of one length that is stable.",
         stable_step, _SOFT),
        ("LMGC90",
         "Unilateral contact, impacts and friction are solved by implicit steps, each iterated to convergence.",
         converged, _RIGID),
        ("LMGC90 and Comparison",
         "Rigid contacts need no damping to be stable, and energy can be conserved in discrete time.",
         conserves, _RIGID),
        ("Comparison", "A step of LMGC90 is long and takes much computing time.", dear_steps, _SOFT, _RIGID),
    ),
    "Samples": (
        (f"{_CALIBRATION}, Table 2, Fig. 8",
         "Nine log-normal variables with the means and variations of the table are sampled.", table_2),
        (_CALIBRATION, "A Latin hypercube with controlled correlation draws the samples.", correlation_control),
        (_CALIBRATION, "Each set has 50 samples.", size),
        ("Model Calibration and Conclusion", "Estimates from so few samples vary little.", low_variability),
    ),
    "Contact stiffness": (
        (_CALIBRATION, "The distributions of k_n and k_s need not follow those of E and G.", follow_moduli, _SOFT),
        (_CALIBRATION, "Heavier blocks need a larger stiffness.", heavier_blocks, _SOFT),
    ),
    "Results of LS-DEM": (
        (f"LS-DEM {_FIGURES}", "Envelopes grow thicker from block to block upward.", upward, _SOFT),
        (f"LS-DEM {_FIGURES}", "At the top, configurations 2 to 4 have thicker envelopes than configuration 1.",
         thicker(_SOFT, [(FIRST, other) for other in (SECOND, THIRD, FOURTH)]), _SOFT),
        (f"LS-DEM {_FIGURES}",
         "At the top, configuration 4 has a thicker envelope than configuration 3, perhaps by its beams.",
         thicker(_SOFT, [(THIRD, FOURTH)]), _SOFT),
        ("LS-DEM Results", "Configuration 1, the lowest, has the fewest occurrences of rocking and slide-rocking.",
         occurrences, _SOFT),
        ("LS-DEM Results", "Blocks that rock or slide can depend heavily on friction, density and stiffness.",
         parameters_matter, _SOFT),
    ),
    "Results of LMGC90": (
        (f"LMGC90 {_FIGURES}", "Runs by elastic blocks deviate more from each other in configurations 3 and 4.",
         thicker(_ELASTIC, STACKS_AND_WALLS), _ELASTIC),
        (f"LMGC90 {_FIGURES}", "With each kind of block, more complicated structures have thicker envelopes.",
         with_structure, _RIGID, _ELASTIC, _VISCOELASTIC),
    ),
    "Comparison and conclusion": (
        ("Conclusion", "The two models behave alike.", alike, _SOFT, _RIGID),
        ("LS-DEM Results and Conclusion", "There is more rocking or sliding in configurations 3 and 4.", complicated),
    ),
}  # fmt: skip


def judge_statements(content):
    """Rows of text under `HEADER` by heading, of a study of the paper's structures by its models of plain names."""
    models = {name: settings for name, settings in content.study["models"].items() if name in MODELS}
    content = replace(content, study={**content.study, "models": models})
    rows = {}
    for heading, statements in STATEMENTS.items():
        for place, claim, judge, *needed in statements:
            lacking = [model_label(model) for model in needed if model not in models]
            holds, words = (
                (None, f"This study has no {' and no '.join(lacking)}.") if lacking else judge(content)
            )
            verdict = VERDICTS[None if holds is None else bool(holds)]
            rows.setdefault(heading, []).append((place, claim, verdict, words))
    return rows


def count_words(rows_by_heading):
    """How many statements have which verdict, in a sentence."""
    verdicts = [row[2] for rows in rows_by_heading.values() for row in rows]
    counts = ", ".join(f"{verdicts.count(one)} {one}" for one in VERDICTS.values())
    return f"Of {len(verdicts)} statements: {counts}."
