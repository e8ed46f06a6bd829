"""First page of a diagnosis: the verdict in its box, and one picture."""

from blockshake.diagnosis.laws.signatures import STOP
from blockshake.diagnosis.misfit.ranking import strongest_test
from blockshake.effects.registry import EFFECTS
from blockshake.report.diagnosis.figures.drift import plot_extended_drift, plot_nominal_drift
from blockshake.report.diagnosis.forces_section import described
from blockshake.report.diagnosis.law_evidence import second_stop
from blockshake.report.diagnosis.verdict import drift_change, excluded, facts, statement
from blockshake.report.diagnosis.wording import estimate_words, title_of
from blockshake.report.document.blocks import Figure, Items, Section, Text
from blockshake.report.document.box import Box
from blockshake.report.document.drawing import svg_of
from blockshake.report.document.wording import count_words


def verdict_section(found):
    """Verdict, what holds it back, and the drift of the top block."""
    blocks = [Box(statement(found), facts(found))]
    if found.synthetic:
        blocks.append(
            Text(
                "The tests are SYNTHETIC: virtual tests, computed and seen through made-up sensors, in which an "
                "effect that the nominal model lacks may be hidden. Nothing was measured; 'measured' below "
                "means read off the virtual test.",
                strong=True,
            )
        )
    items = []
    if found.verdict.outside:
        items.append(described(found.verdict.outside))
    for name in found.decision.causes:
        items += _further(found, name)
    if found.verdict.missing:
        items.append(f"Not called established because {'; '.join(found.verdict.missing)}.")
    items += [_record(found, name) for name in found.decision.causes if _hidden(found, name)]
    if found.decision.decision == "unknown" and found.track_record:
        items.append(_record_of_unknown(found.track_record))
    if found.parity.findings:
        faults = "; ".join(f"{title_of(one.effect)}, {', '.join(one.where)}" for one in found.parity.findings)
        items.append(
            "Faults of sensors were found by the sensors' checks, without any simulation, and taken out of the "
            f"readings: {faults}."
        )
    if found.decision.decision == "none":
        items.append(excluded(found))
    if found.verdict.next_test:
        apart = "it from what looks alike" if len(found.verdict.causes) == 1 else "them apart"
        items.append(f"Measurement that would tell {apart}: {found.verdict.next_test}.")
    if found.consequences is not None:
        items.append(drift_change(found, _strongest(found)))
    if items:
        blocks.append(Items(tuple(items)))
    blocks.append(_picture(found))
    return Section("Verdict", "verdict", tuple(blocks))


def _further(found, name):
    """Further parameters of a cause that the tests inform, and the tests that show a stop's force."""
    _, *others = EFFECTS[name].parameters
    known = found.decision.parameters.get(name, {})
    words = [
        f"{item.name} {estimate_words(known[item.name])}"
        for item in others
        if item.name in known and known[item.name].informed
    ]
    stop = found.decision.laws and found.decision.laws.outside_of_stop
    if name == STOP and stop:
        words.append(f"seen in {', '.join(stop.tests)}")
        second = {test: second_stop(values) for test, values in stop.tests.items() if second_stop(values)}
        words += [
            f"{test} shows a second stop on the other side, {one}, which the extension leaves out"
            for test, one in second.items()
        ]
    return [f"{title_of(name).capitalize()}: {'; '.join(words)}."] if words else []


def _hidden(found, name):
    """Answers of the track record to the campaigns that hid an effect."""
    rows = found.track_record.confusion if found.track_record else ()
    return [row.answers for row in rows if row.truth == name and not row.removed]


def _record(found, name):
    """How often the procedure was right about a cause where its truth was known."""
    answers = _hidden(found, name)
    right, count = sum(one.right for one in answers), sum(one.n for one in answers)
    return (
        f"Track record of the procedure: of {count} made-up campaigns that hid {title_of(name)}, it named this effect "
        f"alone in {right}."
    )


def _record_of_unknown(record):
    """How often the answer that the cause is unknown was given, and how often nothing was hidden then."""
    given = sum(row.answers.unknown for row in record.confusion)
    empty = sum(row.answers.unknown for row in record.confusion if row.truth == "none" and not row.removed)
    known = sum(row.answers.unknown for row in record.confusion if row.truth in EFFECTS and not row.removed)
    return (
        f"Track record of the procedure: it answered so on {count_words(given, 'made-up campaign')}, of which {empty} "
        f"hid nothing, {known} one of its candidates, and the others another cause."
    )


def _strongest(found):
    """The sealed test with the largest drift."""
    return str(found.consequences["test"].values[int(found.consequences["measured"].to_numpy().argmax())])


def _picture(found):
    if found.consequences is not None:
        test = _strongest(found)
        return Figure(
            f"Displacement of {found.top} against the table on {test}, a sealed test that nothing was fitted to: "
            f"before and after the extension, and the {found.measured_word} curve.",
            svg_of(plot_extended_drift, found.consequences, [test], found.top, found.measured_word),
        )
    test = strongest_test(found.readings, found.top)
    return Figure(
        f"Displacement of {found.top} against the table on {test}: the nominal ensemble of both solvers and the "
        f"{found.measured_word} curve. "
        + (
            "The extension was tried on no sealed test."
            if found.decision.causes or found.gain is not None
            else "The model was not extended."
        ),
        svg_of(plot_nominal_drift, found.misfit, found.readings, [test], found.top, found.measured_word),
    )
