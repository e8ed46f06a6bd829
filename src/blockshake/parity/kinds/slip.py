"""An end of a displacement transducer slips once: reading = truth + s after a time t0 of one test."""

from blockshake.parity.kinds.kind import Column, Kind, readings_of


def _correct(test, findings, structure):
    for finding in findings:
        variable, selection = readings_of(test, *finding.where)
        size, time = finding.estimate
        test[variable].loc[selection] -= size * (test["time_acc"].to_numpy() > time)


SLIP = Kind("slip", "sensor-drift", "reading = truth + s H(t - t0)", _correct, units=("m", "m"))
# m, of a hook or a bracket that beds in; what a slip leaves is a step, whose time is searched
OF_END = Column(SLIP, 1, 5e-4, lambda held: held.left[:, None] * 0.0, by_test=True)
