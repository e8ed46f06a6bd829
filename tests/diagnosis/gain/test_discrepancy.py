"""The discrepancy without a name: what was missed under the same motion, in proportion to its strength."""

import numpy as np
from judged_tests import CELLS, TIME, judged

from blockshake.diagnosis.gain.campaign_gain import members_with_discrepancy

SHAPE = np.sin(5.0 * TIME)[:, None] * np.ones(len(CELLS))
MEMBERS = np.random.default_rng(0).normal(0.0, 0.1, (20, len(TIME), len(CELLS)))
PEAKS = {"weak": 1.0, "strong": 2.0, "other": 2.0, "sealed": 3.0}
MEAN = MEMBERS.mean(axis=0)


def _opened(names):
    return [judged(name, MEAN + PEAKS[name] * SHAPE, {"nominal": MEMBERS}) for name in names]


def _carried(opened, motions):
    sealed = judged("sealed", 0.0 * SHAPE, {"nominal": MEMBERS})
    return members_with_discrepancy(sealed, opened, motions, PEAKS) - MEMBERS


def test_what_two_tests_missed_alike_is_missed_again():
    found = _carried(_opened(["weak", "strong"]), dict.fromkeys(PEAKS, "a"))
    np.testing.assert_allclose(found, np.broadcast_to(3.0 * SHAPE, found.shape), atol=1e-12)


def test_of_another_motion_nothing_is_known_but_how_much_is_missed():
    motions = {"weak": "a", "strong": "b", "sealed": "c"}
    found = _carried(_opened(["weak", "strong"]), motions)
    np.testing.assert_allclose(found.mean(axis=0), 0.0, atol=1e-12)
    # strata of the normal law: their root mean square is a little less than one
    size = 3.0 * np.sqrt((SHAPE**2).mean())
    np.testing.assert_allclose(found.std(axis=0), size, rtol=0.1)


def test_beyond_the_horizon_of_an_open_test_nothing_is_carried_on():
    opened = [judged("weak", MEAN + SHAPE, {"nominal": MEMBERS}, np.full(len(CELLS), 1.0))]
    found = _carried(opened, dict.fromkeys(PEAKS, "a")).mean(axis=0)
    np.testing.assert_allclose(found[TIME <= 1.0], 3.0 * SHAPE[TIME <= 1.0], atol=1e-12)
    np.testing.assert_allclose(found[TIME > 1.0], 0.0, atol=1e-12)
