"""Tables of what came out: peaks, coverage, failures, energy, convergence, cost."""

import numpy as np

from blockshake.report.blocks import Table
from blockshake.report.rows import face_markers
from blockshake.report.wording import (
    SHOWN_QUANTILES,
    millimetres,
    model_label,
    number,
    percent,
    quantile_range,
)

_QUANTILES = " / ".join(f"{100 * one:.0f}" for one in SHOWN_QUANTILES) + " %"


def measured_word(synthetic):
    """What the measured curve is called in a header."""
    return "Virtual test (synthetic)" if synthetic else "Measured"


def top_block_table(content):
    """Peak of the top block relative to the slab by both models beside the measured one."""
    rows = []
    for case in content.cases.values():
        body, marker = next(iter(face_markers(case.structure).items()))
        at = {"frame": "slab", "marker": marker}
        rows.append(
            (
                case.name,
                body,
                _measured(case, "peak", at),
                *(
                    f"{quantile_range(one.envelope['peak'].sel(**at), millimetres)} "
                    f"(n = {int(one.envelope.attrs['counted'])})"
                    for one in case.responses.values()
                ),
            )
        )
    models = content.study["models"]
    header = (
        "Case", "Top block", f"{measured_word(_any_synthetic(content))} [mm]",
        *(f"{model_label(model)}, {_QUANTILES} [mm]" for model in models),
    )  # fmt: skip
    return Table(
        "Peak displacement of the top block along x relative to the slab: quantiles over the n samples that "
        "completed or collapsed.",
        header, tuple(rows), "llr" + "r" * len(models),
    )  # fmt: skip


def peaks_table(case):
    """Peak and residual displacement relative to the slab of every block."""
    rows = []
    for body, marker in face_markers(case.structure).items():
        at = {"frame": "slab", "marker": marker}
        cells = []
        for variable in ("peak", "residual"):
            cells.append(_measured(case, variable, at))
            cells += [
                quantile_range(one.envelope[variable].sel(**at), millimetres)
                for one in case.responses.values()
            ]
        rows.append((body, *cells))
    word = "virtual test (synthetic)" if case.synthetic else "measured"
    header = ["Block"]
    for variable in ("Peak", "Residual"):
        header += [f"{variable}, {word}", *(f"{variable}, {model_label(one)}" for one in case.responses)]
    return Table(
        f"{case.name}: peak and residual displacement along x relative to the slab [mm]; for the models quantiles "
        f"{_QUANTILES} over the samples. The residual is the mean over the last half second of the window.",
        tuple(header), tuple(rows), "l" + "r" * (len(header) - 1),
    )  # fmt: skip


def coverage_table(case):
    """Coverage with its reference and the width of the band beside the measured peak."""
    rows = []
    for body, marker in face_markers(case.structure).items():
        for model, one in case.responses.items():
            if marker not in one.comparison["marker"].values:
                continue
            at = one.comparison.sel(marker=marker)
            peak = case.measured["peak"].sel(frame="slab", marker=marker)
            rows.append(
                (
                    body,
                    model_label(model),
                    percent(at["coverage"]),
                    quantile_range(at["reference"], percent),
                    number(float(at["curve_probability"]), 2),
                    millimetres(at["band_width"]),
                    percent(at["band_width"] / peak),
                )
            )
    word = "virtual test" if case.synthetic else "measured curve"
    return Table(
        f"{case.name}: share of the time that the {word} lies within the bounds (inertial frame), beside the same "
        "for each sample in the bounds of the others (leave one out, read with the markers' noise), quantiles "
        f"{_QUANTILES}, and the chance of a coverage as low for one more sample; mean width of the band, in mm and "
        f"relative to the {word}'s peak relative to the slab.",
        (
            "Block", "Model", f"Coverage of the {word} [%]", "Reference, leave one out [%]", "Chance",
            "Band width [mm]", "Band width over peak [%]",
        ),
        tuple(rows), "llrrrrr",
    )  # fmt: skip


