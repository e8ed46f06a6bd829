"""Tables of the inputs: cases, bodies, motions."""

from blockshake.pages.blocks import Table
from blockshake.pages.wording import (
    CUBED,
    SQUARED,
    given,
    millimetres,
    model_label,
    number,
)
from blockshake.study.ensembles.outcomes import count_outcomes


def cases_table(content):
    """Simulated cases: structure, motion, scale, peak acceleration, window, samples by model and their ends."""
    rows = []
    for case in content.cases.values():
        for model, response in case.responses.items():
            rows.append((
                case.name, case.motion, given(case.settings["scale"]), number(content.peak_acceleration(case)),
                given(case.settings["duration"]), model_label(model),
                given(content.study["models"][model]["time_step"]), str(response.samples.sizes["sample"]),
                " / ".join(map(str, count_outcomes(response.samples["status"]))),
            ))  # fmt: skip
    header = (
        "Case", "Motion", "Scale", f"Peak acceleration [m/s{SQUARED}]", "Window [s]", "Model", "Time step [s]",
        "Samples", "completed / collapsed / still falling / failed",
    )  # fmt: skip
    shared = [
        f"{model_label(model)}: {', '.join(f'{name} {given(value)}' for name, value in settings['parameters'].items())}"
        for model, settings in content.study["models"].items()
        if settings.get("parameters")
    ]
    return Table(
        "Cases and models. The peak acceleration is the scaled motion's; the window is counted from its start."
        + (f" In all samples of {'; '.join(shared)}." if shared else ""),
        header, tuple(rows), "llrrrlrrr",
    )  # fmt: skip


def bodies_table(structure, names):
    """Bodies of a structure with size, material and mass; ``names``: of its cases."""
    rows = []
    for body, mass in zip(structure.file.bodies, structure.mass, strict=True):
        shape = structure.file.shapes[body.shape]
        size = " x ".join(f"{edge:g}" for edge in shape.box) if shape.box else f"mesh {shape.mesh}"
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


def motions_table(motions):
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
        for motion in motions.values()
    ]
    return Table(
        "Motions at 100 %: peak ground acceleration, velocity and displacement along x, Arias intensity and "
        "durations.",
        ("Motion", "Kind", *(label for label, _, _ in shown)), tuple(rows), "ll" + "r" * len(shown),
    )  # fmt: skip


def bases_table(content):
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
