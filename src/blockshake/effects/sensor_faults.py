"""Effects of sensors: faults that the parity checks find and that no force of a joint shows."""

from blockshake.effects.effect import Effect, EffectParameter
from blockshake.effects.places import markers, nowhere


def _clock_lag(experiment, values, place):
    """The optical system's clock is behind the accelerometers'."""
    return experiment.with_instruments(marker_lag=experiment.instruments.marker_lag + values["lag"])


_CLOCK_LAG = Effect(
    name="clock-lag",
    title="lag of the optical clock",
    acts="observation",
    equation="marker read at t shows t - tau",
    source="two recorders without a common trigger, by definition",
    parameters=(
        EffectParameter("lag", "s", "of the optical clock behind the accelerometers'", 0.0, -0.03, 0.03, 0.01),
    ),
    confused_with=("joint-compliance",),
    distinguished_by="phase between a marker and an accelerometer on the same body",
    places=nowhere,
    act=_clock_lag,
)  # fmt: skip


def _sensor_gain(experiment, values, place):
    """One marker reads its displacement too large or too small."""
    gains, name = experiment.instruments.marker_gain, place["marker"]
    return experiment.with_instruments(
        marker_gain={**gains, name: gains.get(name, 1.0) * (1.0 + values["error"])}
    )


_SENSOR_GAIN = Effect(
    name="sensor-gain",
    title="gain of a marker",
    acts="observation",
    equation="reading = (1 + g) displacement",
    source="scale error of a camera, by definition",
    parameters=(EffectParameter("error", "1", "relative error of the gain", 0.0, -0.1, 0.1, 0.03),),
    confused_with=("marker-offset",),
    distinguished_by="rigid fit of at least four markers of the block; a test in which the blocks do not move",
    places=markers,
    act=_sensor_gain,
)


def _marker_offset(experiment, values, place):
    """One marker sits elsewhere on its block than in the structure ."""
    offsets, name = experiment.instruments.marker_offset, place["marker"]
    x, y, z = offsets.get(name, (0.0, 0.0, 0.0))
    return experiment.with_instruments(marker_offset={**offsets, name: (x, y, z + values["height"])})


_MARKER_OFFSET = Effect(
    name="marker-offset",
    title="offset of a marker",
    acts="observation",
    equation="reading = displacement of the point (0, 0, e) above the stated one, body frame",
    source="rigid-body kinematics",
    parameters=(EffectParameter("height", "m", "of the marker above its stated place", 0.0, -0.1, 0.1, 0.05),),
    confused_with=("sensor-gain", "eccentricity"),
    distinguished_by="rigid fit of at least four markers of the block while it rotates",
    places=markers,
    act=_marker_offset,
)  # fmt: skip


def _sensor_drift(experiment, values, place):
    """The zero of one marker creeps along x."""
    creeps = experiment.instruments.marker_creep
    return experiment.with_instruments(marker_creep={**creeps, place["marker"]: (values["rate"], 0.0, 0.0)})


_SENSOR_DRIFT = Effect(
    name="sensor-drift",
    title="drift of a marker",
    acts="observation",
    equation="reading = truth + d t",
    source="creep of a camera, a mount or an amplifier, by definition",
    parameters=(EffectParameter("rate", "m/s", "of the zero along x", 0.0, -5e-4, 5e-4, 2e-4),),
    confused_with=("sensor-gain", "marker-offset"),
    distinguished_by="readings before and after the shaking; rigid fit of at least four markers of the block",
    places=markers,
    act=_sensor_drift,
)


def _sensor_saturation(experiment, values, place):
    """One marker reads nothing beyond its range."""
    ranges = experiment.instruments.marker_range
    return experiment.with_instruments(marker_range={**ranges, place["marker"]: values["range"]})


_SENSOR_SATURATION = Effect(
    name="sensor-saturation",
    title="range of a marker",
    acts="observation",
    equation="reading = truth between -r and r",
    source="end of a camera's view or of an amplifier, by definition",
    parameters=(EffectParameter("range", "m", "beyond which nothing is read", 1.0, 0.005, 1.0, 0.05),),
    confused_with=("sensor-gain",),
    distinguished_by="readings that stand still at one value in several tests",
    places=markers,
    act=_sensor_saturation,
)
FAULTS = (_CLOCK_LAG, _SENSOR_GAIN, _MARKER_OFFSET, _SENSOR_DRIFT, _SENSOR_SATURATION)
