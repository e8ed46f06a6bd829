"""Measured drops and tosses of others: the answers stay those of docs/results/measured.md."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from blockshake.measurement.campaigns.campaign import load_campaign
from blockshake_flight.decide import decide_flights
from blockshake_flight.tracked_test import load_tracked

ROOT = Path(__file__).parents[2]
MEASURED = Path(os.environ.get("BLOCKSHAKE_SHARED") or ROOT.parent / "shared") / "measured"


def decided(name, folder):
    """Decision on the open half of a published set."""
    if not (MEASURED / name).is_dir():
        pytest.skip(f"the measured {name} are not part of the project: no {MEASURED / name}")
    program = ROOT / "examples" / "measured_flights.py"
    subprocess.run([sys.executable, program, name, MEASURED / name, folder], check=True)
    campaign = load_campaign(folder)
    return decide_flights(load_tracked(campaign, list(campaign.open))).decision


def test_a_tossed_cube_has_its_mass_centre_beside_the_middle_and_short_lengths(tmp_path):
    decision = decided("cube-tosses", tmp_path / "tosses")
    assert decision.decision == "combination"
    found = {cause.name: cause.parameters for cause in decision.causes}
    assert set(found) == {"sensor-gain", "eccentricity"}
    offset = [found["eccentricity"][f"offset_{axis}"].estimate for axis in "xyz"]
    assert np.linalg.norm(offset) == pytest.approx(5.6e-3, abs=1e-3)
    assert offset[2] > 5e-3
    # the cube rests at 0.978 of its half-width: another witness of the lengths
    assert found["sensor-gain"]["error"].estimate == pytest.approx(-0.02, abs=5e-3)


@pytest.mark.slow
def test_dropped_squares_are_slowed_by_something_outside_of_the_registry(tmp_path):
    decision = decided("square-drops", tmp_path / "drops")
    assert decision.decision == "unknown"
    first = decision.parts[0].causes[0]
    assert first.name == "drag"
    # read by hand: the vertical acceleration follows the velocity with 0.5 to 0.7 1/s
    assert 0.5 < first.parameters["rate"].estimate < 0.75
