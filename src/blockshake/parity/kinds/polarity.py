"""A sensor reads with the wrong sign: reading = -truth."""

from blockshake.parity.kinds.kind import Kind, readings_of


def _correct(test, findings, structure):
    for finding in findings:
        variable, selection = readings_of(test, finding.where[0])
        if variable == "marker_displacement":
            selection = selection | {"axis": finding.where[1]}
        test[variable].loc[selection] = -test[variable].loc[selection]


POLARITY = Kind("polarity", "channel-swap", "reading = -truth", _correct)
