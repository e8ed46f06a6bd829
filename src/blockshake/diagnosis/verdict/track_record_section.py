"""Section of a diagnosis: how often the procedure was right where the truth was known, in two lines."""

from blockshake.diagnosis.verdict.track_record import WHOLE, procedure_digest
from blockshake.pages.blocks import Items, Section, Text
from blockshake.pages.words import Words

PARTS = {WHOLE: "", "1/4": "a quarter", "2-2/4": "a quarter", "1/2": "half", "3/4": "three quarters"}
_RECORD = Words(__name__)
_SHOWN = ("false_alarms", "truth_in_set_seen")


def track_record_section(diagnosed):
    """False alarms, and effects that were found."""
    record = diagnosed.track_record
    if record is None:
        blocks = [Text(_RECORD.missing(), strong=True)]
    else:
        blocks = [Items(track_record_lines(record)), Text(_RECORD.link(PARTS.get(record.part, record.part)))]
        if record.procedure != procedure_digest():
            blocks.append(Text(_RECORD.earlier(), strong=True))
    return Section("Track record of the procedure", "track-record", tuple(blocks))


def track_record_lines(record):
    """The sentences of a `TrackRecord` on false alarms and on effects that were found."""
    return _RECORD.items("shares", *(record.shares.get(name) for name in _SHOWN))
