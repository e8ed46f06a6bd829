"""The registry of kinds of sensor faults, in the order in which they are taken out of readings."""

from blockshake.parity.kinds import channel_swap, clock, drift, gain, saturation, wrong_place

_KINDS = (
    channel_swap.SWAP,
    channel_swap.AXES,
    channel_swap.POLARITY,
    drift.SLIP,
    drift.DRIFT,
    gain.GAIN,
    wrong_place.PLACE,
    wrong_place.REFERENCE_PLACE,
    clock.LAG,
    clock.SKEW,
    saturation.RANGE,
    saturation.LIMIT,
)
KINDS = {kind.quantity: kind for kind in _KINDS}
