"""Measured tests of a campaign without their sensor faults, read off like simulated tests."""

import numpy as np
import xarray as xr

from blockshake.diagnosis.features.reading import read_off
from blockshake.geometry.structure import load_structure
from blockshake.parity.correction import load_corrected_test


def measured_readings(campaign, names, findings, longest=np.inf):
    """Features and histories of measured tests.

    Parameters
    ----------
    campaign : Campaign
    names : sequence of str
        Of tests; a sealed one is read only where the gain is measured.
    findings : sequence of Finding
        Sensor faults that are taken out first.
    longest : float, optional
        Readings later than this after a test's first reading are left out [s].

    Returns
    -------
    xarray.Dataset
        As from `read_off`, along ``test``; NaN after the end of a shorter test.
    """
    structure = load_structure(campaign.structure)
    parts = []
    for name in names:
        test = load_corrected_test(campaign, name, structure, findings)
        test = test.isel(time=test["time"].to_numpy() <= longest)
        parts.append(read_off(test, structure, campaign.sensors))
    return xr.concat(parts, dim="test", join="outer", coords="minimal", compat="override").assign_coords(
        test=list(names)
    )


def reading_of(readings, name):
    """Reading of one test of `measured_readings`."""
    one = readings.sel(test=name, drop=True)
    one = one.dropna("time", subset=["acceleration"]).dropna("feature", subset=["value"])
    return one.assign(phase=one["phase"].astype(np.int8))


def tamed_readings(scales, readings):
    """Measured features on the libraries' scales, list of float64 array, shape (n_features,), by test."""
    names = readings["test"].values
    return [scale.tamed(reading_of(readings, name)) for scale, name in zip(scales, names, strict=True)]
