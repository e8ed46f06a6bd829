"""The names of two sensors are exchanged."""

from blockshake.parity.kinds.kind import Kind, readings_of


def _correct(test, findings, structure):
    for finding in findings:
        (variable, this), (_, other) = (readings_of(test, sensor) for sensor in finding.where)
        first = test[variable].loc[this].to_numpy().copy()
        test[variable].loc[this] = test[variable].loc[other].to_numpy()
        test[variable].loc[other] = first


SWAP = Kind("swap", "channel-swap", "reading = truth of another sensor", _correct)
