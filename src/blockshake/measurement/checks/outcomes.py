"""Content and contradictions of a campaign of outcomes, in lines for a reader."""

from collections import defaultdict

import numpy as np

from blockshake.errors import InputError
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.commanded_motion import commanded_motion


def standing_body(structure):
    """Number of the one body that is not driven, whose outcomes are known.

    Raises
    ------
    InputError
        There is another number of them, or the body touches no driven one.
    """
    free = np.flatnonzero(~structure.driven)
    if len(free) != 1 or not structure.touching[free[0]].any():
        found = f"found {len(free)}" if len(free) != 1 else "it touches nothing at the start"
        wrong = f"expected one body that stands on a driven one, of outcomes; {found}"
        raise InputError(structure.source, "bodies", wrong)
    return int(free[0])


def outcome_lines(campaign):
    """Lines that say what is there, and then every contradiction; of sealed tests their number alone.

    Raises
    ------
    InputError
        A structure of another kind, see `standing_body`, no open test, a motion that is not at hand.
    """
    opened = campaign.open.values()
    standing_body(load_structure(campaign.structure))
    if not opened:
        wrong = "expected a test with the role fit or select"
        raise InputError(campaign.folder / "campaign.yaml", "tests", wrong)
    fell = sum(test.outcome == "fell" for test in opened)
    lines = [
        f"campaign {campaign.name} on {campaign.structure}: {campaign.counted} of which the outcome alone is "
        f"known; open: {fell} fell, {len(opened) - fell} stood; {len(campaign.sealed)} are sealed"
    ]
    for name, test in campaign.tests.items():
        if commanded_motion(campaign, test) is None:
            path = campaign.folder / "campaign.yaml"
            wrong = f"expected a file in {campaign.folder} or a shipped name"
            raise InputError(path, f"tests.{name}.motion", wrong)
    by_motion, remarks = defaultdict(list), []
    for test in opened:
        by_motion[test.motion].append(test)
    for motion, tests in by_motion.items():
        fallen = min((test for test in tests if test.outcome == "fell"), key=_strength, default=None)
        stood = max((test for test in tests if test.outcome == "stood"), key=_strength, default=None)
        if fallen and stood and _strength(stood) >= _strength(fallen):
            remarks.append(
                f"  {stood.name} stood at {stood.scale:g} of {motion}, {fallen.name} fell at {fallen.scale:g}"
            )
    return lines + (["remarks:", *remarks] if remarks else ["no inconsistency found"])


def _strength(test):
    return abs(test.scale)
