"""The first page of a study: every value follows its files."""

import re
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
import xarray as xr
from page import texts

from blockshake.statistics.intervals import SURE_FROM, share_interval
from blockshake.study.comparison.paired import models_apart, theory_of
from blockshake.study.ensembles.envelope import single_figures
from blockshake.study.limit_states.section import limit_states
from blockshake.study.report.answer import answer
from blockshake.study.report.case_outcomes import evidence, most_telling, outcomes
from blockshake.study.report.content import load_content
from blockshake.study.report.open_questions import MOST, unknown
from blockshake.study.report.result_sections import joints_table
from blockshake.study.sensitivity.findings import explained_by_motion

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


def with_peaks(content, name, model, peaks):
    """The content with other peaks of the samples of a case by a model, the same at every marker [m]."""
    case = content.cases[name]
    one = case.responses[model]
    samples = one.samples.copy(deep=True)
    samples["peak"][:] = xr.DataArray(np.asarray(peaks, dtype=float), dims="sample")
    drift = one.envelope["largest_drift"].to_numpy()
    envelope = one.envelope.drop_dims(["bound", "quantile"]).merge(
        single_figures(samples, drift), compat="override"
    )
    again = replace(one, samples=samples, envelope=one.envelope.assign(envelope))
    return changed(content, name, responses={**case.responses, model: again})


def numbers(text):
    return [float(one) for one in re.findall(r"\d+(?:\.\d+)?", text)]


def found_of(content):
    return {one.name: outcomes(one) for one in content.stripes}


def apart_of(content):
    return models_apart(content.stripes, found_of(content))


def at_levels(content, levels=(3.0, 6.0)):
    """The content with the samples of the first case at levels in turn, and without its measured test."""
    case = content.cases[FIRST]

    def twice(found):
        return xr.concat([found, found], xr.Variable("level", list(levels)))

    responses = {
        model: replace(one, sensitivity=twice(one.sensitivity), indices=twice(one.indices))
        for model, one in case.responses.items()
    }
    return changed(
        content,
        FIRST,
        responses=responses,
        differences=twice(case.differences),
        levels={sample: levels[sample % len(levels)] for sample in range(10)},
        settings={**case.settings, "intensity": {"measure": "pga", "levels": levels}},
        measured=None,
        synthetic=False,
    )


def test_the_page_says_what_was_simulated_first(content):
    said = answer(content).blocks[0].text
    assert all(word in said for word in (FIRST, FOURTH, "basso-tirreno x 2", "friction", "density"))
    assert numbers(said.partition("Each model ran")[2])[:2] == [1.0, 10.0]


def test_the_headline_follows_the_models_with_most_runs(content):
    """Not the four runs of a slow model, whose limit would be 60 %, nor the one run, whose limit would be 98 %."""
    box, *_ = parts(content)
    upper = round(100.0 * share_interval(0, 10)[1])
    may, stands = box.sentence.splitlines()
    assert may.startswith(f"{FOURTH} may collapse")
    assert numbers(stands.removeprefix(FIRST))[:3] == [upper, 95.0, 10.0]
    assert "LS-DEM" in stands
    assert "NSCD rigid" in stands
    assert "elastic" not in box.sentence
    # one collapsed and one failed of six: too few for limits, told as runs
    assert "1 of 5 runs by NSCD rigid" in may
    assert f"none of 10 runs by LS-DEM (probability below {upper} %)" in may


def test_few_runs_of_every_model_tell_no_probability(content):
    few = {
        model: replace(one, samples=one.samples.isel(sample=slice(3)))
        for model, one in content.cases[FIRST].responses.items()
    }
    alone = replace(content, cases={FIRST: replace(content.cases[FIRST], responses=few)})
    box, table, _ = parts(alone)
    assert "too few for a probability" in box.sentence
    assert "%" not in box.sentence
    assert {row[3] for row in table.rows} == {"too few runs"}


def test_best_evidence_has_about_the_most_runs_and_bears_limits(content):
    assert set(evidence(found_of(content)[FIRST])) == {"ls-dem", "nscd-rigid"}
    assert set(evidence(found_of(content)[FOURTH])) == {"ls-dem"}
    few = {model: one for model, one in found_of(content)[FIRST].items() if one.counted < 6}
    assert evidence(few) == few


