"""Names of two sensors, axes of a marker or the sign of a reading are exchanged."""

from blockshake.parity.kinds.kind import Kind, readings_of

ORDERS = {"x and y": [1, 0, 2], "x and z": [2, 1, 0], "y and z": [0, 2, 1]}


def _swap_back(test, findings, structure):
    for finding in findings:
        (variable, this), (_, other) = (readings_of(test, sensor) for sensor in finding.where)
        first = test[variable].loc[this].to_numpy().copy()
        test[variable].loc[this] = test[variable].loc[other].to_numpy()
        test[variable].loc[other] = first


SWAP = Kind("swap", "channel-swap", "reading = truth of another sensor", _swap_back)


def _reorder(test, findings, structure):
    for finding in findings:
        marker, axes = finding.where
        values = test["marker_displacement"].loc[{"marker": marker}].to_numpy()
        test["marker_displacement"].loc[{"marker": marker}] = values[:, ORDERS[axes]].copy()


AXES = Kind("axes", "channel-swap", "reading along an axis = truth along another one", _reorder)


def _reverse(test, findings, structure):
    for finding in findings:
        variable, selection = readings_of(test, finding.where[0])
        if variable == "marker_displacement":
            selection = selection | {"axis": finding.where[1]}
        test[variable].loc[selection] = -test[variable].loc[selection]


POLARITY = Kind("polarity", "channel-swap", "reading = -truth", _reverse)
