"""Joint forces of a diagnosis: forces that the joints transmitted, broken laws, and a force from outside in words."""

from blockshake.diagnosis.laws.judged_laws import BROKEN, BROKEN_ONCE
from blockshake.diagnosis.laws.law_table import law_of
from blockshake.diagnosis.laws.null_laws import untamed
from blockshake.report.diagnosis.figures.forces import (
    KILO,
    beyond_the_face,
    plot_levers,
    plot_unexplained,
    plot_work,
)
from blockshake.report.diagnosis.figures.laws import plot_departures, plot_laws, plot_table, slips
from blockshake.report.document.blocks import Figure, Section, Table, Text
from blockshake.report.document.drawing import svg_of
from blockshake.report.document.wording import MISSING, number, sentence_case

FORCE_LAWS = {
    "steady": "steady throughout",
    "constant": "constant from an instant on",
    "pulse": "a pulse",
    "spring": "a spring beyond a gap",
    "damper": "in proportion to the block's velocity",
    "proportional": "in proportion to the block's displacement",
}
_MOST_LAWS = 30  # rows of the table
_SPREADS = 2.0  # standard deviations above the mean of the draws, of the usual largest unexplained force


def forces_section(found):
    """Levers, energy, unexplained force and broken laws."""
    if not found.forces.sizes:
        return Section("Joint forces", "forces", (Text("The sensors of these tests give no joint forces."),))
    blocks = [Text(_summary(found))]
    laws = found.decision.laws.laws if found.decision.laws else ()
    if laws:
        shown = laws[:_MOST_LAWS]
        blocks.append(
            Figure(
                f"Departures of {_how_many(shown, laws)} from the nominal model, a marker a test; the long marks are "
                f"all tests together. A law is broken (red) beyond {BROKEN_ONCE:g} standard deviations in one test or "
                f"{BROKEN:g} of all together. lever.stray, unexplained.rms and unexplained.largest are distances: only "
                "larger values count.",
                svg_of(plot_departures, shown, found.tests),
            )
        )
    joints = [str(name) for name in found.forces["joint"].values]
    blocks += [_levers(found, joints[0]), _of_joints(found, joints[0]), _work(found)] if joints else []
    blocks += [_of_table(found), _unexplained(found)]
    if laws:
        blocks.append(_table(found, laws))
    return Section("Joint forces", "forces", tuple(blocks))


def _summary(found):
    broken = found.verdict.laws
    if not found.decision.laws:
        return "The laws of the joints were not judged."
    told = len(found.decision.laws.laws)
    if not broken:
        words = f"No law of the joints is broken, of {told} that the tests tell."
        if found.verdict.outside:
            words += (
                " Yet the joints would have to carry more than dry joints can, so that a force from outside is needed: "
                "see the least unexplained force below."
            )
        return words
    names = ", ".join(f"{one.name} ({law_of(one.name).formula})" for one in broken[:3])
    more = f", and {len(broken) - 3} more" if len(broken) > 3 else ""
    return f"{len(broken)} of {told} laws that the tests tell are broken: {names}{more}."


def _how_many(shown, laws):
    return (
        f"all {len(laws)} laws"
        if len(shown) == len(laws)
        else f"the farthest {len(shown)} of {len(laws)} laws"
    )


def _levers(found, joint):
    one = found.forces.sel(joint=joint)
    beyond = any(beyond_the_face(one.sel(test=test)).notnull().any() for test in one["test"].values)
    return Figure(
        f"Lever of joint {joint}: where the resultant of all forces crosses its face, from the readings alone by the "
        "equations of Newton and Euler. Dashed: the edges of the face. Levers beyond four half widths are cut off. "
        + (
            "Red: beyond an edge by more than three standard deviations, which a dry joint cannot carry."
            if beyond
            else "No lever is beyond an edge by more than three standard deviations."
        ),
        svg_of(plot_levers, found.forces, joint),
    )


def _of_joints(found, joint):
    friction = (
        "Middle: the ratio of shear to normal force of a slipping joint by its slip rate; Coulomb's is the structure's "
        f"coefficient (dashed, of {joint}). "
        if slips(found.forces)
        else "No joint slips faster than 0.01 m/s away from impacts, so that no friction is read. "
    )
    return Figure(
        "Laws of the joints, a point an instant away from impacts. Left: the lever of a turned joint by its rotation; "
        f"a sharp edge has one lever (dashed, of {joint}), a worn one rolls outwards. {friction}Right: the rotation "
        "of a closed joint by its moment; the slope of its line is the joint's compliance.",
        svg_of(plot_laws, found.forces),
    )


def _work(found):
    """Energy that the joints take, beside that of the nominal draws where there are some."""
    shown = found.decision.laws.shown if found.decision.laws else ()
    words = (
        "Energy that each joint takes out of the motion, by friction, impacts and damping: the wrench that it "
        "transmits times the velocity of the upper block relative to the lower one, from the readings alone. Impacts "
        "of two joints within the smoothing kernel keep the sum of their losses (dashed) and not the share of each: a "
        "joint may seem to give energy. The work of a force from outside is booked to the joints beneath it."
    )
    if shown:
        words += (
            " Beyond the end: the same of simulated tests by the nominal model, mean and two standard deviations. The "
            "total goes with how far a test rocks, which is chaotic: it is shown and decides nothing."
        )
    return Figure(words, svg_of(plot_work, found.forces, shown))


