"""Tables of the results: peaks, coverage, failures, energy, computation, cost."""

import numpy as np

from blockshake.pages.blocks import Table
from blockshake.pages.rows import face_markers
from blockshake.pages.wording import (
    MISSING,
    SHOWN_QUANTILES,
    millimetres,
    model_label,
    number,
    percent,
    quantile_range,
)
from blockshake.study.ensembles.coverage import relative_width
from blockshake.study.ensembles.outcomes import numerical_figure, unfinished
from blockshake.study.ensembles.timing import total_timing

_QUANTILES = " / ".join(f"{100 * one:.0f}" for one in SHOWN_QUANTILES) + " %"


def top_block_table(content):
    """Peak of the top block relative to the slab by every model beside the measured one."""
    compared = [case for case in content.cases.values() if case.measured is not None]
    rows = []
    for case in content.cases.values():
        body, marker = next(iter(face_markers(case.structure).items()))
        at = {"frame": "slab", "marker": marker}
        rows.append(
            (
                case.name,
                body,
                *([_measured(case, "peak", at)] if compared else []),
                *(_peaks(one.envelope, at) for one in case.responses.values()),
            )
        )
    models = content.study["models"]
    words = " or ".join(sorted({case.curve_word for case in compared}))
    header = (
        "Case", "Top block", *([f"{words[0].upper()}{words[1:]} [mm]"] if compared else []),
        *(f"{model_label(model)}, {_QUANTILES} [mm]" for model in models),
    )  # fmt: skip
    return Table(
        "Peak displacement of the top block along x relative to the slab: quantiles over the n samples that "
        "did not fail; one number where they print alike, with the reason.",
        header, tuple(rows), "ll" + "r" * (len(header) - 2),
    )  # fmt: skip


def _peaks(envelope, at):
    """Quantiles of a marker's peak with the number of samples; one number where they print alike, and why they do."""
    counted = int(envelope.attrs["counted"])
    shown = quantile_range(envelope["peak"].sel(**at), millimetres).split(" / ")
    if len(set(shown)) > 1:
        return f"{' / '.join(shown)} (n = {counted})"
    reason = "one sample" if counted == 1 else f"n = {counted}, alike to 0.1 mm"
    return f"{shown[0]} ({reason})" if counted else shown[0]


def coverage_table(case):
    """Coverage with its reference and the width of the band beside the measured peak."""
    rows = []
    for body, marker in face_markers(case.structure).items():
        for model, one in case.responses.items():
            if marker not in one.comparison["marker"].values:
                continue
            at = one.comparison.sel(marker=marker)
            if not np.isfinite(at["coverage"]):
                continue  # too few samples
            peak = case.measured["peak"].sel(frame="slab", marker=marker)
            rows.append((
                body, model_label(model), percent(at["coverage"]), quantile_range(at["reference"], percent),
                number(float(at["distance"]), 2), number(float(at["curve_probability"]), 2),
                millimetres(at["band_width"]), percent(relative_width(at, peak)),
            ))  # fmt: skip
    word = "virtual test" if case.synthetic else "measured curve"
    return Table(
        f"{case.name}: share of the time that the {word} lies within the bounds (inertial frame), beside the share of "
        "each sample in the bounds of the others (leave one out, read with the noise of the markers), quantiles "
        f"{_QUANTILES}; root mean square distance of the {word} from the samples, in standard deviations of noise and "
        "spread, and the chance of a distance as large for one more sample; mean width of the band, in mm and "
        f"relative to the peak of the {word} relative to the slab. Models with fewer than three samples are left out.",
        (
            "Block", "Model", f"Coverage of the {word} [%]", "Reference, leave one out [%]", "Distance", "Chance",
            "Band width [mm]", "Band width over peak [%]",
        ),
        tuple(rows), "llrrrrrr",
    )  # fmt: skip


def failures_table(content):
    """Samples that did not complete, with the reason."""
    rows = [
        (
            case.name, model_label(model), str(int(one["sample"])), str(one["status"].values),
            number(one["end_time"]), str(one["reason"].values),
        )
        for case in content.cases.values()
        for model, response in case.responses.items()
        for one in unfinished(response.samples)
    ]  # fmt: skip
    return Table(
        "Samples that did not complete. Samples that collapsed, or still fell when the window ended, count in the "
        "statistics up to their end; failed samples do not.",
        ("Case", "Model", "Sample", "Status", "End [s]", "Reason"), tuple(rows), "llrlrl",
    )  # fmt: skip


def energy_table(content):
    """Energy residual over the samples."""
    rows = []
    for case in content.cases.values():
        for model, response in case.responses.items():
            found = (
                number(numerical_figure(response.samples, "energy_residual", one))
                for one in (np.median, np.max)
            )
            rows.append((case.name, model_label(model), *found))
    return Table(
        "Energy residual over the samples [1].",
        ("Case", "Model", "Median", "Largest"), tuple(rows), "llrr",
    )  # fmt: skip


def computation_table(content, model):
    """Figures of a solver's computation; figures that none of its runs holds are left out."""
    by_case = {case.name: case.responses[model].samples for case in content.cases.values()}
    wanted = [entry for entry in _FIGURES if any(f"numerics_{entry[0]}" in one for one in by_case.values())]
    rows = []
    for case, samples in by_case.items():
        cells = (
            number(factor * numerical_figure(samples, f"numerics_{name}", statistic))
            for name, _, factor, statistic in wanted
        )
        rows.append((case, *cells))
    return Table(
        f"{model_label(model)}: figures of the computation over the samples of a case.",
        ("Case", *(label for _, label, _, _ in wanted)), tuple(rows), "l" + "r" * len(wanted),
    )  # fmt: skip


# of any solver; each writes those that it has
_FIGURES = (
    ("steps", "Steps of a run", 1.0, np.max),
    ("mean_iterations", "Iterations a step, median of the runs' means", 1.0, np.median),
    ("max_iterations", "Most iterations", 1.0, np.max),
    ("capped_steps", "Most capped steps of a run", 1.0, np.max),
    ("max_residual", "Largest relative residual", 1.0, np.max),
    ("fraction_above_1e-4", "Largest share of steps above 1e-4 [%]", 100.0, np.max),
    ("max_penetration", "Deepest penetration [mm]", 1e3, np.max),
    ("energy_lost_to_scheme", "Most energy lost to the scheme [J]", 1.0, np.max),
    ("settling_steps", "Most settling steps before a run", 1.0, np.max),
    ("list_searches", "Most searches for near pairs", 1.0, np.max),
)


def timings_table(content):
    """CPU time of the simulations."""
    rows = [_timing(one.case, model_label(one.model), one) for one in content.timings]
    rows.append((*_timing("all", "", total_timing(content.timings))[:-1], ""))
    return Table(
        "Cost of the simulations on one core each, from the jobs' logs.",
        (
            "Case", "Model", "Jobs", "Samples", "Simulated [s]", "CPU [s]", "Wall [s]",
            "CPU per simulated second [1]",
        ),
        tuple(rows), "llrrrrrr",
    )  # fmt: skip


def _timing(case, model, cost):
    return (
        case, model, str(cost.jobs), str(cost.samples),
        *(number(one) for one in (cost.simulated, cost.cpu_time, cost.wall_time, cost.cpu_per_simulated)),
    )  # fmt: skip


def _measured(case, variable, at):
    if case.measured is None or at["marker"] not in case.measured["marker"].values:
        return MISSING
    return millimetres(case.measured[variable].sel(**at))
