"""Gain on laws, on ensembles with known answers."""

import numpy as np
import pytest
import xarray as xr

from blockshake.diagnosis.gain.law_gain import law_contrast, law_gain

LAW, SPREAD = "joint1.lever.bias", 3e-3  # m: more than the least spread of the table


def runs(centre, seed, count=40):
    values = centre + SPREAD * np.random.default_rng(seed).normal(size=(count, 1))
    return xr.Dataset({"law_value": (("run", "law"), values)}, {"law": [LAW]})


def reading(value):
    return xr.Dataset(
        {"law_value": ("law", [value]), "law_error": ("law", [0.0])},
        {"law": [LAW]},
    )


def sealed(measured, extended):
    ensembles = {"nominal": 0.0, "recalibrated": 0.0, "extended": extended}
    return {
        "sealed": (
            reading(measured),
            {
                kind: {model: runs(centre, 7 + place) for place, model in enumerate(("one", "other"))}
                for kind, centre in ensembles.items()
            },
        )
    }


def test_a_model_that_has_the_cause_gains_all():
    """Ten standard deviations off before, none after: (100 - 0) / (100 - 1)."""
    found = law_gain(sealed(10.0 * SPREAD, 10.0 * SPREAD), [LAW])
    contrast = law_contrast(found)
    assert contrast.estimate == pytest.approx(1.0, abs=0.03)
    assert contrast.lower > 0.9
    assert found["law_distance"].sel(law_kind="nominal").item() == pytest.approx(10.0, rel=0.15)


def test_half_of_the_way_gains_three_quarters():
    """Distances of 10 and 5: (100 - 25) / (100 - 1)."""
    assert law_contrast(law_gain(sealed(10.0 * SPREAD, 5.0 * SPREAD), [LAW])).estimate == pytest.approx(
        75.0 / 99.0, abs=0.05
    )


def test_a_wrong_cause_loses():
    assert law_contrast(law_gain(sealed(10.0 * SPREAD, -10.0 * SPREAD), [LAW])).estimate == -1.0


def test_nothing_is_to_gain_where_the_sealed_test_keeps_the_law():
    assert law_contrast(law_gain(sealed(0.5 * SPREAD, 10.0 * SPREAD), [LAW])) is None


def test_laws_that_no_sealed_test_tells_are_left_out():
    found = law_gain(sealed(np.nan, 0.0), [LAW, "table.pitch"])
    assert found.sizes["law_cell"] == 0
    assert law_contrast(found) is None