def failures_table(content):
    """Samples that did not complete, with the reason."""
    rows = []
    for case in content.cases.values():
        for model, response in case.responses.items():
            for sample in response.samples["sample"].values:
                one = response.samples.sel(sample=sample)
                if str(one["status"].values) != "completed":
                    rows.append(
                        (
                            case.name,
                            model_label(model),
                            str(int(sample)),
                            str(one["status"].values),
                            number(one["end_time"]),
                            str(one["reason"].values),
                        )
                    )
    return Table(
        "Samples that did not complete. Collapsed ones count in the statistics up to their end, failed ones not.",
        ("Case", "Model", "Sample", "Status", "End [s]", "Reason"), tuple(rows), "llrlrl",
    )  # fmt: skip


def energy_table(content):
    """Energy residual over the samples."""
    rows = []
    for case in content.cases.values():
        for model, response in case.responses.items():
            values = response.samples["energy_residual"].values
            rows.append(
                (case.name, model_label(model), number(np.nanmedian(values)), number(np.nanmax(values)))
            )
    return Table(
        "Energy residual over the samples [1].",
        ("Case", "Model", "Median", "Largest"), tuple(rows), "llrr",
    )  # fmt: skip


def convergence_table(content, model):
    """What a solver says of its own work; figures that none of its runs holds are left out."""
    by_case = {case.name: case.responses[model].samples for case in content.cases.values()}
    wanted = [
        entry for entry in _NUMERICS[model] if any(f"numerics_{entry[0]}" in one for one in by_case.values())
    ]
    rows = []
    for case, samples in by_case.items():
        cells = []
        for name, _, factor, statistic in wanted:
            values = np.asarray(samples.get(f"numerics_{name}", []), dtype=float)
            values = values[np.isfinite(values)]
            cells.append(number(factor * statistic(values) if len(values) else np.nan))
        rows.append((case, *cells))
    return Table(
        f"{model_label(model)}: figures of the computation over the samples of a case.",
        ("Case", *(label for _, label, _, _ in wanted)), tuple(rows), "l" + "r" * len(wanted),
    )  # fmt: skip


_NUMERICS = {
    "nscd-rigid": (
        ("steps", "Steps of a run", 1.0, np.max),
        ("mean_iterations", "Iterations a step, median of the runs' means", 1.0, np.median),
        ("max_iterations", "Most iterations", 1.0, np.max),
        ("capped_steps", "Most capped steps of a run", 1.0, np.max),
        ("max_residual", "Largest relative residual", 1.0, np.max),
        ("fraction_above_1e-4", "Largest share of steps above 1e-4 [%]", 100.0, np.max),
        ("max_penetration", "Deepest penetration [mm]", 1e3, np.max),
    ),
    "ls-dem": (
        ("steps", "Steps of a run", 1.0, np.max),
        ("settling_steps", "Most settling steps before a run", 1.0, np.max),
        ("list_searches", "Most searches for near pairs", 1.0, np.max),
    ),
}  # fmt: skip


def timings_table(content):
    """CPU time of the simulations."""
    rows = [
        (
            one.case, model_label(one.model), str(one.jobs), str(one.samples), number(one.simulated),
            number(one.cpu_time), number(one.wall_time),
            number(one.cpu_time / one.simulated if one.simulated > 0.0 else np.nan),
        )
        for one in content.timings
    ]  # fmt: skip
    known = [one for one in content.timings if np.isfinite(one.cpu_time)]
    rows.append(
        (
            "all",
            "",
            str(sum(one.jobs for one in known)),
            str(sum(one.samples for one in known)),
            number(sum(one.simulated for one in known)),
            number(sum(one.cpu_time for one in known)),
            number(sum(one.wall_time for one in known)),
            "",
        )
    )
    return Table(
        "Cost of the simulations on one core each, from the jobs' benchmark files.",
        (
            "Case", "Model", "Jobs", "Samples", "Simulated [s]", "CPU [s]", "Wall [s]",
            "CPU per simulated second [1]",
        ),
        tuple(rows), "llrrrrrr",
    )  # fmt: skip


def pairs_table(caption, header, mapping):
    """Two columns from a mapping of text to text."""
    return Table(caption, header, tuple((str(key), str(value)) for key, value in mapping.items()), "ll")


def _measured(case, variable, at):
    if at["marker"] not in case.measured["marker"].values:
        return "none"
    return millimetres(case.measured[variable].sel(**at))


def _any_synthetic(content):
    return any(case.synthetic for case in content.cases.values())
