"""Content and gaps of a campaign of poses, in lines for a reader."""

import numpy as np

from blockshake_flight.posed_test import CLEAR, load_posed

_MOST = 10  # tests that are described one by one


def posed_lines(campaign):
    """Lines that say what is there, and then every gap; of a sealed test its shape alone.

    Raises
    ------
    InputError
        As of `load_posed`.
    """
    posed = load_posed(campaign, list(campaign.tests))
    mass = posed.structure.mass[posed.body]
    lines = [
        f"campaign {campaign.name} on {campaign.structure}: {len(posed.tests)} "
        f"test{'s' * (len(posed.tests) != 1)} of {posed.name} ({mass:.4g} kg) "
        f"over a ground at rest at {posed.ground:g} m"
    ]
    remarks = []
    for test in posed.tests:
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
        if role != "sealed" and posed.heights(test)[0].min() < CLEAR * posed.radius:
            remarks.append(f"  {test.name}: the body touches the ground at the first reading")
    if len(posed.tests) > _MOST:
        lines.append(f"  and {len(posed.tests) - _MOST} more tests")
    return lines + (["remarks:", *remarks] if remarks else ["no inconsistency found"])


def remark(campaign):
    """No line and no remark beyond those of `posed_lines`."""
    return [], []
