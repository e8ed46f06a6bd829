"""Saturation: readings that stop at the end of a sensor's range, which were made gaps when the test was read."""

import numpy as np

from blockshake.parity.finding import Finding


def saturation(tests, level, looked_at):
    """Findings of clipped readings.

    Parameters
    ----------
    tests : dict of str to xarray.Dataset
        By name, as of `without_faulty`.
    level : float
        Of all hypotheses together.
    looked_at : int
        Number of columns of all tests, times two ends.
    """
    return [
        Finding(
            "sensor-saturation", (fault.sensor,), "range", np.array([abs(fault.value)]), np.zeros((1, 1)),
            fault.p * looked_at, (name,),
        )
        for name, test in tests.items()
        for fault in test.attrs.get("faulty", ())
        if fault.kind == "clipped" and fault.p * looked_at < level
    ]  # fmt: skip