def _of_table(found):
    return Figure(
        "Rotation of the table by its acceleration, less what the moment explains (left), and by the moment of the "
        "blocks on it, less what the acceleration explains (right): a slope on the left is a pitching table, one on "
        "the right a base that gives way.",
        svg_of(plot_table, found.forces),
    )


def _unexplained(found):
    usual = _usual_force(found)
    return Figure(
        "Least unexplained force along x: the smallest forces on the blocks that one would have to invent so that "
        "the joints carry no tension and no more than Coulomb's friction. A turned joint tells the moment of these "
        "forces and not the block that each acts on, so that one force may appear on several blocks. Black: "
        "the sum over the blocks."
        + (
            " Dashed: the largest sum over the blocks that noise and numerics leave in simulated tests by the nominal "
            "model (mean and two standard deviations)."
            if usual
            else ""
        ),
        svg_of(plot_unexplained, found.forces, usual),
    )


def _usual_force(found):
    """By test: the largest sum of unexplained forces over the blocks that nominal draws leave [N]."""
    laws = found.decision.laws.laws if found.decision.laws else ()
    return {
        test: found.forces.attrs["weight"] * untamed(one.name, mean + _SPREADS * one.spreads[test])
        for one in laws
        if one.name == "unexplained.largest"
        for test, mean in one.expected.items()
    }


def _joint_names(laws):
    """The joints that the names of laws count, by their bodies."""
    joints = sorted({(one.name.partition(".")[0], one.joint) for one in laws if one.joint})
    return sentence_case("; ".join(f"{place} is {name}" for place, name in joints)) if joints else ""


def _table(found, laws):
    def by_test(values, digits=3):
        return " / ".join(number(values[test], digits) if test in values else MISSING for test in found.tests)

    rows = []
    for one in laws[:_MOST_LAWS]:
        nominal = {test: untamed(one.name, mean) for test, mean in one.expected.items()}
        rows.append((
            one.name, by_test(one.measured), by_test(nominal), one.unit, by_test(one.departures, 2),
            number(one.together, 2), "broken" if one.broken else "",
        ))  # fmt: skip
    return Table(
        f"Laws of the joints, test by test ({' / '.join(found.tests)}), those that depart farthest first: measured "
        "value, mean of the nominal draws, departure in standard deviations, and that of all tests together. The "
        "scatter of the draws counts as a third of the law's usual spread at least. "
        f"{MISSING}: the test does not tell the law. {_joint_names(laws[:_MOST_LAWS])} Formulas are in "
        "docs/joint-forces.md.",
        ("Law", "Measured", "Nominal", "Unit", "Departure", "Together", ""),
        tuple(rows),
        "lrrlrrl",
    )


def described(outside):
    """The force from outside that would explain the broken laws, in a sentence: where, when, how large, its rivals."""
    bodies = " or ".join(outside.bodies)
    rivals = [
        f"{FORCE_LAWS[name]} by {number(score, 2)}" for name, score in list(outside.scores.items())[1:3]
    ]
    when = []
    for test, values in outside.tests.items():
        words = [f"{name} {values[name]:.2f} s" for name in ("start", "end") if name in values]
        if "earliest" in values:
            words[0] += f" ({values['earliest']:.2f} to {values['latest']:.2f} s)"
        words += [f"gap {number(1e3 * values['gap'], 3)} mm"] if "gap" in values else []
        if "amplitude" in values:
            words.insert(0, f"{number(KILO * values['amplitude'], 3)} k{outside.unit}")
        when.append(f"{test}: {', '.join(words) if words else 'throughout'}")
    line = (
        f"{number(outside.height, 2)} m above the mass centre of {outside.bodies[0]}"
        if abs(outside.height) > 1e-3
        else f"through the mass centre of {outside.bodies[0]}"
    )
    return (
        f"A force from outside would explain what dry joints cannot carry: on {bodies}, here {line}, "
        f"{FORCE_LAWS[outside.law]}, {force_words(outside)} (90 % interval). {'; '.join(when)}. The next best forms "
        f"are worse by the information criterion: {'; '.join(rivals)}."
    )


def force_words(outside):
    """Size of a force with its interval and its direction."""
    ends = " to ".join(number(KILO * one, 3) for one in (outside.lower, outside.upper))
    towards = "+x" if outside.amplitude > 0.0 else "-x"
    direction = f", towards {towards}" if outside.law in ("steady", "constant", "pulse") else ""
    if direction and outside.lower < 0.0 < outside.upper:
        direction = ", its direction not told"
    return f"{number(KILO * outside.amplitude, 3)} ({ends}) k{outside.unit}{direction}"
