"""Conclusions of a study: every sentence follows its files."""

from dataclasses import replace

import pytest

from blockshake.study.report.conclusions import conclusions
from blockshake.study.report.content import load_content
from blockshake.study.report.joint_blocks import joint_blocks

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


def test_peak_of_the_top_block_is_told_by_what_ten_samples_bear(content):
    """The median with its limits and the largest sample; no quantile of 95 %, whose limits ten samples do not hold."""
    drift = told(content)[f"found-{FIRST}"][0]
    response = content.cases[FIRST].responses["ls-dem"]
    peak = response.envelope.sel(frame="slab", quantile=0.5, marker="block-3-face")
    low, high = (1e3 * float(peak["peak_interval"].sel(bound=one)) for one in ("lower", "upper"))
    largest = 1e3 * float(response.samples["peak"].sel(frame="slab", marker="block-3-face").max())
    words = f"median {1e3 * float(peak['peak']):.1f} mm [{low:.1f}, {high:.1f}], largest {largest:.1f} mm by LS-DEM"
    assert f"{words} (n = 10)" in drift
    assert "95 % of all" not in drift
    assert "No sample moves it by more than 400.0 mm." in drift
    # five samples bear not even limits of a median
    of_five = told(content)[f"found-{FOURTH}"][0].partition("; ")[2]
    assert "largest" in of_five.partition("(n = 5)")[0]
    assert "median" not in of_five
    assert any("fewer than 59 samples bear no limits" in one for one in told(content)["not-known"])


def with_statuses(content, name, model, statuses):
    """The content with other ends of the samples of a case by a model."""
    case = content.cases[name]
    one = case.responses[model]
    samples = one.samples.copy(deep=True)
    samples["status"].values[:] = statuses
    return changed(content, name, responses={**case.responses, model: replace(one, samples=samples)})


def test_samples_that_still_fall_are_told_from_those_that_are_down(content):
    falling = with_statuses(content, FIRST, "ls-dem", ["falling"] * 3 + ["completed"] * 7)
    words = told(falling)[f"found-{FIRST}"][1]
    assert "Counted as collapsed, but still falling when the window ended: 3 of 10 by LS-DEM." in words
    assert "still falling" not in told(content)[f"found-{FIRST}"][1]


def test_a_window_that_ends_in_the_strong_motion_is_told(content):
    settings = {**content.cases[FIRST].settings, "duration": 1.0}
    lines = told(changed(content, FIRST, settings=settings))["not-known"]
    (line,) = [one for one in lines if "ends in the strong motion" in one]
    assert f"{FIRST} (1 s of a motion that is strong until" in line


def test_collapse_is_found_where_a_sample_collapsed(content):
    found = told(content)
    assert found[f"found-{FIRST}"][1].startswith("No sample collapses. Probability")
    # one of five and one failed: Clopper and Pearson's lower limit of 1 of 6, upper one of 2 of 6
    assert "20.0 % [0.4, 77.7] by NSCD rigid (n = 5)" in found[f"found-{FOURTH}"][1]
    assert any(
        "would have moved, peaks are lower limits: NSCD rigid, configuration-4" in one
        for one in found["not-known"]
    )


def test_the_joint_that_opens_most_is_that_of_the_files(content):
    words = told(content)[f"found-{FIRST}"][2]
    case = content.cases[FIRST]
    most = max(
        (float(one.envelope["joint_uplift"].sel(quantile=0.5).max()), model)
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
