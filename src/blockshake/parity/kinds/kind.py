"""The row of a kind of sensor fault in the registry, and where the readings of a sensor stand in a test."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from blockshake.parity.finding import Finding


class Kind(NamedTuple):
    """A kind of fault."""

    quantity: str  # name of the kind: what is estimated, or exchanged
    effect: str  # that the kind counts as
    equation: str  # of the reading
    # callable of (test, findings, structure); takes findings of this kind out of a test's readings, in place;
    # without it the readings stay
    correct: Callable | None = None
    # of str; of the estimate, for a marker or a displacement transducer, and for an accelerometer channel
    units: tuple = ("1", "1")
    # component of a vector that is the size of the registry's effect; None where no component is
    size: int | None = 0

    def finding(self, where, p, tests, estimate=(), covariance=None):
        """`Finding` of this kind; without an estimate where nothing is to be estimated. p is 1 at most."""
        estimate = np.asarray(estimate, dtype=float)
        covariance = np.zeros((len(estimate),) * 2) if covariance is None else covariance
        return Finding(self.effect, where, self.quantity, estimate, covariance, min(p, 1.0), tuple(tests))


class Column(NamedTuple):
    """How a kind of fault enters the readings of a sort of sensors, linear in its size."""

    kind: Kind
    components: int  # 1, or 3 of a vector
    tolerance: float  # size that a faultless sensor may have; its standard deviation is half of it
    signature: Callable  # makes the readings that a unit of the fault leaves, by component
    by_test: bool = False  # whether the fault is another one in each test
    visible: float = 0.0  # size that would have to leave as much as the noise, for the fault to be looked for


def readings_of(test, sensor):
    """Variable and selection of the readings of a marker, channel or displacement transducer."""
    for dimension, variable in (("transducer", "transducer_displacement"), ("channel", "accelerometer")):
        if dimension in test.coords and sensor in test[dimension].values:
            return variable, {dimension: sensor}
    return "marker_displacement", {"marker": sensor}
