"""Section of a diagnosis: how often the procedure was right where the truth was known, in two lines."""

import re
from fractions import Fraction

from blockshake.diagnosis.verdict.track_record import procedure_digest
from blockshake.pages.blocks import Items, Section, Text
from blockshake.pages.words import Words

_PARTS = {
    Fraction(1): "",
    Fraction(1, 4): "a quarter",
    Fraction(1, 2): "half",
    Fraction(3, 4): "three quarters",
}
_RECORD = Words(__name__)
_SHOWN = ("false_alarms", "truth_in_set_seen")


def track_record_section(diagnosed):
    """False alarms, and effects that were found."""
    record = diagnosed.track_record
    if record is None:
        blocks = [Text(_RECORD.missing(), strong=True)]
    else:
        blocks = [Items(track_record_lines(record)), Text(_RECORD.link(part_in_words(record)))]
        if record.procedure != procedure_digest():
            blocks.append(Text(_RECORD.earlier(), strong=True))
    return Section("Track record of the procedure", "track-record", tuple(blocks))


def track_record_lines(record):
    """The sentences of a `TrackRecord` on false alarms and on effects that were found."""
    return _RECORD.items("shares", *(record.shares.get(name) for name in _SHOWN))


def part_in_words(record):
    """The part of the list of cases that a `TrackRecord` judged, such as "a quarter"; empty for the whole list.

    ``3-3/4`` is the third of four quarters.
    """
    first, last, every = [1, *map(int, re.findall(r"\d+", record.part))][-3:]
    return _PARTS.get(Fraction(last - first + 1, every), record.part)
