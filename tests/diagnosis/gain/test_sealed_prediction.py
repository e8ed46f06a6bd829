import numpy as np
import xarray as xr

from blockshake.diagnosis.gain.sealed_prediction import family, tamed_test

FEATURES = ["joint1.pivot+", "joint2.pivot+", "base.yaw.acceleration", "top.period", "onset.time"]


def runs(values):
    return xr.Dataset({"value": (("run", "feature"), values)}, {"feature": FEATURES})


def test_test_and_ensembles_are_on_the_nominal_scale_of_both_solvers():
    generator = np.random.default_rng(0)
    nominal = {model: runs(generator.normal(3.0, 0.5, (200, 5))) for model in ("ls-dem", "nscd-rigid")}
    extended = {model: runs(generator.normal(4.0, 0.5, (50, 5))) for model in nominal}
    measured = runs(np.full((1, 5), 3.5)).isel(run=0)
    test = tamed_test("a", measured, {"nominal": nominal, "extended": extended})
    pooled = np.concatenate(list(test.members["nominal"].values()))
    np.testing.assert_allclose(pooled.mean(axis=0), 0.0, atol=1e-12)
    np.testing.assert_allclose(pooled.std(axis=0, ddof=1), 1.0, rtol=1e-12)
    # features without a logarithmic scale: half a unit is one spread, within 4 standard errors of 400 draws
    plain = [test.features.index(name) for name in ("joint1.pivot+", "joint2.pivot+", "top.period")]
    np.testing.assert_allclose(test.measured[plain], 1.0, atol=4.0 / np.sqrt(400))
    shifted = np.concatenate(list(test.members["extended"].values())).mean(axis=0)
    np.testing.assert_allclose(shifted[plain], 2.0, atol=4.0 * (1.0 / np.sqrt(100) + 2.0 / np.sqrt(400)))
    assert list(test.members["extended"]) == ["ls-dem", "nscd-rigid"]


def test_families_are_where_a_feature_is_read():
    assert [family(name) for name in FEATURES] == ["joint1", "joint2", "base", "top", "top"]
