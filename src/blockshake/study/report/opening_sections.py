"""Sections on the cases in figures, and on the inputs: structures, motions."""

from itertools import product

import numpy as np

from blockshake.dynamics.load_motion import provenance
from blockshake.pages.blocks import PAGE_WIDTH, Figure, Heading, Items, Section, Table, Text
from blockshake.pages.drawing import svg_of
from blockshake.pages.rows import top_markers
from blockshake.pages.scene.structure_picture import plot_understood
from blockshake.pages.wording import (
    CUBED,
    MISSING,
    SQUARED,
    count_words,
    given,
    limited,
    millimetre_range,
    millimetres,
    model_label,
    number,
    percent,
)
from blockshake.statistics.intervals import CONFIDENCE, samples_needed
from blockshake.study.ensembles.outcomes import count_outcomes, numerical_figure, unfinished
from blockshake.study.report.motion_figure import plot_motions, plot_spectra

_SHOWN = (0.5, 0.95)  # quantiles of peaks and rotations


def figures(content):
    """The figures behind the answer: probabilities and peaks with their limits, and the cases."""
    responses = [one for case in content.cases.values() for one in case.responses.values()]
    ended = count_outcomes(np.concatenate([one.samples["status"] for one in responses]))
    models = [
        f"{model_label(model)} in steps of {given(one['time_step'])} s"
        for model, one in content.study["models"].items()
    ]
    runs = (
        f"{count_words(len(content.cases), 'case')} by {'; '.join(models)}; {sum(ended)} runs: {ended.completed} "
        f"completed, {ended.collapsed} collapsed, {ended.falling} still falling when the window ended, {ended.failed} "
        "failed."
    )
    blocks = (Text(runs), probability_table(content), *failures(content))
    return Section("Cases in figures", "figures", blocks)


def failures(content):
    """Samples that did not complete, with the reason, and the largest residual of the energy; a list of blocks."""
    rows, residual, capped = [], 0.0, 0.0
    for case in content.cases.values():
        for model, response in case.responses.items():
            samples = response.samples
            residual = np.fmax(residual, numerical_figure(samples, "energy_residual", np.max))
            capped = np.fmax(capped, numerical_figure(samples, "numerics_fraction_above_1e-4", np.max))
            rows += [
                (
                    case.name, model_label(model), str(int(one["sample"])), str(one["status"].values),
                    number(one["end_time"]), str(one["reason"].values),
                )
                for one in unfinished(samples)
            ]  # fmt: skip
    words = (
        f"Numerics: the largest share of energy that a run does not explain is {number(100.0 * residual, 2)} %"
        + (
            f", the largest share of steps above a residual of 1e-4 {number(100.0 * capped, 2)} %."
            if capped
            else "."
        )
    )
    table = Table(
        "Samples that did not complete, or with a remark. Samples that collapsed, or still fell when the window "
        "ended, count in the statistics up to their end; failed samples do not.",
        ("Case", "Model", "Sample", "Status", "End [s]", "Reason"), tuple(rows), "llrlrl",
    )  # fmt: skip
    return [*([table] if rows else []), Text(words)]


