"""Fifth section of a diagnosis: the sensors checked against each other."""

import numpy as np

from blockshake.diagnosis.wording import chance_words, size_words
from blockshake.effects.registry import title_of
from blockshake.measurement.sensors.found_noise import noise_words
from blockshake.pages.blocks import Section, Table, Text
from blockshake.pages.wording import number
from blockshake.parity.kinds.registry import KINDS
from blockshake.parity.parity import LEVEL


def sensors_section(diagnosed):
    """Checks that were made, and the faults with their estimates."""
    return Section("Sensors", "sensors", (Text(_sensors(diagnosed.parity)), *_findings(diagnosed)))


def _sensors(parity):
    noise = parity.markers["noise"]
    unchecked = noise["marker"].values[np.isnan(noise)].tolist()
    text = (
        f"The sensors were checked against each other, without any simulation: {parity.looked_at} hypotheses on "
        f"{parity.markers.sizes['marker']} markers, {parity.channels.sizes['channel']} accelerometer channels, "
        f"the clocks of {parity.clock.sizes['test']} tests; chance of any false finding {LEVEL:g}. "
    )
    text += f"At rest the {noise_words(parity.sensors)}. "
    if unchecked:
        text += f"Not checked against others, fewer than three on their body: {', '.join(unchecked)}. "
    lags = np.abs(parity.clock["lag"])
    if lags.size:
        text += f"Largest lag between markers and accelerometers {number(1e3 * lags.max(), 2)} ms. "
    for gains, sensors, why in (
        (
            parity.channels["gain"],
            "Accelerometer channels",
            "the markers do not show what they read or it is small",
        ),
        (
            parity.transducers["gain"],
            "Displacement transducers",
            "the markers do not see their ends or these hardly moved apart",
        ),
    ):
        known, others = (
            gains[gains.dims[0]].values[one].tolist() for one in (gains.notnull(), gains.isnull())
        )
        if known:
            text += f"{sensors} whose gain the markers of their bodies tell: {', '.join(known)}. "
        if others:
            text += f"{sensors} whose gain nothing tells, as {why}: {', '.join(others)}. "
    return text if parity.findings else f"{text}No fault was found."


def _estimate(finding, channels):
    """Estimate of a finding with its standard error, in the unit of its quantity; by axis where it is a vector."""
    unit = KINDS[finding.quantity].units[set(finding.where) <= set(channels)]
    axes = ("x ", "y ", "z ") if len(finding.estimate) == 3 else ("",)
    return ", ".join(
        f"{axis}{size_words(value, unit)} ({size_words(error, unit, 2)})"
        for axis, value, error in zip(axes, finding.estimate, finding.standard_error, strict=False)
    )


def _findings(diagnosed):
    rows = [
        (
            title_of(one.effect), ", ".join(one.where), one.quantity,
            _estimate(one, diagnosed.parity.channels["channel"].values),
            chance_words(one.p).removeprefix("p = ").removeprefix("p "), ", ".join(one.tests),
        )
        for one in diagnosed.parity.findings
    ]  # fmt: skip
    if not rows:
        return []
    return [
        Table(
            "Faults of sensors, taken out of the readings before any cause was looked for; the standard error of "
            "each estimate stands in brackets. The place of a marker or of an end of a displacement transducer is "
            "in the frame of its body.",
            ("Fault", "Where", "Quantity", "Estimate", "p", "Tests"),
            tuple(rows),
            "lllrrl",
        )
    ]
