"""Third page of a diagnosis: every effect that was considered, and why it is a cause or is not."""

from blockshake.diagnosis.inference.decision import INADEQUATE, INCONSTANT, NOT_IN_SET
from blockshake.effects.registry import EFFECTS
from blockshake.report.diagnosis.figures.candidates import plot_candidates
from blockshake.report.diagnosis.wording import beyond, size_in_unit, title_of, with_place
from blockshake.report.document.blocks import Figure, Section, Table, Text
from blockshake.report.document.drawing import svg_of
from blockshake.report.document.units import quantity
from blockshake.report.document.wording import MISSING, number


def candidates_section(found):
    """Log ratios beside placebos, and the tests that a cause has to pass."""
    decision = found.decision
    rows = sorted(
        (found.decision.candidate(key) for key in decision.places.values()), key=lambda row: -row.log_ratio
    )
    causes = decision.causes
    blocks = [
        Text(
            f"{len(decision.candidates)} candidates, {len(rows)} effects at all places of the structure, were "
            "added to the nominal model in simulation. The log ratio says how much likelier the features of all tests "
            "are with an effect than without, averaged over its sizes. Placebos shift the features by as much "
            "but mean nothing physically: by the features alone, an effect that explains no more than they do is no "
            "cause. The laws of the joints overrule the features wherever they tell."
        ),
        Figure(
            "Log ratio of each effect at its best place to the nominal model. Both solvers: the mean of their "
            "likelihoods, which the solver rules whose nominal model fits the tests better. "
            + ("Shaded: effects that are not excluded." if causes else "No effect is a cause."),
            svg_of(plot_candidates, rows, [_words(found, row) for row in rows], causes, decision.placebo),
        ),
        _table(found, rows),
        _reasons(found, rows),
    ]
    if decision.solver_dependent:
        blocks.append(
            Text(
                "Solver-dependent: by "
                + ", ".join(decision.solver_dependent)
                + " alone another effect explains clearly more than the named one.",
                strong=True,
            )
        )
    return Section("Candidates", "candidates", tuple(blocks))


def _words(found, row):
    return with_place(row.effect, found.places[row.key])


def _table(found, rows):
    decision = found.decision
    lines = []
    for row in rows:
        name = row.effect
        unit = EFFECTS[name].parameters[0].unit
        shown = decision.shown_above.get(name)
        lines.append((
            _words(found, row), number(row.log_ratio), quantity(size_in_unit(name, row.size), unit),
            number(decision.probabilities[name], 2), number(decision.adequacy[name], 2),
            number(decision.constancy[name], 2),
            beyond(name, size_in_unit(name, shown)) if shown is not None else MISSING,
        ))  # fmt: skip
    return Table(
        "Effects at their best places. Set: conformal p value, how often the effect falls as far short of the "
        f"strongest where it is the truth; it leaves the set at {NOT_IN_SET:g} or less, and the values are no "
        f"probabilities that add up to 1. Adequacy: chance of as bad a best fit where it is the truth, too low "
        f"at {INADEQUATE:g} or less. Constancy: chance of sizes as different from test to test if it has one, too "
        f"low at {INCONSTANT:g} or less. "
        "Seen: sizes that would have been called an effect in nine of ten cases of the library; none where no "
        "simulated size was.",
        ("Effect and place", "Log ratio", "Best size", "Set", "Adequacy", "Constancy", "Seen"),
        tuple(lines),
        "lrrrrrr",
    )


def _reasons(found, rows):
    decision, lines = found.decision, []
    for row in rows:
        name = row.effect
        why = decision.struck_out.get(name)
        if why:
            words = f"struck out: {'; '.join(why)}"
        elif decision.decision == "combination":
            words = "explains the tests together with the other"
        else:
            words = "not excluded" if name in decision.causes else "not called by the features of whole tests"
        lines.append((title_of(name), words))
    return Table("Why each effect is a cause or is not.", ("Effect", "Verdict"), tuple(lines), "ll")
