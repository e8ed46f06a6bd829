"""The names of two sensors are exchanged."""

from blockshake.parity.kinds.kind import Kind, readings_of


def _correct(test, findings, structure):
    for finding in findings:
        (variable, one), (_, other) = (readings_of(test, sensor) for sensor in finding.where)
        first = test[variable].loc[one].to_numpy().copy()
        test[variable].loc[one] = test[variable].loc[other].to_numpy()
        test[variable].loc[other] = first


SWAP = Kind("swap", "channel-swap", "reading = truth of another sensor", _correct)
