"""Restarts at the turning points of known rocking, and every quarter second where nothing turns."""

import numpy as np
import xarray as xr

from blockshake.diagnosis.restart_instants import restart_instants

TIME = np.arange(1601) / 200.0
LENGTH = 0.4


def _histories(begin, end, rest_from=8.0):
    """Rocking at 2 Hz from ``begin`` to ``end``, whole cycles; the base moves until ``rest_from``."""
    inside = (begin <= TIME) & (end >= TIME)
    rocking = np.where(inside, 0.01 * np.sin(4.0 * np.pi * (TIME - begin)), 0.0)
    rotation = np.zeros((len(TIME), 2, 3))
    rotation[:, 1, 1] = rocking
    rotation += np.random.default_rng(1).normal(0.0, 1e-4, rotation.shape)
    return xr.Dataset(
        {
            "rotation": (("time", "joint", "axis"), rotation),
            "rotation_noise": (("joint", "axis"), np.full((2, 3), 1e-4)),
            "acceleration": ("time", np.where(rest_from > TIME, np.cos(40.0 * TIME), 0.0)),
        },
        {"time": TIME, "axis": ["x", "y", "z"]},
    )


def test_rocking_restarts_where_it_turns():
    found = TIME[restart_instants(_histories(1.0, 4.0, rest_from=4.0), LENGTH)]
    turns = 1.0 + 0.125 + 0.25 * np.arange(12)
    own = found[(found > 1.05) & (found < 4.0)]
    assert len(own) == len(turns)
    np.testing.assert_allclose(own, turns, atol=0.015)


def test_quiet_stretches_restart_every_quarter_second_and_end_before_the_test():
    found = TIME[restart_instants(_histories(20.0, 21.0, rest_from=4.0), LENGTH)]
    np.testing.assert_allclose(np.diff(found), 0.25)
    # from the first quarter second to where the base rests
    assert found[0] == 0.25
    assert found[-1] == 3.75
    assert TIME[restart_instants(_histories(20.0, 21.0), LENGTH)].max() <= 8.0 - LENGTH


def test_of_many_as_many_as_can_be_paid_for_are_kept():
    found = restart_instants(_histories(0.5, 7.5), LENGTH)
    assert len(found) == 18
    assert np.diff(found).min() > 0