def test_samples_that_were_not_down_when_the_window_ended_are_said_to_fall_still(content):
    size = content.cases[FIRST].responses["nscd-rigid"].samples.sizes["sample"]
    fell = with_statuses(content, FIRST, "nscd-rigid", ["falling"] * size)
    assert f"{size} of them still falling" in parts(fell)[0].sentence
    assert any("fall as the window ends count as collapses" in line for line in unknown(fell))


def test_a_study_whose_samples_all_fall_says_so(content):
    for name, case in list(content.cases.items()):
        for model, one in case.responses.items():
            content = with_statuses(content, name, model, ["collapsed"] * one.samples.sizes["sample"])
    box, table, _ = parts(content)
    lower = round(100.0 * share_interval(10, 10)[0])
    assert box.sentence == f"Both cases collapse in every run: probability above {lower} %."
    assert table.rows[0][2] == "10 of 10"


def test_a_case_whose_samples_all_still_fall_is_open(content):
    """Later shaking may catch them."""
    for model, one in content.cases[FIRST].responses.items():
        content = with_statuses(content, FIRST, model, ["falling"] * one.samples.sizes["sample"])
    assert f"Whether {FIRST} stands is open" in parts(content)[0].sentence


def test_a_row_has_the_block_that_moves_farthest_with_median_and_all_runs(content):
    row = parts(content)[1].rows[0]
    peaks = 1e3 * content.cases[FIRST].responses["ls-dem"].samples["peak"].sel(
        frame="slab", marker="block-3-face"
    )
    assert (row[0], row[-1]) == (FIRST, "block-3")
    assert float(row[4]) == round(float(peaks.median()))
    assert numbers(row[5]) == [round(float(peaks.min())), round(float(peaks.max()))]


def test_what_is_left_is_told_of_a_block_at_rest_alone(content):
    """The made-up blocks sway until the end; one that stops a second before it has a residual."""
    stripe = content.cases[FIRST].stripes[0]
    assert np.isnan(outcomes(stripe)["ls-dem"].end)
    assert parts(content)[1].rows[0][8] == "moves"
    one = stripe.responses["ls-dem"]
    envelope = one.envelope.assign(still_moving=0.4 * (one.envelope["still_moving"] > 0.0))
    still = stripe._replace(responses={"ls-dem": replace(one, envelope=envelope)})
    residual = envelope["residual"].sel(frame="slab", quantile=0.5, marker="block-3-face")
    assert outcomes(still)["ls-dem"].end == abs(float(residual))


def test_margins_are_the_median_and_the_least_run(content):
    box, table, _ = parts(content)
    margins = 100.0 * content.cases[FIRST].responses["ls-dem"].samples["joint_margin"].min("joint")
    assert [float(cell) for cell in table.rows[0][6:8]] == [
        round(float(margins.median())),
        round(float(margins.min())),
    ]
    used = [found_of(content)[FIRST][model] for model in ("ls-dem", "nscd-rigid")]
    assert numbers(box.facts[1][1]) == sorted({round(100.0 * one.margin) for one in used})
    assert f"worst run {100.0 * min(one.least_margin for one in used):.0f} %" in box.facts[1][2]


def test_levels_are_never_pooled(content):
    """Each level has its own row, limits and displacement: nothing on the page is of both."""
    both = at_levels(content)
    peaks = 0.01 + 0.1 * (np.arange(10) % 2)
    for model in ("ls-dem", "nscd-rigid"):
        both = with_peaks(both, FIRST, model, peaks)
    fell = with_statuses(both, FIRST, "ls-dem", ["completed", "collapsed"] * 5)
    box, table, _ = parts(replace(fell, cases={FIRST: fell.cases[FIRST]}))
    rows = {row[:2]: row[2:] for row in table.rows}
    low, high = f"{FIRST} at 3 m/s²", f"{FIRST} at 6 m/s²"
    assert (rows[low, "LS-DEM"][0], rows[high, "LS-DEM"][0]) == ("0 of 5", "5 of 5")
    assert (rows[low, "NSCD rigid"][2], rows[high, "NSCD rigid"][2]) == ("10", "110")
    assert f"{high} may collapse" in box.sentence
    assert re.fullmatch(r"10 to \d+ mm at 3 m/s², \d+ to 110 mm at 6 m/s²", box.facts[0][1])
    assert not {"10", "60"} & set(
        re.findall(r"\d+", box.sentence.replace("95 %", ""))
    )  # of all runs together


