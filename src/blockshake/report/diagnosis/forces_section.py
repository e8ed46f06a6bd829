"""Joint forces of a diagnosis: forces that the joints transmitted, broken laws, and a force from outside in words."""

import numpy as np

from blockshake.diagnosis.laws.law_table import law_of
from blockshake.report.diagnosis.figures.forces import plot_laws, plot_levers, plot_unexplained, plot_work
from blockshake.report.document.blocks import Figure, Section, Table, Text
from blockshake.report.document.drawing import svg_of
from blockshake.report.document.wording import number

FORCE_LAWS = {
    "steady": "steady throughout",
    "constant": "constant from an instant on",
    "pulse": "a pulse",
    "spring": "a spring beyond a gap",
    "damper": "in proportion to the block's velocity",
    "proportional": "in proportion to the block's displacement",
}
_MOST_LAWS = 12  # rows of the table


def forces_section(found):
    """Levers, unexplained force and broken laws."""
    if not found.forces.sizes:
        return Section("Joint forces", "forces", (Text("The sensors of these tests give no joint forces."),))
    blocks = [Text(_summary(found))]
    joints = [str(name) for name in found.forces["joint"].values]
    if joints:
        blocks.append(
            Figure(
                f"Lever of joint {joints[0]}: where the resultant of all forces crosses its face, from the readings "
                "alone by the equations of Newton and Euler. Dashed: the edges of the face. Red: beyond an edge by "
                "more than three standard deviations, which a dry joint cannot carry.",
                svg_of(plot_levers, found.forces, joints[0]),
            )
        )
        blocks.append(
            Figure(
                "Laws of the joints, a point an instant away from impacts. Left: the lever of a turned joint by its "
                f"rotation; a sharp edge has one lever (dashed, of {joints[0]}), a worn one rolls outwards. Middle: "
                "the ratio of shear to normal force of a slipping joint by its slip rate; Coulomb's is the structure's "
                f"coefficient (dashed, of {joints[0]}). Right: the rotation of a closed joint by its moment; its slope "
                "is the joint's compliance.",
                svg_of(plot_laws, found.forces),
            )
        )
        blocks.append(_work(found))
    blocks.append(
        Figure(
            "Least unexplained force along x: the smallest forces on the blocks that one would have to invent so that "
            "the joints carry no tension and no more than Coulomb's friction. How a force is shared among the blocks "
            "is not told by one turned joint.",
            svg_of(plot_unexplained, found.forces),
        )
    )
    if found.decision.laws:
        blocks.append(_table(found))
    return Section("Joint forces", "forces", tuple(blocks))


def _work(found):
    """Energy that the joints take, beside that of the nominal draws where there are some."""
    shown = found.decision.laws.shown if found.decision.laws else ()
    words = (
        "Energy that each joint takes out of the motion, by friction, impacts and damping: the wrench that it "
        "transmits times the velocity of the upper block relative to the lower one, from the readings alone. Impacts "
        "of two joints within the smoothing kernel share their loss: one of them may seem to give energy."
    )
    if shown:
        words += (
            " Beyond the end: the same of simulated tests by the nominal model, mean and two standard deviations. The "
            "total goes with how far a test rocks, which is chaotic: it is shown and decides nothing."
        )
    return Figure(words, svg_of(plot_work, found.forces, shown))


def _summary(found):
    broken = found.verdict.laws
    if not found.decision.laws:
        return "The laws of the joints were not judged."
    told = len(found.decision.laws.laws)
    if not broken:
        return f"No law of the joints is broken, of {told} that the tests tell."
    names = ", ".join(f"{one.name} ({law_of(one.name).formula})" for one in broken[:3])
    more = f", and {len(broken) - 3} more" if len(broken) > 3 else ""
    return f"{len(broken)} of {told} laws that the tests tell are broken: {names}{more}."


def _table(found):
    rows = []
    for one in found.decision.laws.laws[:_MOST_LAWS]:
        values = " / ".join(
            number(one.measured[test], 3) if test in one.measured else "-" for test in found.tests
        )
        away = " / ".join(
            number(one.departures[test], 2) if test in one.departures else "-" for test in found.tests
        )
        rows.append((one.name, values, one.unit, away, "broken" if one.broken else ""))
    return Table(
        "Laws of the joints, those that depart farthest first: measured value and departure from the nominal model in "
        f"standard deviations, test by test ({' / '.join(found.tests)}).",
        ("Law", "Measured", "Unit", "Departure", ""),
        tuple(rows),
        "lrlrl",
    )


def described(outside):
    """The force from outside that would explain the broken laws, in a sentence: where, when, how large, its rivals."""
    bodies = " or ".join(outside.bodies)
    unit, factor = ("kN", 1e-3) if outside.unit == "N" else (f"k{outside.unit}", 1e-3)
    size = (
        f"{number(factor * outside.amplitude, 3)} ({number(factor * outside.lower, 3)} to "
        f"{number(factor * outside.upper, 3)}) {unit}"
    )
    rivals = [f"{FORCE_LAWS[name]} {number(score, 2)}" for name, score in list(outside.scores.items())[1:3]]
    when = []
    for test, values in outside.tests.items():
        words = [f"{name} {number(values[name], 3)} s" for name in ("start", "end") if name in values]
        if "earliest" in values:
            words[0] += f" ({number(values['earliest'], 3)} to {number(values['latest'], 3)} s)"
        words += [f"gap {number(1e3 * values['gap'], 3)} mm"] if "gap" in values else []
        when.append(f"{test}: {', '.join(words) if words else 'throughout'}")
    line = (
        f"{number(outside.height, 2)} m above the mass centre of {outside.bodies[0]}"
        if abs(outside.height) > 1e-3
        else f"through the mass centre of {outside.bodies[0]}"
    )
    towards = "+x" if outside.amplitude > 0.0 else "-x"
    direction = f", towards {towards}" if np.isin(outside.law, ("steady", "constant", "pulse")) else ""
    return (
        f"A force from outside would explain the broken laws: on {bodies}, here {line}, "
        f"{FORCE_LAWS[outside.law]}, {size}{direction} (90 % interval over the tests). {'; '.join(when)}. The "
        f"next best forms are worse by (information criterion): {'; '.join(rivals)}."
    )
