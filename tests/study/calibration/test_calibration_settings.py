"""Settings of the joint calibration: ranges, and the one line that states what is wrong in a configuration."""

import re
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from blockshake.errors import InputError
from blockshake.files import PACKAGE, load_yaml
from blockshake.study.calibration.answers import LEVEL
from blockshake.study.calibration.settings import (
    FEWEST,
    FRICTION_OF_STEEL,
    OTHERS,
    CalibrationSettings,
    Range,
)
from blockshake.study.config import check_config, load_config
from blockshake.study.sampling.distributions import TABLE_2

ROOT = PACKAGE.parents[1]


@pytest.mark.parametrize(("scale", "middle"), [("linear", 5.05), ("log", 1.0)])
def test_values_and_shares_are_each_others_inverse(scale, middle):
    span = Range(lowest=0.1, highest=10.0, scale=scale)
    assert_allclose(span.value([0.0, 0.5, 1.0]), [0.1, middle, 10.0])
    shares = np.linspace(0.0, 1.0, 7)
    assert_allclose(span.share(span.value(shares)), shares, atol=1e-12)
    assert_allclose(span.share(span.stratum_medians(4)), [0.125, 0.375, 0.625, 0.875])


def test_a_range_that_is_given_takes_the_place_of_the_usual_one():
    given = Range(lowest=0.3, highest=0.4)
    found = CalibrationSettings(cases={"ls-dem": ("one",)}, ranges={"restitution": given}).ranges_of(TABLE_2)
    assert found["restitution"] == given
    assert found["friction.concrete.steel"] == FRICTION_OF_STEEL
    assert set(found) == {*(name for name in TABLE_2 if name.startswith("friction.")), *OTHERS}


def test_one_parameter_is_the_search_of_the_paper(monkeypatch):
    """Zhou et al. (2023): one friction of all concrete, from 0.3 to 0.8."""
    monkeypatch.chdir(ROOT)
    found = load_config("config/paper.yaml").calibration
    assert found.ranges_of(TABLE_2) == {"friction.concrete.concrete": Range(lowest=0.3, highest=0.8)}
    assert found.linked == {"friction.concrete.foundation": "friction.concrete.concrete"}


@pytest.mark.parametrize(("tests", "chosen"), [(None, ["weak", "strong"]), (("strong", "other"), ["strong"])])
def test_the_tests_that_are_named_are_simulated(tests, chosen):
    settings = CalibrationSettings(cases={"ls-dem": ("one",)}, tests=tests)
    assert settings.chosen(SimpleNamespace(open={"weak": None, "strong": None})) == chosen


def test_a_linked_friction_is_not_calibrated_by_itself():
    linked = {"friction.concrete.foundation": "friction.concrete.concrete"}
    found = CalibrationSettings(cases={"ls-dem": ("one",)}, linked=linked).ranges_of(TABLE_2)
    assert set(found) == {"friction.concrete.concrete", "friction.concrete.steel", *OTHERS}


def test_the_fewest_samples_are_those_with_which_a_range_has_an_end():
    """The quantile of n excesses at the level is the ceil(level (n + 1))-th of them."""
    assert np.ceil(LEVEL * (FEWEST + 1) - 1e-9) == FEWEST
    assert np.ceil(LEVEL * FEWEST) > FEWEST - 1


@pytest.mark.parametrize(
    ("calibration", "line"),
    [
        (
            {"cases": {"ls-dem": ["configuration-7"]}},
            "calibration.cases.ls-dem: expected cases with a measured test: configuration-1",
        ),
        (
            {
                "cases": {"ls-dem": ["configuration-1"]},
                "ranges": {"density": {"lowest": 1.0, "highest": 2.0}},
            },
            "calibration.ranges.density: expected one of friction.concrete.concrete, ",
        ),
        (
            {"cases": {"ls-dem": ["configuration-1"]}, "ranges": {"hollow": {"lowest": 2.0, "highest": 1.0}}},
            "calibration.ranges.hollow: expected `highest` above `lowest`",
        ),
    ],
)
def test_a_calibration_names_models_measured_cases_and_parameters(calibration, line, monkeypatch):
    monkeypatch.chdir(ROOT)  # a configuration names files from the project's root
    mapping = load_yaml("config/study.yaml")
    mapping["calibration"] = calibration
    with pytest.raises(InputError, match=re.escape(line)):
        check_config(mapping, "study.yaml")