def with_limits(content, model, exceeded):
    """The content with a limit state "tips" of the first case by a model: outcomes of its samples."""
    case = content.cases[FIRST]
    one = case.responses[model]
    made = xr.Dataset(
        {
            "value": (("sample", "limit"), np.array(exceeded)[:, None] + 0.0),
            "exceeded": (("sample", "limit"), np.array(exceeded)[:, None]),
        },
        {
            "sample": one.samples["sample"].values, "limit": ["tips"], "limit_value": ("limit", [np.radians(3.0)]),
            "measure": ("limit", ["tilt"]), "unit": ("limit", ["rad"]),
        },
    )  # fmt: skip
    responses = {**case.responses, model: replace(one, limits=made)}
    study = {**content.study, "limits": {"tips": {"body": "block-3", "tilt": 0.05}}}
    return replace(changed(content, FIRST, responses=responses), study=study)


def test_own_limit_states_stand_on_the_first_page_level_by_level(content):
    """Five of ten tip, all of them at the higher level, and one of these is not known."""
    limited = with_limits(content, "ls-dem", [0, 1] * 4 + [0, -1])
    (said,) = parts(limited)[2]["own-limits"]
    low, high = (round(100.0 * one) for one in share_interval(4, 9, 1))
    assert said.startswith(f"tips (tilt over 3 deg): 4 of 9 runs of {FIRST} by LS-DEM, 1 not known")
    assert said.endswith(f"probability {low} to {high} %.")
    (said,) = parts(at_levels(limited))[2]["own-limits"]
    assert f"all 4 runs of {FIRST} at 6 m/s² by LS-DEM, 1 not known" in said
    assert f"{100.0 * share_interval(4, 4, 1)[0]:.0f} to 100 %, the highest of 2" in said
    table = next(block for block in limit_states(at_levels(limited)).blocks if block.kind == "table")
    assert [row[6:8] for row in table.rows] == [("0 of 5", "0.0 %"), ("4 of 4", "100.0 %")]


def test_a_study_that_grew_says_first_why_it_stopped(content):
    said = answer(replace(content, growth="stopped at 10 samples, the largest size")).blocks[0].text
    assert said.endswith("The study stopped at 10 samples, the largest size.")


def test_models_are_held_against_each_other_by_level(content):
    """Where they differ at one level in every sample, and not at the other, the page states it."""
    both = at_levels(content)
    samples = np.arange(20)
    for model, more in (("ls-dem", 0.1), ("nscd-rigid", 0.0)):
        one = both.cases[FIRST].responses[model]
        twice = xr.concat(
            [one.samples, one.samples.assign_coords(sample=one.samples["sample"] + 10)], "sample"
        )
        both.cases[FIRST].responses[model] = replace(one, samples=twice)
        both = with_peaks(both, FIRST, model, 0.1 + more * (samples % 2 == 0))
    case = replace(both.cases[FIRST], levels={sample: (3.0, 6.0)[sample % 2] for sample in range(20)})
    alone = replace(both, cases={FIRST: case})
    apart, tried = apart_of(alone)
    (one,) = [one for one in apart if {one.near, one.far} == {"ls-dem", "nscd-rigid"}]
    assert (one.stripe, one.near, one.far) == (f"{FIRST} at 3 m/s²", "nscd-rigid", "ls-dem")
    assert (one.farther, one.pairs, one.times) == (10, 10, pytest.approx(2.0))
    assert tried == [f"{FIRST} at 3 m/s²", f"{FIRST} at 6 m/s²"]
    said = " ".join(parts(alone)[2]["models-apart"])
    assert f"{FIRST} at 3 m/s²: LS-DEM moves the blocks farther than NSCD rigid, in 10 of 10 samples" in said
    assert f"{FIRST} at 6 m/s²: no difference" in said


