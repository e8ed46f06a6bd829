"""Rows of a cause on tests that it was not found in, at its frozen size."""

from typing import NamedTuple

import numpy as np

from blockshake.diagnosis.outside.push import start_of_push
from blockshake.diagnosis.outside.registry import FORMS
from blockshake.effects.registry import EFFECTS


class CauseRows(NamedTuple):
    """Rows by test, (n_rows,) each, and whether the cause says anything of the tests to come."""

    rows: list
    says: bool


def cause_rows(cause, opened, sealed, likelihood):
    """`CauseRows` of a cause on open and sealed tests.

    Parameters
    ----------
    cause : Cause
    opened, sealed : list of JointRows
    likelihood : Likelihood
        Of all of these, by which the start of a push in a sealed test is found.
    """
    tests = [*opened, *sealed]
    amplitudes = np.array(cause.amplitudes)
    if not cause.outside:
        effect = EFFECTS[cause.name]
        if effect.columns is None or not len(amplitudes):
            return CauseRows([np.zeros(len(test.rows.value)) for test in tests], False)
        return CauseRows(
            [effect.rows_of(test.seen, cause.place, cause.when) @ amplitudes for test in tests], True
        )
    form = FORMS[cause.name]
    if form.rows is None or not form.lasts(cause.when):
        return CauseRows([np.zeros(len(test.rows.value)) for test in tests], False)
    size, when = float(amplitudes[0]), cause.when
    if "starts" in when:
        starts = dict(when["starts"])
        for number, test in enumerate(sealed, start=len(opened)):
            own = slice(likelihood.ends[number], likelihood.ends[number + 1])

            def left(rows, number=number, own=own):
                return float(
                    ((likelihood.value[own] - likelihood.whiten_one(number, rows[:, None])[:, 0]) ** 2).sum()
                )

            starts[test.seen.name] = start_of_push(cause.place, size, test, left)
        when = {**when, "starts": starts}
    return CauseRows([size * form.rows(test, cause.place, when) for test in tests], True)
