"""The first page of a study: every sentence follows its files."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from page import texts

from blockshake.statistics.intervals import share_interval
from blockshake.study.report.answer import answer
from blockshake.study.report.case_outcomes import models_apart, most_telling, outcomes, shares_at_impacts
from blockshake.study.report.content import load_content
from blockshake.study.report.open_questions import MOST, next_steps, unknown
from blockshake.study.report.result_sections import joints_table

FIRST, FOURTH = "configuration-1", "configuration-4"


@pytest.fixture
def content(fake):
    return load_content(fake.study, fake.results)


def parts(content):
    """Box, table of the cases, and sentences under each heading by its key."""
    blocks = answer(content).blocks
    (box,) = [block for block in blocks if block.kind == "box"]
    (table,) = [block for block in blocks if block.kind == "table"]
    named = {one.key: list(items.items) for one, items in pairwise(blocks) if one.kind == "heading"}
    return box, table, named


def changed(content, name, **parts):
    """The content with parts of a case replaced."""
    return replace(content, cases={**content.cases, name: replace(content.cases[name], **parts)})


def with_statuses(content, name, model, statuses):
    """The content with other ends of the samples of a case by a model."""
    case = content.cases[name]
    one = case.responses[model]
    samples = one.samples.copy(deep=True)
    samples["status"].values[:] = statuses
    return changed(content, name, responses={**case.responses, model: replace(one, samples=samples)})


def test_the_page_says_what_was_asked_first(content):
    asked = answer(content).blocks[0].text
    assert asked.startswith("Asked: configuration-1 and configuration-4 under basso-tirreno x 2 (2.47 m/s")
    assert "2 s, by 4 models, 1 to 10 samples each" in asked
    assert "Uncertain: friction, density, Young's modulus and viscous modulus." in asked


def test_what_stands_and_what_may_collapse_is_that_of_the_samples(content):
    box, *_ = parts(content)
    stands, may = box.sentence.split(". configuration-4 may collapse")
    assert stands.startswith(f"{FIRST} stands: none of 28 runs")
    upper = 100.0 * share_interval(0, 4)[1]  # of the model with the fewest samples
    assert (
        f"none of 28 runs by 4 models collapses; as few as 4 runs of a case by a model leave a probability of a "
        f"collapse of up to {upper:.0f} %" in stands
    )
    # one collapsed and one failed of six
    assert may == ": in 1 of 5 runs by NSCD rigid, in none by the others."
    lower, upper = (100.0 * one for one in share_interval(1, 5, 1))
    assert box.facts[2][1:] == (
        "1 of 5",
        f"{FOURTH} by NSCD rigid: probability {lower:.0f} to {upper:.0f} %, 95 % limits",
    )


def test_samples_that_were_not_down_when_the_window_ended_are_said_to_fall_still(content):
    one = content.cases[FIRST].responses["nscd-rigid"]
    size = one.samples.sizes["sample"]
    fell = with_statuses(content, FIRST, "nscd-rigid", ["falling"] * size)
    _, table, _ = parts(fell)
    cell = next(cell for cell in table.rows[0][1:] if "collapse" in cell and "still falling" in cell)
    assert cell.startswith(f"all {size} samples collapse ({size} still falling): ")
    assert any(line.startswith("Whether samples that fall as the window ends") for line in unknown(fell))


def test_a_study_whose_samples_all_fall_says_so(content):
    for name, case in list(content.cases.items()):
        for model, one in case.responses.items():
            content = with_statuses(content, name, model, ["collapsed"] * one.samples.sizes["sample"])
    box, table, _ = parts(content)
    assert box.sentence == "Both cases collapse: so do all 48 runs by 4 models."
    assert table.rows[0][1].startswith("all 10 samples collapse: ")


def test_a_case_whose_samples_all_still_fall_is_open(content):
    """Later shaking may catch them."""
    for model, one in content.cases[FIRST].responses.items():
        content = with_statuses(content, FIRST, model, ["falling"] * one.samples.sizes["sample"])
    told = f"Whether {FIRST} stands is not told: all 28 runs by 4 models still fall as the window ends."
    assert parts(content)[0].sentence.endswith(told)


def test_samples_that_still_fall_count_as_collapsed(content):
    falling = with_statuses(content, FIRST, "ls-dem", ["falling"] * 3 + ["completed"] * 7)
    assert outcomes(falling.cases[FIRST])["ls-dem"].collapsed == 3
    assert "3 of 10 runs by LS-DEM" in parts(falling)[0].sentence


def test_the_block_that_moves_farthest_is_told_relative_to_the_slab(content):
    """By the median of the samples, and by the smallest and the largest of them."""
    row = parts(content)[1].rows[0]
    response = content.cases[FIRST].responses["ls-dem"]
    peaks = 1e3 * response.samples["peak"].sel(frame="slab", marker="block-3-face")
    assert row[:2] == (
        f"{FIRST}, block-3",
        f"stands; {float(peaks.median()):.0f} mm ({float(peaks.min()):.0f} to {float(peaks.max()):.0f}); "
        "collapse below 31 %",
    )


def test_cases_of_one_structure_are_told_apart_by_their_motion(content):
    """And a block that is the farthest by one model alone is named beside its figure."""
    case = content.cases[FIRST]
    lower = case.responses["ls-dem"].envelope.copy(deep=True)
    lower["peak"].loc[{"marker": "block-2-face"}] *= 9.0
    responses = {**case.responses, "ls-dem": replace(case.responses["ls-dem"], envelope=lower)}
    row = parts(changed(content, FIRST, responses=responses, settings={**case.settings, "scale": 1.0}))[
        1
    ].rows[0]
    assert row[0].startswith(f"{FIRST}, basso-tirreno x 1 (1.23 m/s")
    assert row[1].startswith("stands; block-2 ")
    assert row[2].startswith("stands; block-3 ")


def test_what_is_left_is_told_of_a_block_at_rest_alone(content):
    """The made-up blocks sway until the end; one that stops a second before it has a residual."""
    case = content.cases[FIRST]
    assert np.isnan(outcomes(case)["ls-dem"].end)
    one = case.responses["ls-dem"]
    envelope = one.envelope.assign(still_moving=0.4 * (one.envelope["still_moving"] > 0.0))
    still = replace(case, responses={"ls-dem": replace(one, envelope=envelope)})
    residual = envelope["residual"].sel(frame="slab", quantile=0.5, marker="block-3-face")
    assert outcomes(still)["ls-dem"].end == abs(float(residual))


def test_a_case_that_still_moves_is_to_be_simulated_for_longer(content):
    for motion in content.motions.values():
        motion.attrs["significant_end"] = 1.0
    steps = parts(content)[2]["next"]
    assert steps[0].startswith("Simulate configuration-1 and configuration-4 for longer (key duration)")


def test_the_least_margin_is_that_of_the_weakest_joint(content):
    box, *_ = parts(content)
    label, value, note = box.facts[1]
    margins = [
        float(one.envelope["joint_margin"].sel(quantile=0.5).min())
        for one in content.cases[FIRST].responses.values()
    ]
    assert label == "Least margin against overturning"
    assert value == f"{100.0 * min(margins):.0f} to {100.0 * max(margins):.0f} %"
    assert note.startswith("above slab-block-1; configuration-1; ")


def test_blows_are_told_by_case_and_model(content):
    assert "blows" not in parts(content)[2]  # of one leaf that nothing strikes
    case = content.cases[FIRST]
    one = case.responses["ls-dem"]
    made = {
        "blows": [3, 12, 1] + 7 * [0],
        "blow_velocity": [0.2, 0.3, 0.4] + 7 * [0.0],
        "blow_pair": ["a and b", "a and b", "a and c"] + 7 * [""],
    }
    struck = replace(one, samples=one.samples.assign({name: ("sample", made[name]) for name in made}))
    (said,) = parts(changed(content, FIRST, responses={**case.responses, "ls-dem": struck}))[2]["blows"]
    assert said.startswith(
        f"{FIRST}: in 3 of 10 samples by LS-DEM, at most 12 blows in one, the fastest at 0.40 m/s (a and c); none by "
        "the others."
    )
    assert said.endswith("which no model has.")


def test_a_case_in_which_most_samples_stand_is_shown(content):
    found = {name: outcomes(case) for name, case in content.cases.items()}
    assert most_telling(found) == FIRST
    fallen = {model: one._replace(collapsed=one.counted) for model, one in found[FIRST].items()}
    assert most_telling({**found, FIRST: fallen}) == FOURTH


def test_models_differ_by_collapses_and_by_medians_beyond_their_limits(content):
    case = content.cases[FIRST]
    found = outcomes(case)
    assert not any({"ls-dem", "nscd-rigid"} == {one.near, one.far} for one in models_apart(case, found))
    one = case.responses["ls-dem"]
    envelope = one.envelope.copy(deep=True)
    for name in ("peak", "peak_interval"):
        envelope[name] += 1.0
    moved = replace(case, responses={**case.responses, "ls-dem": replace(one, envelope=envelope)})
    apart = [
        one for one in models_apart(moved, outcomes(moved)) if {one.near, one.far} == {"ls-dem", "nscd-rigid"}
    ]
    assert [(one.near, one.far, one.falls) for one in apart] == [("nscd-rigid", "ls-dem", 0.0)]
    fell = {**found, "ls-dem": found["ls-dem"]._replace(collapsed=5)}
    assert max(models_apart(case, fell))[:1] == (0.5,)
    assert max(models_apart(case, fell)).far == "ls-dem"


@pytest.mark.parametrize(
    ("kept", "words"),
    [
        (0.95, "Impacts explain a larger motion by NSCD rigid, which loses less."),
        (0.2, "Impacts do not explain it: NSCD rigid loses more."),
        (0.78, "Impacts do not tell the models apart."),
    ],
)
def test_why_models_differ_follows_the_spin_that_impacts_keep(content, kept, words):
    case = content.cases[FOURTH]
    one = case.responses["nscd-rigid"]
    envelope = one.envelope.copy(deep=True)
    envelope["joint_spin_kept"][:] = kept
    responses = {**case.responses, "nscd-rigid": replace(one, envelope=envelope)}
    said = parts(changed(content, FOURTH, responses=responses))[2]["beside"][0]
    assert said.startswith(f"In {FOURTH} NSCD rigid collapses more often than NSCD elastic. At ")
    assert f"and {kept:.2f} by NSCD rigid; all above it" in said
    assert words in said
    assert "The largest slip, median of the samples, is " in said
    joint, (own, *_) = shares_at_impacts(case, ("nscd-elastic", "nscd-rigid"))
    assert (
        f"At {joint}, the joint that opens most, impacts keep {own:.2f} of the spin by NSCD elastic" in said
    )


def test_models_that_do_not_differ_are_said_not_to(content):
    study = {**content.study, "models": {"ls-dem": {}, "nscd-rigid": {}}}
    case = content.cases[FIRST]
    responses = {model: case.responses[model] for model in study["models"]}
    alone = replace(content, study=study, cases={FIRST: replace(case, responses=responses)})
    assert parts(alone)[2]["beside"][0] == "The models do not differ beyond the limits of their samples."


def test_measured_peak_stands_beside_the_models_that_it_is_like(content):
    said = parts(content)[2]["beside"][1]
    peak = 1e3 * float(content.cases[FIRST].measured["peak"].sel(frame="slab", marker="block-3-face"))
    assert said.startswith(f"Virtual test (synthetic): {FIRST}, block-3 moves by {peak:.0f} mm, like LS-DEM")


def test_without_a_measured_test_nothing_is_said_of_one(content):
    for name in content.cases:
        content = changed(content, name, measured=None, synthetic=False)
    _, _, named = parts(content)
    assert "irtual test" not in " ".join(named["beside"])
    assert f"real blocks: {FIRST} and {FOURTH} (no measured test)" in named["not-known"][0]


def test_next_steps_follow_the_results(content):
    steps = parts(content)[2]["next"]
    assert steps[0].startswith(
        "Simulate configuration-1 and configuration-4 until the strong motion ends: 3 s"
    )
    assert steps[1].startswith("Let a block rock and measure the spin that impacts keep: 0.")
    # 0.975 to the power of 1/72: Clopper and Pearson's upper limit without an event
    assert 1.0 - 0.025 ** (1.0 / 72.0) < 0.05 < 1.0 - 0.025 ** (1.0 / 71.0)
    assert steps[2].startswith("Run 72 samples a model")
    assert len(steps) <= MOST


def test_more_samples_of_a_case_whose_samples_do_not_differ_are_not_advised(content):
    found = {name: outcomes(case) for name, case in content.cases.items()}
    alike = {
        name: {model: one._replace(least=one.most - 0.9e-4) for model, one in ended.items()}
        for name, ended in found.items()
    }
    assert content.cases[FIRST].marker_noise == 1e-4
    assert any(step.startswith("Run 72 samples") for step in next_steps(content, found))
    # one sample by elastic NSCD says nothing of what others would do
    assert "now 98 % (1 sample)" in next(one for one in next_steps(content, alike) if "72 samples" in one)
    del alike[FOURTH]["nscd-elastic"]
    assert not any("72 samples" in step for step in next_steps(content, alike))


def test_gaps_beyond_the_first_page_are_told_all_the_same(content):
    gaps = unknown(content)
    assert any("which is assumed and not calibrated: configuration-4." in one for one in gaps)
    assert any("peaks are lower limits: configuration-4 by NSCD rigid (" in one for one in gaps)
    assert any("fewer than 59 samples bear no limits" in one for one in gaps)
    assert any(one == "How far blocks without a marker move: 4 of configuration-4." for one in gaps)


def test_a_window_that_ends_after_the_strong_motion_leaves_nothing_open(content):
    for motion in content.motions.values():
        motion.attrs["significant_end"] = 1.0
    assert not any("ends in the strong motion" in one for one in unknown(content))
    assert not any("until the strong motion ends" in one for one in parts(content)[2]["next"])


def test_a_study_without_any_result_says_so(content):
    for name, case in list(content.cases.items()):
        for model, one in case.responses.items():
            empty = replace(one, envelope=one.envelope.assign_attrs(counted=0))
            content.cases[name].responses[model] = empty
    assert list(texts(answer(content)))[-1] == "No sample of any case has a result."


def test_joints_of_a_case_are_a_row_each(content):
    (table,) = joints_table(content.cases[FIRST])
    assert [row[0] for row in table.rows] == ["block-2-block-3", "block-1-block-2", "slab-block-1"]
    one = content.cases[FIRST].responses["ls-dem"].envelope.sel(quantile=0.95, joint="slab-block-1")
    shown = table.rows[-1][1].split(" / ")
    wanted = 1e-3 * one["joint_compression"], 1e3 * one["joint_uplift"], 1e3 * one["joint_slip"]
    assert [float(part) for part in shown] == pytest.approx([float(value) for value in wanted], rel=5e-3)
