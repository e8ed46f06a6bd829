"""Dynamic properties of a stack from the low-amplitude tests of a campaign, or from one test or run file."""

from pathlib import Path

import numpy as np
from scipy.stats import norm
from scipy.stats import t as student

from blockshake.errors import InputError
from blockshake.files import parse_json
from blockshake.geometry.structure import build_structure, load_structure
from blockshake.measurement.campaigns.campaign import Sensors, load_campaign, load_test
from blockshake.measurement.campaigns.reading_files import netcdf_attributes
from blockshake.measurement.campaigns.recorded_test import read_test
from blockshake.measurement.modes.dynamic_properties import modes_from_noise
from blockshake.measurement.modes.transmissibility import PIECES, transmissibility

CONFIDENCE = 0.95
_TAIL = 0.5 * (1.0 + CONFIDENCE)
_NOISELESS = Sensors(marker_noise=0.0, accelerometer_noise=0.0)  # of a run file
HEADER = ("test", "excitation", "mode", "frequency [Hz]", "damping ratio [1]", "answer / base [1]")


def summarise_modes(source, structure=None, axis="x"):
    """Modes from broad-band tests and steady answers from sine tests, with intervals of 95 %.

    Parameters
    ----------
    source : str or path
        Folder of a campaign, of which every test but the sealed ones is read; or a netCDF file of a test or a run.
    structure : str or path, optional
        Shipped name or file: of a test file. A campaign names its own and a run file holds it.
    axis : str
        Along which the base moves.

    Returns
    -------
    list of dict
        By test, JSON-like: ``test`` and ``excitation``. For ``broad band``, ``finding`` and ``modes``, each with
        ``frequency`` [Hz] and ``damping_ratio`` [1]. For ``sine``, ``frequency``, that of the drive [Hz], and
        ``answer``, the largest displacement of a marker over the base's [1], with ``marker`` and ``phase`` [rad].
        Quantities are ``{"value", "interval", "unit"}``. For ``unread``, ``finding`` says why.

    Raises
    ------
    InputError
        No such file or folder, a test file without a structure, or readings that are wrong.

    Notes
    -----
    A test is read as a sine where `transmissibility` finds one that is steady, else as broad band.
    """
    return [
        {"test": name, **_summary(test, built, sensors, axis)}
        for name, test, built, sensors in _tests(Path(source), structure)
    ]


def summary_rows(tests):
    """Rows of the printed table of `summarise_modes`, after `HEADER`, tuples of 6 str."""
    rows = []
    for test in tests:
        label = (test["test"], test["excitation"])
        if test["excitation"] == "sine":
            answer = f"{_shown(test['answer'])} at {test['marker']}"
            rows.append((*label, "", f"{test['frequency']['value']:.4g}", "", answer))
        elif not test.get("modes"):
            rows.append((*label, "", test["finding"], "", ""))
        else:
            rows += [
                (*label, str(number), _shown(mode["frequency"]), _shown(mode["damping_ratio"]), "")
                for number, mode in enumerate(test["modes"], start=1)
            ]
    return rows


def _tests(source, structure):
    """Name, readings, structure and sensors of every test of a source."""
    if source.is_dir():
        campaign = load_campaign(source)
        built = load_structure(campaign.structure)
        for name, test in campaign.tests.items():
            if test.role != "sealed":
                yield name, load_test(campaign, name), built, campaign.sensors
        return
    if not source.is_file():
        raise InputError(source, "", "expected the folder of a campaign, or a test or run file")
    if structure is not None:
        built = load_structure(structure)
        yield source.stem, read_test(source, built), built, Sensors()
        return
    attributes = netcdf_attributes(source)
    if "structure_file" not in attributes:
        raise InputError("--structure", "", f"expected the structure of {source}, which is no run file")
    mapping = parse_json(str(attributes["structure_file"]), source)
    built = build_structure(mapping, str(source), source.parent)
    yield source.stem, read_test(source, built), built, _NOISELESS


def _summary(test, structure, sensors, axis):
    try:
        return _sine(transmissibility(test, structure, axis=axis), axis)
    except InputError:
        pass  # no steady sine
    try:
        found = modes_from_noise(test, structure, sensors.marker_noise, sensors.accelerometer_noise, axis)
    except InputError as error:
        return {"excitation": "unread", "finding": str(error)}
    modes = [
        {name: _normal(found.isel(mode=mode), name) for name in ("frequency", "damping_ratio")}
        for mode in range(found.sizes["mode"])
    ]
    return {"excitation": "broad band", "finding": found.attrs["finding"], "modes": modes}


def _sine(found, axis):
    along = found.sel(axis=axis)
    largest = along.isel(marker=int(along["amplitude"].fillna(-1.0).argmax("marker")))
    reach = student.ppf(_TAIL, PIECES - 1)
    answer, phase = (
        _quantity(largest[name].item(), reach * largest[f"{name}_error"].item(), unit)
        for name, unit in (("amplitude", "1"), ("phase", "rad"))
    )
    drive = {"value": found["drive_frequency"].item(), "unit": "Hz"}
    return {
        "excitation": "sine",
        "frequency": drive,
        "answer": answer,
        "phase": phase,
        "marker": largest["marker"].item(),
    }


def _normal(mode, name):
    reach = norm.ppf(_TAIL) * mode[f"{name}_error"].item()
    return _quantity(mode[name].item(), reach, mode[name].attrs["units"])


def _quantity(value, reach, unit):
    return {"value": value, "interval": [value - reach, value + reach], "unit": unit}


def _shown(quantity):
    """Value with its interval, both with the digits that the interval's half-width leaves certain."""
    value, (lower, upper) = quantity["value"], quantity["interval"]
    width = 0.5 * (upper - lower)
    digits = 6 if width <= 0.0 else min(max(1 - int(np.floor(np.log10(width))), 0), 6)
    return f"{value:.{digits}f} ({lower:.{digits}f} to {upper:.{digits}f})"
