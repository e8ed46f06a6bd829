"""Second section of a diagnosis: the odds of every cause that was tried, and how they were counted."""

from itertools import chain

from blockshake.diagnosis.answer.answer import COARSENING, coarsened
from blockshake.diagnosis.answer.decision import HELD_OUT_LEVEL
from blockshake.diagnosis.answer.thresholds import FREE_SHARE
from blockshake.diagnosis.evidence.explanation import NEVER
from blockshake.diagnosis.outside.registry import FORMS
from blockshake.diagnosis.report.statement import RATIO
from blockshake.diagnosis.wording import chance_words, name_of, times_words
from blockshake.pages.blocks import Section, Table, Text
from blockshake.pages.words import Words

_COUNTED = Words(__name__)


def odds_section(diagnosed):
    """Odds and log Bayes factors of all rivals, one table a part of the readings."""
    parts = diagnosed.decision.parts
    blocks = [Text(_COUNTED.method(COARSENING, FREE_SHARE)), *([] if parts else [Text(_COUNTED.nothing())])]
    return Section("Odds of all causes", "odds", (*blocks, *chain(*map(_of_part, parts))))


def _of_part(part):
    """The table of a part, and how its first cause fares on the tests to select by."""
    yield _table(part)
    if part.held_out:
        yield Text(
            _COUNTED.held_out(
                part.causes[0].title, part.held_out, chance_words(part.held_out.p), HELD_OUT_LEVEL
            )
        )


def _table(part):
    """Every cause and none, the most probable first."""
    first, rows = part.causes[0], []
    possible = {name: value for name, value in part.odds.items() if part.gains[name] > NEVER}
    odds = {**possible, None: coarsened(first.gain, first.gain)}
    for name in sorted(odds, key=odds.get):
        kind = "" if name is None else "form from outside" if name in FORMS else "effect"
        less = times_words(odds[name]) if odds[name] > 0.0 else "the most probable"
        factor = f"{round(part.gains[name], 1) + 0.0:.1f}" if name else "0"
        rows.append((name_of(name) if name else "nothing", kind, less, factor))
    words = _COUNTED.table(part.readings, first.title, RATIO)
    return Table(words, ("Cause", "Kind", "Less probable", "Log Bayes factor"), tuple(rows), "llrr")