def probability_table(content):
    """Collapse, drift beyond the limit, peak and rotation of the top block of every leaf, with 95 % intervals."""
    needed = ", ".join(f"{100 * one:.0f} % needs {samples_needed(one)}" for one in _SHOWN)
    rows = []
    for stripe in content.stripes:
        for (body, marker), (model, response) in product(
            top_markers(stripe.case.structure).items(), stripe.responses.items()
        ):
            one = response.envelope
            counted, failed = one.attrs["counted"], one.attrs["samples"] - one.attrs["counted"]
            top = one.sel(marker=marker, body=body)
            rows.append((
                f"{stripe.name}, {marker}", model_label(model),
                f"{counted} + {failed} failed" if failed else str(counted),
                _bounded(top, "collapse_probability", percent), _bounded(top, "drift_probability", percent),
                *(_bounded(top.sel(frame="slab", quantile=q), "peak", _thousandths) for q in _SHOWN),
                *(_bounded(top.sel(quantile=q), "peak_rotation", _thousandths) for q in _SHOWN),
            ))  # fmt: skip
    limits = np.hstack(
        [one.envelope["largest_drift"] for case in content.stripes for one in case.responses.values()]
    )
    shown = " and ".join(f"{100 * one:.0f} %" for one in _SHOWN)
    quantiles = [f"{100 * one:.0f} %" for one in _SHOWN]
    return Table(
        "Top block of every leaf, at its marker: probability of collapse, and of a displacement relative to the slab "
        f"of more than the limit of its block, {millimetre_range(limits)} mm, with Clopper-Pearson limits; quantiles "
        f"{shown} of peak displacement [mm] and peak rotation [mrad] over the n samples that did not fail, with "
        f"limits by order statistics. {MISSING.capitalize()}: of a quantile for which n is too small to bear limits "
        f"({needed}). All limits are of {100 * CONFIDENCE:.0f} % and take samples as independent. A sample that "
        "collapsed, or still fell when the window ended, counts as a collapse and as more than that drift, and with "
        "the peak that it had reached. One that failed counts in none of these; the limits of probabilities hold "
        "that all of these fell and "
        "that none did.",
        (
            "Case, marker", "Model", "n", "Collapse [%]", "Drift [%]", *(f"Peak, {one} [mm]" for one in quantiles),
            *(f"Rotation, {one} [mrad]" for one in quantiles),
        ),
        tuple(rows), "llrrrrrrr",
    )  # fmt: skip


def _bounded(top, name, show):
    return limited(top, name, show) if np.isfinite(top[f"{name}_interval"]).all() else MISSING


def _thousandths(value):
    return f"{1e3 * float(value):.1f}"


def structures(content):
    """Drawing and bodies of each structure."""
    blocks = [
        Text(
            "Configurations 1 to 4: block heights and the 2 cm chamfer are those of Zhou et al. (2023). The paper does "
            "not state, and the structure files infer, the block's length of 2.4 m and its orientation, the size of "
            "the slab, the gap between the walls, section, length and places of the steel beams, and the places of "
            "markers and accelerometers."
        )
        if any(case.is_shipped for case in content.cases.values())
        else Text("Sizes are those of the structure files.")
    ]
    alike = {}
    for case in content.cases.values():
        alike.setdefault(case.settings["structure"], []).append(case)
    for case, *others in alike.values():
        names = ", ".join(one.name for one in (case, *others))
        blocks += [
            Heading(names, f"structure-{case.name}"),
            Figure(
                f"{names}: {case.structure.file.description}"
                + (", some sizes inferred (see above)" if case.is_shipped else "")
                + ". The table shakes along x. Joints are pairs of bodies nearer than 0.1 mm. Sensors on hidden faces "
                "are drawn too.",
                svg_of(plot_understood, case.structure, PAGE_WIDTH),
            ),
            _bodies_table(case.structure, names),
        ]
    return Section("Structures", "structures", tuple(blocks))


def _size_words(shape):
    if shape.box:
        return " x ".join(f"{edge:g}" for edge in shape.box)
    if shape.cylinder:
        return f"cylinder {shape.cylinder.diameter:g} x {shape.cylinder.height:g}"
    return f"mesh {shape.mesh}"


def _bodies_table(structure, names):
    """Bodies of a structure with size, material and mass; ``names``: of its cases."""
    rows = []
    for body, mass in zip(structure.file.bodies, structure.mass, strict=True):
        shape = structure.file.shapes[body.shape]
        size = _size_words(shape)
        rows.append((
            body.name + (" (driven)" if body.driven else ""), size, f"{shape.chamfer:g}", body.material,
            f"{body.density or structure.file.materials[body.material].density:g}", f"{mass:.0f}",
        ))  # fmt: skip
    return Table(
        f"Bodies of {names}; sizes along x, y, z; masses of the chamfered shapes at nominal density.",
        ("Body", "Size [m]", "Chamfer [m]", "Material", f"Density [kg/m{CUBED}]", "Mass [kg]"),
        tuple(_merged(rows)), "lrrlrr",
    )  # fmt: skip


