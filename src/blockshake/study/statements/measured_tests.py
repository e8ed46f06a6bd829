"""Statements on the measured tests that a study holds its models against."""

from pathlib import Path

from blockshake.dynamics.motion import CHANNELS
from blockshake.measurement.campaigns.campaign import load_campaign
from blockshake.pages.wording import number, percent
from blockshake.study.statements.statement import against_tests, compared, judged, unjudged

_SAME = 0.005  # relative difference of two printed numbers that are one and the same


def along_one_axis(content):
    """A table that shakes along one axis."""
    cases = compared(content)
    if not cases:
        return unjudged("This study has no measured test.")
    unread = [case.name for case in cases if case.base.attrs.get("unread")]
    if unread:
        return unjudged(f"No marker reads all axes of the slab of {', '.join(unread)}.")
    told, largest = [], 0.0
    for case in cases:
        moved = abs(case.base["displacement"]).max("time")
        aside = float(max(moved.sel(channel=one) for one in CHANNELS if one not in ("x", "pitch_y")))
        share = aside / float(moved.sel(channel="x"))
        largest = max(largest, share)
        told.append(
            f"{case.name} {percent(share)} %, pitch {number(1e3 * moved.sel(channel='pitch_y'))} mrad"
        )
    words = f"Displacement of the slab across x or upright, over that along x: {'; '.join(told)}."
    return against_tests(cases, largest < 0.05, f"{words} 5 % counts as none.")


def strongest_tests(content):
    """Tests with the largest accelerations."""
    cases = compared(content)
    if not cases:
        return unjudged("This study has no measured test.")
    told, holds = [], True
    for case in cases:
        tests = _tests(content, case)
        peaks = {test.name: abs(test.scale) * _peak(content, test.motion) for test in tests}
        strongest = max(tests, key=lambda test: peaks[test.name])
        chosen, own = case.settings["measured"]["test"], content.peak_acceleration(case)
        holds = holds and own >= (1.0 - _SAME) * peaks[strongest.name]
        words = (
            f"{case.name} {chosen} with {number(own)} m/s2, the strongest of the campaign {strongest.name} "
            f"({strongest.role}) with {number(peaks[strongest.name])} m/s2"
        )
        opened = [test.name for test in tests if test.role != "sealed"]
        if strongest.name not in opened and opened:
            best = max(opened, key=peaks.get)
            words += f", of its open tests {best} with {number(peaks[best])} m/s2"
        told.append(words)
    return judged(holds, f"Commanded peaks: {'; '.join(told)}.")


def _tests(content, case):
    """Tests of a case's campaign by the motions of the study, the case's own among them."""
    tests = load_campaign(case.settings["measured"]["campaign"]).tests.values()
    return [test for test in tests if Path(test.motion).stem in content.motions]


def _peak(content, motion):
    return content.motions[Path(motion).stem].attrs["peak_acceleration"]
