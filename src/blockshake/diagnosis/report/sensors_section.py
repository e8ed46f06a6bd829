"""Fifth section of a diagnosis: the sensors checked against each other."""

import numpy as np

from blockshake.diagnosis.wording import chance_words, size_words
from blockshake.effects.registry import title_of
from blockshake.measurement.sensors.found_noise import noise_words
from blockshake.pages.blocks import Section, Table, Text
from blockshake.pages.words import Words
from blockshake.parity.kinds.registry import KINDS
from blockshake.parity.parity import LEVEL

_CHECKED = Words(__name__)
_GAINS = (
    ("channels", "Accelerometer channels", "the markers do not show what they read or it is small"),
    (
        "transducers",
        "Displacement transducers",
        "the markers do not see their ends or these hardly moved apart",
    ),
)


def sensors_section(diagnosed):
    """Checks that were made, and the faults with their estimates."""
    return Section("Sensors", "sensors", (Text(_sensors(diagnosed.parity)), *_findings(diagnosed)))


def _sensors(parity):
    noise, lags = parity.markers["noise"], np.abs(parity.clock["lag"])
    gains = []
    for one, sensors, why in _GAINS:
        found = getattr(parity, one)["gain"]
        names = found[found.dims[0]].values
        gains.append((sensors, why, names[found.notnull()].tolist(), names[found.isnull()].tolist()))
    return _CHECKED.checks(
        parity=parity,
        noise=noise_words(parity.sensors),
        level=LEVEL,
        unchecked=noise["marker"].values[np.isnan(noise)].tolist(),
        lag=float(lags.max()) if lags.size else None,
        gains=gains,
        found=bool(parity.findings),
    )


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
    head = ("Fault", "Where", "Quantity", "Estimate", "p", "Tests")
    return [Table(_CHECKED.table(), head, tuple(rows), "lllrrl")] if rows else []
