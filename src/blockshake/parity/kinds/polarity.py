"""A sensor reads with the wrong sign: reading = -truth."""

from blockshake.parity.kinds.kind import Kind, readings_of


def _correct(test, findings, structure):
    for finding in findings:
        variable, own = readings_of(test, finding.where[0])
        if variable == "marker_displacement":
            own = own | {"axis": finding.where[1]}
        test[variable].loc[own] = -test[variable].loc[own]


POLARITY = Kind("polarity", "channel-swap", "reading = -truth", _correct)