def _merged(rows):
    """Rows that differ in the body's name only become one."""
    merged = {}
    for name, *rest in rows:
        merged.setdefault(tuple(rest), []).append(name)
    return [(", ".join(names), *rest) for rest, names in merged.items()]


def motions(content):
    """Histories, spectra and figures of the motions that shake the cases."""
    windows = {}
    for case in content.cases.values():
        windows.setdefault(case.motion, set()).add(case.settings["duration"])
    used = [content.motions[name] for name in windows]
    cut = {
        one.attrs["name"]: sorted(end for end in ends if end < float(one["time"][-1]))
        for one, ends in zip(used, windows.values(), strict=True)
    }
    targets = any("target" in one for one in used)
    blocks = [
        Text("Motions at 100 %; the cases multiply them by their scale."),
        Items(tuple(f"{one.attrs['name']}: {provenance(one.attrs)}{_of_set(one)}." for one in used)),
        Figure(
            "Ground acceleration, velocity and displacement along x"
            + ("; dashed: end of the window that the cases simulate." if any(cut.values()) else "."),
            svg_of(plot_motions, used, cut),
        ),
        Figure(
            "Response spectra at 5 % damping"
            + (", with the ordinates that a synthetic motion aims at." if targets else "."),
            svg_of(plot_spectra, used),
        ),
        _motions_table(used),
    ]
    if any(case.base is not None for case in content.cases.values()):
        blocks.append(_bases_table(content))
    return Section("Ground motions", "motions", tuple(blocks))


def _of_set(motion):
    """Of how many records a motion is the one that is shown."""
    count = motion.attrs.get("records")
    return (
        f"; shown of {count_words(count, 'record')} as that of the median peak acceleration" if count else ""
    )


def _motions_table(motions):
    """Peaks, intensity and durations of the motions at 100 %."""
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
        for motion in motions
    ]
    return Table(
        "Motions at 100 %: peak ground acceleration, velocity and displacement along x, Arias intensity and "
        "durations.",
        ("Motion", "Kind", *(label for label, _, _ in shown)), tuple(rows), "ll" + "r" * len(shown),
    )  # fmt: skip


def _bases_table(content):
    """The slab's motion in the tests that the cases are compared with, beside what was commanded."""
    rows = []
    for case in content.cases.values():
        base = case.base
        if base is None:
            continue
        moved = base.sel(channel="pitch_y")["displacement"]
        errors = [
            float(base.sel(channel="x")[f"{name}_error"].median()) for name in ("displacement", "velocity")
        ]
        rows.append((
            case.name, base.attrs["test"], case.settings["input"], number(1e3 * base.attrs["start"]),
            number(base.attrs["gain"], 4), millimetres(base.attrs["departure"]),
            number(1e3 * float(abs(moved).max())), number(1e3 * errors[0]), number(1e3 * errors[1]),
        ))  # fmt: skip
    return Table(
        "Motion of the slab in the tests, as its sensors read it: when the command starts on the clock of the test, "
        "displacement along x over the command and root mean square of what departs from the command, largest pitch, "
        "and standard deviations of the smoothed displacement and velocity along x (medians over the record)."
        + _unread_words(content),
        (
            "Case", "Test", "The models are driven by the motion", "Start [ms]", "Gain", "Departure [mm]",
            "Pitch [mrad]", "Error [mm]", "Error [mm/s]",
        ),
        tuple(rows), "lllrrrrrr",
    )  # fmt: skip


def _unread_words(content):
    """A sentence for each case whose slab was not measured along every axis."""
    bases = {case.name: case.base.attrs for case in content.cases.values() if case.base is not None}
    return "".join(
        f" {name}: no marker measures the slab along {' and '.join(base['unread'])}, where it "
        + ("moves as commanded." if base["follows"] else "is taken to be at rest.")
        for name, base in bases.items()
        if base.get("unread")
    )
