"""Section on the fragility: figures of the files, in words."""

from dataclasses import replace

import numpy as np
import pytest

from blockshake.study.fragility.section import fragility, words
from blockshake.study.report.content import load_content

CASE = "configuration-1"


@pytest.fixture(scope="module")
def content(fake):
    return load_content(fake.study, fake.results)


def with_fragility(content, **variables):
    """The content with values of its fragility replaced."""
    one = content.fragility[CASE].copy(deep=True)
    for name, values in variables.items():
        one[name].values[...] = values
    return replace(content, fragility={CASE: one})


def test_median_is_told_as_a_factor_and_as_an_acceleration(content):
    one, peak = content.fragility[CASE], content.motions["basso-tirreno"].attrs["peak_acceleration"]
    told = words(content, CASE)
    assert f"half of the samples reach a potential collapse below {float(one['median']):.2f} [" in told
    assert f"({float(one['median']) * peak:.2f} m/s" in told
    assert "The last run of 1 sample ended for a numerical reason." in told
    # whose it is
    assert "5 samples by NSCD rigid: half of the samples" in told


def test_samples_that_still_fall_are_told(content):
    falling = with_fragility(content, status="falling")
    assert "5 samples still fell when the window ended, which counts as a fall." in words(falling, CASE)


def test_samples_that_all_pass_tell_no_fragility(content):
    silent = with_fragility(content, median=np.nan, capacity_lower=1.75)
    assert "all pass the highest factor that was climbed, 1.75, so that there is no fragility" in words(
        silent, CASE
    )
    none = with_fragility(content, median=np.nan, capacity_lower=0.0)
    assert "none passes the lowest factor, 0.5" in words(none, CASE)


def test_capacities_between_the_same_levels_are_told_by_these_alone(content):
    same = with_fragility(content, dispersion=0.0, capacity_lower=1.0, capacity_upper=1.25)
    told = words(same, CASE)
    assert "all samples reach a potential collapse between 1 and 1.25 times the motion" in told
    assert "half of the samples" not in told


@pytest.mark.parametrize(
    ("status", "kinds"),
    [
        (
            ["completed"] * 5,
            "None fell: every potential collapse is a displacement of more than the limit, 400 mm.",
        ),
        (
            ["collapsed", "falling", *["completed"] * 3],
            "are 2 falls and 2 displacements of more than the limit, 400",
        ),
        (["collapsed"] * 5, "The potential collapses are 4 falls."),
    ],
)
def test_falls_and_displacements_are_told_apart_with_limit_and_step(status, kinds, content):
    """Four of the five samples reach a potential collapse; the last passes all that is known."""
    told = words(with_fragility(content, status=status), CASE)
    assert kinds in told
    assert "The ladder climbs in steps of 0.25." in told


def test_a_dispersion_that_the_levels_hide_is_said(content):
    assert "differ by less than the levels are apart" in words(with_fragility(content, dispersion=0.01), CASE)
    assert "differ by less" not in words(with_fragility(content, dispersion=0.4), CASE)


def test_a_study_without_it_has_no_section(content):
    assert fragility(replace(content, fragility={})) is None
