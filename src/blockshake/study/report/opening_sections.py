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
    limited,
    millimetre_range,
    millimetres,
    model_label,
    number,
    percent,
)
from blockshake.pages.words import Words
from blockshake.statistics.intervals import samples_needed
from blockshake.study.ensembles.outcomes import count_outcomes, numerical_figure, unfinished
from blockshake.study.report.motion_figure import plot_motions, plot_spectra

_OPENING = Words(__name__)
_SHOWN = (0.5, 0.95)  # quantiles of peaks and rotations


def figures(content):
    """The figures behind the answer: probabilities and peaks with their limits, and the cases."""
    responses = [one for case in content.cases.values() for one in case.responses.values()]
    ended = count_outcomes(np.concatenate([one.samples["status"] for one in responses]))
    models = {model: one["time_step"] for model, one in content.study["models"].items()}
    runs = Text(_OPENING.runs(len(content.cases), models, sum(ended), ended))
    return Section(
        "Cases in figures", "figures", (runs, probability_table(content.stripes), *failures(content))
    )


def failures(content):
    """Samples that did not complete, with the reason, and the largest residual of the energy; a list of blocks."""
    rows, residual, capped = [], 0.0, 0.0
    for case in content.cases.values():
        for model, response in case.responses.items():
            samples = response.samples
            residual = np.fmax(residual, numerical_figure(samples, "energy_residual", np.max))
            capped = np.fmax(capped, numerical_figure(samples, "numerics_fraction_unconverged", np.max))
            rows += [
                (
                    case.name, model_label(model), str(int(one["sample"])), str(one["status"].values),
                    number(one["end_time"]), str(one["reason"].values),
                )
                for one in unfinished(samples)
            ]  # fmt: skip
    head = ("Case", "Model", "Sample", "Status", "End [s]", "Reason")
    table = Table(_OPENING.failures(), head, tuple(rows), "llrlrl")
    return [*([table] if rows else []), Text(_OPENING.numerics(100.0 * residual, 100.0 * capped))]


def probability_table(stripes):
    """Collapse, drift beyond the limit, peak and rotation of the top block of every leaf, with 95 % intervals."""
    rows = []
    for stripe in stripes:
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
        [one.envelope["largest_drift"] for stripe in stripes for one in stripe.responses.values()]
    )
    quantiles = [f"{100 * one:.0f} %" for one in _SHOWN]
    needed = ", ".join(
        f"{name} needs {samples_needed(one)}" for name, one in zip(quantiles, _SHOWN, strict=True)
    )
    head = ("Case, marker", "Model", "n", "Collapse [%]", "Drift [%]")
    head += tuple(
        f"{kind}, {one} [{unit}]"
        for kind, unit in (("Peak", "mm"), ("Rotation", "mrad"))
        for one in quantiles
    )
    # a quantile that no model has runs enough for is told by the caption alone
    shown = [column for column in range(len(head)) if any(row[column] != MISSING for row in rows)]
    head, *rows = (tuple(row[column] for column in shown) for row in (head, *rows))
    align = "ll" + "r" * (len(shown) - 2)
    return Table(_OPENING.probabilities(millimetre_range(limits), needed), head, tuple(rows), align)


def _bounded(top, name, show):
    return limited(top, name, show) if np.isfinite(top[f"{name}_interval"]).all() else MISSING


def _thousandths(value):
    return f"{1e3 * float(value):.1f}"


def structures(content):
    """Drawing and bodies of each structure."""
    blocks = [Text(_OPENING.sizes(any(case.is_shipped for case in content.cases.values())))]
    alike = {}
    for case in content.cases.values():
        alike.setdefault(case.settings["structure"], []).append(case)
    for case, *others in alike.values():
        names = ", ".join(one.name for one in (case, *others))
        blocks += [
            Heading(names, f"structure-{case.name}"),
            Figure(
                _OPENING.structure(names, case.structure.file.description, case.is_shipped),
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
    head = ("Body", "Size [m]", "Chamfer [m]", "Material", f"Density [kg/m{CUBED}]", "Mass [kg]")
    return Table(_OPENING.bodies(names), head, tuple(_merged(rows)), "lrrlrr")


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
    blocks = [
        Text(_OPENING.unscaled()),
        Items(
            tuple(
                _OPENING.motion(one.attrs["name"], provenance(one.attrs), one.attrs.get("records", 0))
                for one in used
            )
        ),
        Figure(_OPENING.histories(any(cut.values())), svg_of(plot_motions, used, cut)),
        Figure(_OPENING.spectra(any("target" in one for one in used)), svg_of(plot_spectra, used)),
        _motions_table(used),
    ]
    if any(case.base is not None for case in content.cases.values()):
        blocks.append(_bases_table(content))
    return Section("Ground motions", "motions", tuple(blocks))


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
    head = ("Motion", "Kind", *(label for label, _, _ in shown))
    return Table(_OPENING.intensities(), head, tuple(rows), "ll" + "r" * len(shown))


def _bases_table(content):
    """The slab's motion in the tests that the cases are compared with, against what was commanded."""
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
    bases = {case.name: case.base.attrs for case in content.cases.values() if case.base is not None}
    unread = {name: base for name, base in bases.items() if base.get("unread")}
    head = ("Case", "Test", "Driven by the motion", "Start [ms]", "Gain", "Departure [mm]", "Pitch [mrad]")
    return Table(_OPENING.bases(unread), (*head, "Error [mm]", "Error [mm/s]"), tuple(rows), "lllrrrrrr")
