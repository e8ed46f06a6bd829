"""Tables of the report: rows of text from Datasets."""

import numpy as np

from blockshake.report.blocks import Table
from blockshake.report.rows import face_markers
from blockshake.report.wording import (
    CUBED,
    SHOWN_QUANTILES,
    SQUARED,
    given,
    millimetres,
    model_label,
    number,
    parameter_label,
    percent,
    printed_unit,
    quantile_range,
)
from blockshake.study.distributions import parameter_unit

_QUANTILES = " / ".join(f"{100 * one:.0f}" for one in SHOWN_QUANTILES) + " %"


def measured_word(synthetic):
    """What the measured curve is called in a header."""
    return "Virtual test (synthetic)" if synthetic else "Measured"


def outcome_counts(samples):
    """How many samples completed, collapsed and failed otherwise."""
    status = samples["status"].values.astype(str)
    completed, collapsed = (int((status == one).sum()) for one in ("completed", "collapsed"))
    return completed, collapsed, len(status) - completed - collapsed


def cases_table(content):
    """What was simulated: structure, motion, scale, peak acceleration, window, samples by model and their ends."""
    rows = []
    for case in content.cases.values():
        peak = content.motions[case.motion].attrs["peak_acceleration"]
        for model, response in case.responses.items():
            completed, collapsed, failed = outcome_counts(response.samples)
            rows.append(
                (
                    case.name,
                    case.motion,
                    given(case.settings["scale"]),
                    number(case.settings["scale"] * peak),
                    given(case.settings["duration"]),
                    model_label(model),
                    given(content.study["models"][model]["time_step"]),
                    str(response.samples.sizes["sample"]),
                    f"{completed} / {collapsed} / {failed}",
                )
            )
    header = (
        "Case", "Motion", "Scale", f"Peak acceleration [m/s{SQUARED}]", "Window [s]", "Model", "Time step [s]",
        "Samples", "completed / collapsed / failed",
    )  # fmt: skip
    return Table(
        "Cases and models. The peak acceleration is the scaled motion's; the window is counted from its start.",
        header, tuple(rows), "llrrrlrrr",
    )  # fmt: skip


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


def bodies_table(case):
    """Bodies of a structure with size, material and mass."""
    rows = []
    for body, mass in zip(case.structure.file.bodies, case.structure.mass, strict=True):
        shape = case.structure.file.shapes[body.shape]
        size = " x ".join(f"{edge:g}" for edge in shape.box) if shape.box else f"mesh {shape.mesh}"
        rows.append(
            (
                body.name + (" (driven)" if body.driven else ""),
                size,
                f"{shape.chamfer:g}",
                body.material,
                f"{body.density or case.structure.file.materials[body.material].density:g}",
                f"{mass:.0f}",
            )
        )
    return Table(
        f"Bodies of {case.name}; sizes along x, y, z; masses of the chamfered shapes at nominal density.",
        ("Body", "Size [m]", "Chamfer [m]", "Material", f"Density [kg/m{CUBED}]", "Mass [kg]"),
        tuple(_merged(rows)), "lrrlrr",
    )  # fmt: skip


def _merged(rows):
    """Rows that differ in the body's name only become one."""
    merged = {}
    for name, *rest in rows:
        merged.setdefault(tuple(rest), []).append(name)
    return [(", ".join(names), *rest) for rest, names in merged.items()]


def motions_table(motions):
    """Figures of the motions at 100 %."""
    shown = (
        (f"PGA [m/s{SQUARED}]", "peak_acceleration", 1.0),
        ("PGV [m/s]", "peak_velocity", 1.0),
        ("PGD [mm]", "peak_displacement", 1e3),
        ("Arias intensity [m/s]", "arias_intensity", 1.0),
        ("Significant duration, 5 to 95 % [s]", "significant_duration", 1.0),
        ("Record [s]", "duration", 1.0),
    )
    rows = [
        (
            motion.attrs["name"],
            "synthetic" if motion.attrs.get("synthetic") else motion.attrs.get("format", ""),
            *(number(factor * motion.attrs[key]) for _, key, factor in shown),
        )
        for motion in motions.values()
    ]
    return Table(
        "Motions at 100 %: peak ground acceleration, velocity and displacement along x, Arias intensity and "
        "durations.",
        ("Motion", "Kind", *(label for label, _, _ in shown)), tuple(rows), "ll" + "r" * len(shown),
    )  # fmt: skip


def samples_table(content):
    """Mean and coefficient of variation asked for and reached."""
    rows = []
    for name, target in content.distributions.items():
        factor, unit = printed_unit(parameter_unit(name))
        rows.append(
            (
                parameter_label(name),
                unit,
                number(target.mean / factor, 4),
                number(content.design_summary["mean"][name] / factor, 4),
                percent(target.cov),
                percent(content.design_summary["cov"][name]),
                ", ".join(_users(content, name)) or "no case",
            )
        )
    return Table(
        "Random variables, all log-normal: mean and coefficient of variation (COV) of the target and of the "
        "samples, and the cases whose structure has the material or the pair.",
        ("Variable", "Unit", "Mean, target", "Mean, samples", "COV, target [%]", "COV, samples [%]", "Cases"),
        tuple(rows), "llrrrrl",
    )  # fmt: skip


def _users(content, name):
    """Short names of the cases whose structure holds what a variable describes."""
    kind, *rest = name.split(".")
    wanted = set(rest) if kind == "friction" else {rest[0]}
    return [
        case.name.removeprefix("configuration-")
        for case in content.cases.values()
        if wanted <= set(case.structure.file.materials)
    ]


def waves_table(waves):
    """Wave speed reached against its target at nominal parameters."""
    rows = []
    for direction in waves["direction"].values:
        one = waves.sel(direction=direction)
        factor, unit = printed_unit("N/m3")
        reached, target = float(one["wave_speed"]), float(one["target_wave_speed"])
        rows.append(
            (
                str(direction),
                number(target, 5),
                number(reached, 5),
                f"{1e6 * (reached / target - 1.0):.0f}",
                f"{number(float(one['stiffness']) / factor, 4)} {unit}",
            )
        )
    return Table(
        "Effective wave speed at the calibrated stiffness, nominal parameters.",
        ("Direction", "Target [m/s]", "Reached [m/s]", "Difference [ppm]", "Stiffness"), tuple(rows), "lrrrr",
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
                    millimetres(at["band_width"]),
                    percent(at["band_width"] / peak),
                )
            )
    word = "virtual test" if case.synthetic else "measured curve"
    return Table(
        f"{case.name}: share of the time that the {word} lies within the bounds (inertial frame), beside the same "
        "for each sample in the bounds of the others (leave one out, read with the markers' noise), quantiles "
        f"{_QUANTILES}; mean width of the band, in mm and relative to the {word}'s peak relative to the slab.",
        (
            "Block", "Model", f"Coverage of the {word} [%]", "Reference, leave one out [%]", "Band width [mm]",
            "Band width over peak [%]",
        ),
        tuple(rows), "llrrrr",
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
        ("time_step", "Time step [s]", 1.0, np.max),
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
