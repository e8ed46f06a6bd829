"""The runs behind the convergence of LS-DEM in docs/method.md, made by bench/convergence.py."""

import numpy as np
import pytest
from convergence import HEADER, convergence_rows
from shaken_stack import shaken_stack

from blockshake.geometry.structure import load_structure
from blockshake.solvers.ls_dem.parameters import LsDemParameters


def test_order_in_the_time_step_is_two_where_nothing_opens():
    """A stack that is shaken too weakly to rock sways as a linear chain: its error goes with the step squared."""
    stack, parameters = load_structure("configuration-1"), LsDemParameters()
    found = {}
    for step in (1e-5, 5e-5, 1e-4):
        found[step] = shaken_stack(stack, parameters, step, 0.2, 20.0, 0.1)
    errors = [found[step]["energy_residual"] for step in (5e-5, 1e-4)]
    assert np.log2(errors[1] / errors[0]) == pytest.approx(2.0, abs=0.1)
    # what the finest run is off by itself takes 1 from each square: (100 - 1) / (25 - 1)
    off = [found[step]["peak_drift"] - found[1e-5]["peak_drift"] for step in (5e-5, 1e-4)]
    assert off[1] / off[0] == pytest.approx(99.0 / 24.0, rel=0.05)


def test_stack_that_falls_has_a_sink_and_nothing_else():
    read = shaken_stack(load_structure("configuration-1"), LsDemParameters(), 1e-4, 6.0, 0.8, 3.0)
    assert read.pop("sink") > 0.0
    assert np.isnan(list(read.values())).all()


def test_a_row_for_every_setting_with_the_default_marked_once_and_the_floor_last():
    settings = {"time_step": (1e-5, 2e-5), "node_spacing": (0.2, 0.4), "grid_spacing": (0.0, 0.1)}
    rows = convergence_rows(settings, {"acceleration": 2.5, "frequency": 5.0, "duration": 0.1})
    assert {len(row) for row in rows} == {len(HEADER)}
    assert [row[:2] for row in rows] == [
        ("time step", "10 \u00b5s *"), ("time step", "20 \u00b5s"), ("node spacing", "200 mm *"),
        ("node spacing", "400 mm"), ("grid spacing", "exact *"), ("grid spacing", "100 mm"), ("floor", ""),
    ]  # fmt: skip
    assert len({row[2:] for row in rows if row[1].endswith("*")}) == 1
    # shaking and a kick that are larger by 1e-6 move no block at rest
    assert rows[-1][2] == "0"