def test_models_differ_where_the_same_samples_do_by_more_than_chance(content):
    alike = content.cases[FIRST].responses["ls-dem"].samples["peak"].sel(frame="slab", marker="block-3-face")
    same = with_peaks(content, FIRST, "ls-dem", alike.values)
    same = with_peaks(same, FIRST, "nscd-rigid", alike.values)
    pair = {"ls-dem", "nscd-rigid"}
    assert not any({one.near, one.far} == pair for one in apart_of(same)[0])
    # a tenth of a percent in every sample is sure, and matters to nobody
    close = with_peaks(same, FIRST, "nscd-rigid", 1.03 * alike.values)
    assert not any({one.near, one.far} == pair for one in apart_of(close)[0])
    # twice as far in six of ten samples, half as far in the others: chance
    mixed = with_peaks(same, FIRST, "nscd-rigid", alike.values * np.where(np.arange(10) < 6, 2.0, 0.5))
    assert not any({one.near, one.far} == pair for one in apart_of(mixed)[0])
    twice = with_peaks(same, FIRST, "nscd-rigid", 2.0 * alike.values)
    (one,) = [one for one in apart_of(twice)[0] if {one.near, one.far} == pair]
    assert (one.far, one.farther, one.times) == ("nscd-rigid", 10, pytest.approx(2.0))
    fell = with_statuses(same, FIRST, "nscd-rigid", ["collapsed"] * 10)
    (one,) = [one for one in apart_of(fell)[0] if {one.near, one.far} == pair]
    assert (one.far, one.falls) == ("nscd-rigid", 10)


@pytest.mark.parametrize(
    ("kept", "uplift", "slip", "theory"),
    [
        ((0.95, 0.0), 0.01, 0.001, "nscd-rigid"),  # the share of one model is Housner's
        ((0.02, 0.0), 0.01, 0.001, None),  # that of both
        ((0.95, 0.3), 0.01, 0.001, None),  # that of none
        ((0.95, 0.0), 0.001, 0.01, None),  # blocks slide
    ],
)
def test_theory_bears_out_the_model_whose_impacts_are_housners(content, kept, uplift, slip, theory):
    """Shares as offsets from Housner's, of the joint on the slab; the joints above stay closed."""
    twice = with_peaks(content, FIRST, "ls-dem", 0.2 * np.ones(10))
    twice = with_peaks(twice, FIRST, "nscd-rigid", 0.1 * np.ones(10))
    (apart,) = [one for one in apart_of(twice)[0] if {one.near, one.far} == {"ls-dem", "nscd-rigid"}]
    stripe = twice.cases[FIRST].stripes[0]
    housner = theory_of(stripe, apart).housner
    # three blocks as one of 0.8 x 4.8 m: 1 - 1.5 sin(alpha)^2, less the chamfer's share
    assert housner == pytest.approx(1.0 - 1.5 * np.sin(np.arctan(0.8 / 4.8)) ** 2, abs=0.01)
    responses = {}
    for (model, one), off in zip(list(stripe.responses.items())[:2], kept, strict=True):
        joint = one.envelope["joint"]
        on_slab = joint == "slab-block-1"
        envelope = one.envelope.assign(
            joint_spin_kept=(on_slab * (housner - off)).broadcast_like(one.envelope["joint_spin_kept"]),
            joint_uplift=(on_slab * uplift).broadcast_like(one.envelope["joint_uplift"]),
            joint_slip=(on_slab * slip).broadcast_like(one.envelope["joint_slip"]),
        )
        responses[model] = replace(one, envelope=envelope)
    told = theory_of(stripe._replace(responses=responses), apart)
    assert (told.borne_out, told.rocks, told.as_one) == (theory, uplift > slip, True)


def test_a_stack_that_opens_in_several_joints_is_no_body_of_theory(content):
    twice = with_peaks(content, FIRST, "ls-dem", 0.2 * np.ones(10))
    twice = with_peaks(twice, FIRST, "nscd-rigid", 0.1 * np.ones(10))
    (apart,) = [one for one in apart_of(twice)[0] if {one.near, one.far} == {"ls-dem", "nscd-rigid"}]
    told = theory_of(twice.cases[FIRST].stripes[0], apart)
    assert (told.as_one, told.borne_out) == (False, None)
    assert "until a measured test does" in " ".join(parts(twice)[2]["models-apart"])


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
    assert said.startswith(f"{FIRST}: 3 of 10 runs by LS-DEM, at most 12 blows")
    assert "0.40 m/s (a and c)" in said


