"""Two axes of a marker are exchanged."""

from blockshake.parity.kinds.kind import Kind

ORDERS = {"x and y": [1, 0, 2], "x and z": [2, 1, 0], "y and z": [0, 2, 1]}


def _correct(test, findings, structure):
    for finding in findings:
        marker, axes = finding.where
        values = test["marker_displacement"].loc[{"marker": marker}].to_numpy()
        test["marker_displacement"].loc[{"marker": marker}] = values[:, ORDERS[axes]].copy()


AXES = Kind("axes", "channel-swap", "reading along an axis = truth along another one", _correct)
