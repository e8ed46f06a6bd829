"""Conclusions of a study: every sentence follows its files."""

from dataclasses import replace

import pytest

from blockshake.report.study.conclusions import conclusions
from blockshake.report.study.content import load_content
from blockshake.report.study.joint_blocks import joint_blocks

FIRST, FOURTH = "configuration-1", "configuration-4"


@pytest.fixture(scope="module")
def content(fake):
    return load_content(fake.study, fake.results, fake.logs)


def told(content):
    """Sentences under each heading, by its key."""
    blocks = conclusions(content)
    return {heading.key: list(items.items) for heading, items in zip(blocks[::2], blocks[1::2], strict=True)}


def changed(content, name, **parts):
    """The content with parts of a case replaced."""
    return replace(content, cases={**content.cases, name: replace(content.cases[name], **parts)})


def test_peak_is_the_upper_quantile_of_the_top_block(content):
    drift = told(content)[f"found-{FIRST}"][0]
    peak = (
        content.cases[FIRST]
        .responses["ls-dem"]
        .envelope.sel(frame="slab", quantile=0.95, marker="block-3-face")
    )
    low, high = (1e3 * float(peak["peak_interval"].sel(bound=one)) for one in ("lower", "upper"))
    assert f"{1e3 * float(peak['peak']):.1f} mm by LS-DEM [{low:.1f}, {high:.1f}] (n = 10)" in drift
    assert "No sample moves it by more than 400.0 mm." in drift


def test_collapse_is_found_where_a_sample_collapsed(content):
    found = told(content)
    assert found[f"found-{FIRST}"][1].startswith("No sample collapses. Probability")
    # one of five: Clopper and Pearson's limits
    assert "20.0 % [0.5, 71.6] by NSCD rigid (n = 5)" in found[f"found-{FOURTH}"][1]
    assert any("peaks are lower limits: NSCD rigid, configuration-4" in one for one in found["not-known"])


def test_the_joint_that_opens_most_is_that_of_the_files(content):
    words = told(content)[f"found-{FIRST}"][2]
    case = content.cases[FIRST]
    most = max(
        (float(one.envelope["joint_uplift"].sel(quantile=0.95).max()), model)
        for model, one in case.responses.items()
    )
    assert f"The largest opening is that of block-2-block-3, {1e3 * most[0]:.1f} mm" in words
    assert "slab-block-1" in words.partition("slip")[2]


def test_models_that_differ_by_more_than_their_limits_are_named(content):
    case = content.cases[FIRST]
    assert "the limits of every two of them overlap" in " ".join(told(content)[f"found-{FIRST}"])
    one = case.responses["ls-dem"]
    envelope = one.envelope.copy(deep=True)
    for name in ("peak", "peak_interval"):
        envelope[name] += 1.0
    responses = {**case.responses, "ls-dem": replace(one, envelope=envelope)}
    words = " ".join(told(changed(content, FIRST, responses=responses))[f"found-{FIRST}"])
    assert "do not overlap: LS-DEM and NSCD rigid. The choice of the model matters here." in words


def test_without_a_measured_test_nothing_is_said_of_one(content):
    other = told(changed(content, FIRST, measured=None, synthetic=False))
    assert "virtual test" not in " ".join(other[f"found-{FIRST}"])
    assert f"{FIRST} (no measured test); {FOURTH} (synthetic tests)" in other["not-known"][0]


def test_assumed_friction_is_told_where_none_is_calibrated(content):
    assert any(one.endswith(f"not calibrated: {FOURTH}.") for one in told(content)["not-known"])


def test_joints_of_a_case_are_a_figure_and_a_row_each(content):
    figure, table = joint_blocks(content.cases[FIRST])
    assert [row[0] for row in table.rows] == ["block-2-block-3", "block-1-block-2", "slab-block-1"]
    one = content.cases[FIRST].responses["ls-dem"].envelope.sel(quantile=0.95, joint="slab-block-1")
    shown = table.rows[-1][1].split(" / ")
    wanted = 1e-3 * one["joint_compression"], 1e3 * one["joint_uplift"], 1e3 * one["joint_slip"]
    assert [float(part) for part in shown] == pytest.approx([float(value) for value in wanted], rel=5e-3)
    assert "<svg" in figure.svg