def test_a_case_in_which_most_samples_stand_is_shown(content):
    found = found_of(content)
    assert most_telling(found) == FIRST
    fallen = {model: one._replace(collapsed=one.counted) for model, one in found[FIRST].items()}
    assert most_telling({**found, FIRST: fallen}) == FOURTH


def test_record_and_level_explain_what_they_make(content):
    """For demands that are a product of a record's and a level's factor, all; of others little."""
    samples = np.arange(32)
    levels = {int(sample): (3.0, 6.0)[sample % 2] for sample in samples}
    record = (samples // 2) % 8
    made = 0.01 * (1.0 + record) * np.where(samples % 2, 4.0, 1.0)
    noise = np.exp(np.random.default_rng(1).normal(size=32))
    shares = []
    for demand in (made, 0.01 * noise):
        cloud = xr.Dataset(
            {"demand": ("sample", demand), "largest_drift": ("sample", np.full(32, 0.4))},
            {"sample": samples, "record": ("sample", [f"r{one}" for one in record])},
        )
        response = replace(content.cases[FIRST].responses["ls-dem"], cloud=cloud)
        shares += [
            explained_by_motion(replace(content.cases[FIRST], levels=levels, responses={"a": response}))["a"]
        ]
    assert shares[0] == pytest.approx(1.0)
    assert shares[1] < 0.5


def test_a_bracket_of_one_step_without_falls_is_no_half_of_the_samples_and_no_fall(content):
    one = content.fragility[FIRST].copy(deep=True)
    for name, value in (("dispersion", 0.0), ("capacity_lower", 1.0), ("capacity_upper", 1.25)):
        one[name].values[...] = value
    said = next(text for text in texts(answer(replace(content, fragility={FIRST: one}))) if "ladder" in text)
    assert said == (
        f"{FIRST}: all samples reach a potential collapse between 1 and 1.25 times the motion. It is no fall but a "
        "displacement of more than 400 mm. The ladder climbs in steps of 0.25."
    )


def test_the_measured_peak_stands_with_the_models_that_it_is_like(content):
    said = next(one for one in parts(content)[2]["beside"] if one.startswith(FIRST))
    peak = 1e3 * float(content.cases[FIRST].measured["peak"].sel(frame="slab", marker="block-3-face"))
    assert f"block-3 moves by {peak:.0f} mm in the virtual test (synthetic)" in said
    assert "like a run by LS-DEM" in said


def test_without_a_measured_test_nothing_is_said_of_one(content):
    for name in content.cases:
        content = changed(content, name, measured=None, synthetic=False)
    _, _, named = parts(content)
    assert "irtual test" not in " ".join(named["beside"])
    assert f"{FIRST} and {FOURTH} have no measured test" in named["not-known"][0]


def test_a_potential_collapse_is_told_with_its_limit_and_its_step(content):
    (said,) = [one for one in parts(content)[2]["beside"] if "potential collapse" in one]
    median = float(content.fragility[FIRST]["median"])
    assert {400.0, float(f"{median:.2g}"), 0.25} <= set(numbers(said))


def test_next_steps_follow_the_results(content):
    steps = parts(content)[2]["next"]
    assert "until the strong motion ends, 3 s" in steps[0]
    # 0.975 to the power of 1/72: Clopper and Pearson's upper limit without an event
    assert 1.0 - 0.025 ** (1.0 / 72.0) < 0.05 < 1.0 - 0.025 ** (1.0 / 71.0)
    assert any(step.startswith("Run 72 samples") and "now 31 % (10 runs" in step for step in steps)
    assert len(steps) <= MOST


def test_a_case_that_still_moves_is_to_be_simulated_for_longer(content):
    for motion in content.motions.values():
        motion.attrs["significant_end"] = 1.0
    assert parts(content)[2]["next"][0].startswith(f"Simulate {FIRST} and {FOURTH} for longer (key duration)")


def test_more_samples_of_a_case_whose_samples_do_not_differ_are_not_advised(content):
    for motion in content.motions.values():
        motion.attrs["significant_end"] = 1.0
    for name, case in list(content.cases.items()):
        for model, one in case.responses.items():
            size = one.samples.sizes["sample"]
            content = with_peaks(content, name, model, 0.1 + 0.9e-5 * np.arange(size))
    assert content.cases[FIRST].marker_noise == 1e-4
    assert not any("72 samples" in step for step in parts(content)[2]["next"])


def with_all_peaks(content, peak):
    """The content with a peak of every sample of each case, and none collapsed [m]."""
    for name, case in list(content.cases.items()):
        for model, one in case.responses.items():
            size = one.samples.sizes["sample"]
            content = with_statuses(content, name, model, ["completed"] * size)
            content = with_peaks(content, name, model, np.full(size, peak))
    return content


def test_runs_that_no_variable_changes_are_said_to_bear_no_more_than_one(content):
    words = "no variable of this study changes the motion"
    assert not any(words in one for one in unknown(content))
    assert any(words in one and FIRST in one for one in unknown(with_all_peaks(content, 0.1)))


def test_blocks_that_do_not_move_prefer_no_model(content):
    assert parts(with_all_peaks(content, 1e-4))[2]["models-apart"] == ["No block moves by any model."]
    (alike,) = parts(with_all_peaks(content, 0.1))[2]["models-apart"][-1:]
    assert alike.startswith(
        "No model moves the blocks farther than another, or collapses more often, in more samples than by chance. Use"
    )


def test_models_of_one_median_whose_runs_scatter_more_by_one_are_not_called_alike(content):
    """Half of the samples go farther by either model."""
    content = with_all_peaks(content, 0.1)
    (model, one), *_ = [
        (model, one)
        for model, one in content.cases[FIRST].responses.items()
        if one.samples.sizes["sample"] >= SURE_FROM
    ]
    size = one.samples.sizes["sample"]
    scattered = np.where(np.arange(size) % 2 == 0, 0.06, 0.14)
    (said,) = parts(with_peaks(content, FIRST, model, scattered))[2]["models-apart"]
    assert f"in {FIRST} 60 to 140 mm against 100 to 100 mm" in said


def test_a_case_that_moves_farther_than_the_one_shown_stands_next_to_it(content):
    shown = most_telling(found_of(content))
    assert ", in " not in parts(content)[0].facts[0][2]
    other = FIRST if shown == FOURTH else FOURTH
    for model in evidence(found_of(content)[other]):
        size = content.cases[other].responses[model].samples.sizes["sample"]
        content = with_peaks(content, other, model, np.full(size, 3.0))
    assert most_telling(found_of(content)) == shown
    assert f"in {other} 3000 mm" in parts(content)[0].facts[0][2]


def test_gaps_beyond_the_first_page_are_told_all_the_same(content):
    gaps = unknown(content)
    for words in (
        "not calibrated: configuration-4",
        "configuration-4 by NSCD rigid (1 of 6)",
        "needs 59 samples",
    ):
        assert any(words in one for one in gaps), words
    assert any("without a marker" in one and "4 of configuration-4" in one for one in gaps)


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


def test_joints_of_a_case_have_a_row_a_model_and_a_cell_a_figure(content):
    (table,) = joints_table(content.cases[FIRST].stripes[0])
    assert list(dict.fromkeys(row[0] for row in table.rows)) == [
        "block-2-block-3", "block-1-block-2", "slab-block-1",
    ]  # fmt: skip
    row = next(row for row in table.rows if row[:2] == ("slab-block-1", "LS-DEM"))
    one = content.cases[FIRST].responses["ls-dem"].envelope.sel(quantile=0.95, joint="slab-block-1")
    wanted = 1e-3 * one["joint_compression"], 1e3 * one["joint_uplift"], 1e3 * one["joint_slip"]
    assert [float(cell) for cell in row[2:]] == pytest.approx(
        [float(value) for value in wanted], rel=2e-3, abs=0.05
    )


def test_joints_that_do_not_move_are_told_as_zero(content):
    stripe = content.cases[FIRST].stripes[0]
    one = stripe.responses["ls-dem"]
    envelope = one.envelope.assign(joint_slip=0.0 * one.envelope["joint_slip"] + 5e-10)
    (table,) = joints_table(stripe._replace(responses={"ls-dem": replace(one, envelope=envelope)}))
    assert {row[-1] for row in table.rows} == {"0"}
