"""Content and gaps of a campaign of poses, in lines for a reader."""

import numpy as np

from blockshake_flight.tracked_test import CLEAR, load_tracked

_MOST = 10  # tests that are described one by one


def tracked_lines(campaign):
    """Lines that say what is there, and then every gap; of a sealed test its shape alone.

    Raises
    ------
    InputError
        As of `load_tracked`.
    """
    tracked = load_tracked(campaign, list(campaign.tests))
    mass = tracked.structure.mass[tracked.body]
    lines = [
        f"campaign {campaign.name} on {campaign.structure}: {len(tracked.tests)} "
        f"test{'s' * (len(tracked.tests) != 1)} of {tracked.name} ({mass:.4g} kg) "
        f"over a ground at rest at {tracked.ground:g} m"
    ]
    remarks = []
    for test in tracked.tests:
        role = campaign.tests[test.name].role
        rate, lost = 1.0 / np.median(np.diff(test.time)), np.isnan(test.rotation[:, 0, 0]).mean()
        if len(lines) <= _MOST:
            plane = "in the plane of x and z" if test.planar else "in space"
            lines.append(
                f"  {test.name} ({role}): {test.time[-1]:.4g} s at {rate:.4g} Hz, poses {plane}, "
                f"{100.0 * lost:.2g} % gaps"
            )
        if np.ptp(np.diff(test.time)) > 0.01 / rate:
            remarks.append(f"  {test.name}: the times are not even; a flight ends where rows are missing")
        if role != "sealed" and tracked.heights(test)[0].min() < CLEAR * tracked.radius:
            remarks.append(f"  {test.name}: the body touches the ground at the first reading")
    if len(tracked.tests) > _MOST:
        lines.append(f"  and {len(tracked.tests) - _MOST} more tests")
    return lines + (["remarks:", *remarks] if remarks else ["no inconsistency found"])


def remark(campaign):
    """No line and no remark beyond those of `tracked_lines`."""
    return [], []
