import numpy as np
from known_motion import STRUCTURE, TIME, base_motion, bump, moved_run, seen

from blockshake.measurement.motion.body_frame import without_outliers


def test_a_lone_wrong_reading_becomes_a_gap_and_no_other_does():
    base = base_motion()
    test = seen(moved_run(base, rocking=[0.0, bump(TIME, 2.0, 0.5, 0.01)]))
    own = [m.name for m in STRUCTURE.file.markers if m.body == "block-2"]
    assert len(own) >= 3  # one of two cannot be distinguished from the other
    marker = own[0]
    wrong = test.copy(deep=True)
    wrong["marker_displacement"].loc[{"marker": marker}][300] += 2e-3
    cleaned = without_outliers(wrong, STRUCTURE)
    lost = np.isnan(cleaned["marker_displacement"]).any("axis")
    assert bool(lost.sel(marker=marker)[300])
    # six robust standard deviations leave few good readings out
    assert float(lost.mean()) < 2e-3


def test_an_impact_of_a_whole_body_is_kept():
    base = base_motion()
    test = seen(moved_run(base))
    moved = test.copy(deep=True)
    own = [m.name for m in STRUCTURE.file.markers if m.body == "block-1"]
    moved["marker_displacement"].loc[{"marker": own}] += 2e-3 * (test["time"] > 1.0)
    before = np.isnan(without_outliers(test, STRUCTURE)["marker_displacement"]).sum()
    after = np.isnan(without_outliers(moved, STRUCTURE)["marker_displacement"]).sum()
    assert int(after) == int(before)
