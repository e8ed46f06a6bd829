"""Saturation: readings that stop at the end of a sensor's range, which were made gaps when the test was read."""

from blockshake.parity.finding import Finding


def saturation(tests, level):
    """Findings of clipped readings.

    Parameters
    ----------
    tests : dict of str to xarray.Dataset
        By name, as of `without_faulty`.
    level : float
        Chance of any finding with sound sensors; hypotheses are both ends of all columns of all tests.
    """
    looked_at = 2 * sum(
        3 * test.sizes["marker"] + test.sizes.get("channel", 0) + test.sizes.get("transducer", 0)
        for test in tests.values()
    )
    return [
        Finding.of("range", (fault.sensor,), fault.p * looked_at, (name,), [abs(fault.value)])
        for name, test in tests.items()
        for fault in test.attrs.get("faulty", ())
        if fault.kind == "clipped" and fault.p * looked_at < level
    ]
