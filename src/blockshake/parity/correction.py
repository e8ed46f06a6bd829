"""Readings without the faults that were found."""

import numpy as np
import xarray as xr

from blockshake.geometry.rotations import rotation_matrices
from blockshake.measurement.campaigns.campaign import load_test
from blockshake.measurement.campaigns.command_clock import simulation_start, since
from blockshake.measurement.motion.body_frame import see_from_body
from blockshake.measurement.motion.fall import find_fall, until_fall

_REST = 0.1  # s, whose mean is an accelerometer's reading at rest
_ORDERS = {"x and y": [1, 0, 2], "x and z": [2, 1, 0], "y and z": [0, 2, 1]}


def load_corrected_test(campaign, name, structure, findings):
    """Load a test of a campaign as of `judged_readings`, until a block falls."""
    test = load_test(campaign, name, structure)
    test = until_fall(test, find_fall(test, structure, campaign.sensors))
    return judged_readings(test, name, structure, findings)


def judged_readings(test, name, structure, findings):
    """A test without the faults that were found, its times from `simulation_start` on.

    Times count as those of the tests that are simulated beside it; what was read before is left out.
    """
    test = corrected(test, name, structure, findings)
    return since(test, simulation_start(test["time"].to_numpy()))


def corrected(test, name, structure, findings):
    """Take the findings out of one test's readings.

    Parameters
    ----------
    test : xarray.Dataset
        As read.
    name : str
        Of the test: findings of other tests do not touch it.
    structure : Structure
    findings : iterable of Finding

    Returns
    -------
    xarray.Dataset
        The test without these faults. The optical clock stays: the accelerometers' times are moved onto it.

    Notes
    -----
    A marker at a wrong place is moved to where it is said to be, which needs its body's rotation: where fewer than
    three markers are read, its reading becomes a gap. An end of a displacement transducer at a wrong place stays: its
    reading is right, of other points than the structure says.
    """
    test = test.transpose("time", "marker", "axis", ...).copy(deep=True)
    own = [finding for finding in findings if name in finding.tests and finding.quantity != "range"]
    order = (
        "swap",
        "axes",
        "polarity",
        "slip",
        "drift",
        "gain",
        "place",
        "reference place",
        "lag",
        "skew",
    )
    for finding in sorted(own, key=lambda finding: order.index(finding.quantity)):
        if "place" in finding.quantity:
            continue
        _TAKE[finding.quantity](test, finding)
    places = {finding.where[0]: finding.estimate for finding in own if finding.quantity == "place"}
    _take_places(test, structure, places)
    return test


def _column(test, where):
    """Variable and selection of a marker, channel or displacement transducer."""
    if "transducer" in test.coords and where in test["transducer"].values:
        return "transducer_displacement", {"transducer": where}
    if "channel" in test.coords and where in test["channel"].values:
        return "accelerometer", {"channel": where}
    return "marker_displacement", {"marker": where}


def _take_swap(test, finding):
    (variable, one), (_, other) = (_column(test, where) for where in finding.where)
    first = test[variable].loc[one].to_numpy().copy()
    test[variable].loc[one] = test[variable].loc[other].to_numpy()
    test[variable].loc[other] = first


def _take_axes(test, finding):
    place = {"marker": finding.where[0]}
    values = test["marker_displacement"].loc[place].to_numpy()
    test["marker_displacement"].loc[place] = values[:, _ORDERS[finding.where[1]]].copy()


def _take_polarity(test, finding):
    variable, place = _column(test, finding.where[0])
    if variable == "marker_displacement":
        place = place | {"axis": finding.where[1]}
    test[variable].loc[place] = -test[variable].loc[place]


def _take_slip(test, finding):
    variable, place = _column(test, finding.where[0])
    size, time = finding.estimate
    test[variable].loc[place] -= size * (test["time_acc"].to_numpy() > time)


def _take_drift(test, finding):
    if len(finding.estimate) == 1:
        time = test["time_acc"].to_numpy()
        test["accelerometer"].loc[{"channel": finding.where[0]}] -= finding.estimate[0] * (time - time[0])
        return
    time = test["time"].to_numpy()
    change = (time - time[0])[:, None] * finding.estimate
    if finding.where == ("optical frame",):
        test["marker_displacement"] -= xr.DataArray(change, dims=("time", "axis"))
    else:
        test["marker_displacement"].loc[{"marker": finding.where[0]}] -= change


def _take_gain(test, finding):
    variable, place = _column(test, finding.where[0])
    if len(finding.estimate) == 3:
        factor = xr.DataArray(1.0 + finding.estimate, dims="axis")
        own = {"marker": test["marker"].isin(finding.where)}
        test["marker_displacement"].loc[own] = test["marker_displacement"].loc[own] / factor
        return
    values = test[variable].loc[place]
    rest = 0.0
    if variable == "accelerometer":
        time = test["time_acc"]
        rest = float(values.where(time <= time[0] + _REST).mean())
    test[variable].loc[place] = rest + (values - rest) / (1.0 + finding.estimate[0])


def _take_lag(test, finding):
    if "time_acc" in test.coords:
        test.coords["time_acc"] = test["time_acc"] + finding.estimate[0]


def _take_skew(test, finding):
    if "time_acc" in test.coords:
        time = test["time"].to_numpy()
        late = test["time_acc"] - 0.5 * (time[0] + time[-1])
        test.coords["time_acc"] = test["time_acc"] + finding.estimate[0] * late


_TAKE = {
    "swap": _take_swap,
    "axes": _take_axes,
    "polarity": _take_polarity,
    "slip": _take_slip,
    "drift": _take_drift,
    "gain": _take_gain,
    "lag": _take_lag,
    "skew": _take_skew,
}


def _take_places(test, structure, offsets):
    """Move markers to where the structure has them."""
    read = [str(marker) for marker in test["marker"].values]
    for index, body in enumerate(structure.body_names):
        own = [m for m in structure.file.markers if m.body == body and m.name in read]
        if not any(marker.name in offsets for marker in own):
            continue
        names = [marker.name for marker in own]
        start = rotation_matrices(structure.orientation[index])
        points = np.array([marker.position for marker in own], dtype=float)
        points += np.array([offsets.get(name, np.zeros(3)) for name in names])
        values = test["marker_displacement"].sel(marker=names).to_numpy()
        places = structure.position[index] + points @ start.T
        rotation = see_from_body(points, places + values, structure.position[index], start).rotation
        for name in names:
            if name in offsets:
                test["marker_displacement"].loc[{"marker": name}] -= (rotation - start) @ offsets[name]
