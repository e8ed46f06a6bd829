"""The registry of kinds of sensor faults, in the order in which they are taken out of readings."""

from blockshake.parity.kinds import axes, clock, drift, gain, polarity, saturation, slip, swap, wrong_place

_KINDS = (
    swap.SWAP,
    axes.AXES,
    polarity.POLARITY,
    slip.SLIP,
    drift.DRIFT,
    gain.GAIN,
    wrong_place.PLACE,
    wrong_place.REFERENCE_PLACE,
    clock.LAG,
    clock.SKEW,
    saturation.RANGE,
)
KINDS = {kind.quantity: kind for kind in _KINDS}
