"""A sensor stops at the end of its range: reading = truth between -r and r. Such readings are gaps before any check."""

from blockshake.parity.kinds.kind import Kind

RANGE = Kind("range", "sensor-saturation", "reading = truth between -r and r", units=("m", "m/s2"))


def saturation(tests, level):
    """Findings of columns that stop at an end of their range; a column has two ends."""
    looked_at = 2 * sum(
        3 * test.sizes["marker"] + test.sizes.get("channel", 0) + test.sizes.get("transducer", 0)
        for test in tests.values()
    )
    return [
        RANGE.finding((fault.sensor,), fault.p * looked_at, (name,), [abs(fault.value)])
        for name, test in tests.items()
        for fault in test.attrs.get("faulty", ())
        if fault.kind == "clipped" and fault.p * looked_at < level
    ]
