"""Evidence of a verdict that the laws of the joints decided, whatever the features of whole tests say."""

from blockshake.diagnosis.inference.lawful_decision import sizes_by_law
from blockshake.diagnosis.laws.law_table import law_of
from blockshake.diagnosis.laws.signatures import SIGNATURES, STOP
from blockshake.effects.registry import EFFECTS
from blockshake.report.diagnosis.wording import title_of
from blockshake.report.document.blocks import Items, Table, Text
from blockshake.report.document.units import quantity

# of the sizes by test: of an effect, and of a stop
_HEADS = {
    False: ("Test", "Size", "90 % by the law's standard error"),
    True: ("Test", "Stiffness", "Gap", "On the other side"),
}
_INTERVAL = 1.645  # standard errors to either side, 90 %


def decided_by_laws(found):
    """Whether the laws named the causes, or left none."""
    laws = found.decision.laws
    if laws is None:
        return False
    if found.decision.decision == "unknown":
        return bool(laws.broken or laws.outside)
    return any(name in laws.isolated for name in found.decision.causes)


def law_blocks(found):
    """The rule that decided, and the size by test of each isolated effect."""
    laws = found.decision.laws
    causes = [name for name in found.decision.causes if name in laws.isolated]
    blocks = [
        Text(
            "The laws of the joints decided (section Joint forces). They overrule the features of whole tests that the "
            "candidates are ranked by."
        ),
        Items(tuple(_isolated(name, laws) for name in causes) or (_unknown(laws),)),
    ]
    for name in causes:
        rows = _sizes(name, laws, found.decision.location[name])
        if rows:
            caption = f"{title_of(name).capitalize()}: size that each test reads by itself."
            blocks.append(Table(caption, _HEADS[name == STOP], rows, "lrrr"[: len(rows[0])]))
    return tuple(blocks)


def second_stop(values):
    """A second stop on the other side of the block, from a test of `OutsideForce`; empty where none is seen."""
    if "other_gap" not in values:
        return ""
    return f"{quantity(values['other_amplitude'], 'N/m')} beyond {quantity(values['other_gap'], 'm')}"


def _isolated(name, laws):
    """Why one effect is isolated, in words."""
    others = [one.name for one in laws.broken]
    if name == STOP:
        reason = "the force that the readings ask for is a spring beyond a gap from one block"
    else:
        own = SIGNATURES[name].own
        reason = f"its own law is broken, its way and alike in all tests ({own}: {law_of_kind(own)})"
        others = [one for one in others if not one.endswith(own)]
    rest = (
        f"it accounts for the other broken laws ({', '.join(others)})" if others else "no other law is broken"
    )
    return f"{title_of(name).capitalize()}: {reason}, and {rest}."


def law_of_kind(kind):
    """Formula of a law without its joint."""
    return law_of(kind if kind.partition(".")[0] in ("table", "unexplained") else f"joint1.{kind}").formula


def _unknown(laws):
    broken = ", ".join(one.name for one in laws.broken)
    what = (
        f"the laws that are broken ({broken})"
        if broken
        else "the force from outside that the readings ask for"
    )
    return f"No effect of the registry accounts for {what}."


def _sizes(name, laws, place):
    """Rows of the sizes by test."""
    if name == STOP and laws.outside_of_stop:
        return tuple(
            (
                test,
                quantity(values["amplitude"], "N/m"),
                quantity(values["gap"], "m"),
                second_stop(values) or "none",
            )
            for test, values in laws.outside_of_stop.tests.items()
        )
    unit = EFFECTS[name].parameters[0].unit
    return tuple(
        (
            test,
            quantity(value, unit),
            f"{quantity(value - _INTERVAL * error, unit)} to {quantity(value + _INTERVAL * error, unit)}",
        )
        for test, value, error in sizes_by_law(name, laws, place)
    )
