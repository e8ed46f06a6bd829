import numpy as np
import pytest
from known_motion import SENSORS, STRUCTURE, TIME, base_motion, bump, moved_run, seen

from blockshake.diagnosis.features.reading import read_off
from blockshake.diagnosis.misfit.curve_scores import curve_scores, joint_curves, members_crps
from blockshake.study.ensembles.scores import crps


def test_members_crps_is_crps_against_the_others():
    members = np.random.default_rng(0).normal(size=(12, 30))
    members[3] = members[5]
    expected = [crps(np.delete(members, member, axis=0), members[member]) for member in range(12)]
    np.testing.assert_allclose(members_crps(members), expected, atol=1e-12)


def test_scores_of_a_member_are_within_the_reference():
    generator = np.random.default_rng(1)
    curves = generator.normal(size=(60, 5)) @ np.array([np.sin(k * TIME) for k in range(1, 6)])
    result = curve_scores({"a": curves[0], "far": curves[0] + 20.0}, {"a": curves[1:], "far": curves[1:]})
    assert result["crps_reference"].sel(curve="a", quantile=0.05) < result["crps"].sel(curve="a") < 2.0
    assert float(result["coverage"].sel(curve="far")) == 0.0
    assert float(result["coverage_reference"].sel(curve="far", quantile=0.05)) > 0.0
    assert result["crps"].sel(curve="far") > result["crps_reference"].sel(curve="far", quantile=0.95)
    band = curves[1:].max(axis=0) - curves[1:].min(axis=0)
    assert float(result["sharpness"].sel(curve="a")) == pytest.approx(band.mean() / np.abs(curves[0]).max())


def test_curves_of_joints_have_names():
    base = base_motion()
    test = seen(moved_run(base, rocking=[0.0, bump(TIME, 2.0, 0.5, 0.01)]))
    curves = joint_curves(read_off(test, STRUCTURE, SENSORS), "t1")
    assert sorted(curves) == sorted(
        f"t1.joint{j}.{name}" for j in (1, 2, 3) for name in ("slip", "rotation", "opening")
    )
    assert curves["t1.joint2.rotation"].max() == pytest.approx(
        0.01, abs=3e-4
    )  # three standard deviations of its noise
