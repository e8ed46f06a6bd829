import copy
from dataclasses import replace

import numpy as np
import pytest

from blockshake.study.sampling.distributions import Lognormal
from blockshake.study.statements import inputs, models, responses
from blockshake.study.statements.statement import PaperVerdict

MET, NOT_MET, UNJUDGED = PaperVerdict.MET, PaperVerdict.NOT_MET, PaperVerdict.UNJUDGED
FIRST, FOURTH = "configuration-1", "configuration-4"


def test_table_2_and_its_samples(content):
    found = inputs.table_2(content)
    assert found.verdict == MET
    assert "Other than in the table: none" in found.words
    other = {**content.distributions, "friction.concrete.concrete": Lognormal(mean=0.6, cov=0.1)}
    found = inputs.table_2(replace(content, distributions=other))
    assert found.verdict == NOT_MET
    assert "table: friction, concrete on concrete." in found.words
    assert "off by 24.9 %" in found.words


def test_correlation_is_held_against_pairs_at_random(content):
    for error, verdict in ((0.02, MET), (0.05, NOT_MET)):  # a tenth of 1/3 for ten samples
        content.design_summary["rms_correlation_error"] = error
        found = inputs.correlation_control(content)
        assert found.verdict == verdict
        assert "0.33" in found.words


def test_number_of_samples(content, monkeypatch):
    assert inputs.size(content).verdict == NOT_MET
    assert "6 of configuration-4 by NSCD rigid" in inputs.size(content).words
    monkeypatch.setattr(inputs, "SIZE", 10)
    content.cases.pop(FOURTH)
    assert inputs.size(content).verdict == MET


def test_variability_is_that_of_the_median_peak(content, monkeypatch):
    assert "has 10 samples, not 50" in inputs.low_variability(content).words
    monkeypatch.setattr(inputs, "SIZE", 10)
    for half, verdict in ((0.05, MET), (0.2, UNJUDGED), (np.nan, UNJUDGED)):
        for case in content.cases.values():
            for one in case.responses.values():
                peak = one.envelope["peak"]
                one.envelope["peak_interval"].loc[{"bound": "lower"}] = (1.0 - half) * peak
                one.envelope["peak_interval"].loc[{"bound": "upper"}] = (1.0 + half) * peak
        found = inputs.low_variability(content)
        assert found.verdict == verdict
        assert np.isnan(half) or f"configuration-1, LS-DEM {100 * half:.1f} %" in found.words
        assert "not judged: configuration-4, NSCD rigid 5." in found.words


def search(content, synthetic=0, answer=None, **changes):
    """The content with another calibration of the friction of concrete, on real tests."""
    found = copy.deepcopy(content.calibration)
    one = found["parameters"]["friction.concrete.concrete"] = {
        **found["parameters"]["friction.concrete.concrete"], **changes
    }  # fmt: skip
    one["answers"]["all"] |= answer or {}
    for test in found["tests"]:
        test["synthetic"] = synthetic
    return replace(content, calibration=found)


def test_range_of_the_friction_search(content):
    found = inputs.friction_range(content)
    assert found.verdict == MET
    assert "all open tests by LS-DEM and NSCD rigid" in found.words
    assert inputs.friction_range(search(content, lowest=0.3, highest=0.8)).verdict == MET
    assert inputs.friction_range(search(content, lowest=0.4)).verdict == NOT_MET
    assert inputs.friction_range(search(content, highest=0.7)).verdict == NOT_MET
    assert inputs.friction_range(replace(content, calibration=None)).verdict == UNJUDGED


def test_optimum_of_the_friction_search(content):
    found = inputs.optimum(content)
    assert found.verdict == UNJUDGED
    assert "synthetic" in found.words
    bounded = {"told": True, "lower": 0.4, "upper": 0.9, "assumed_is_refused": False}
    assert inputs.optimum(search(content, answer=bounded)).verdict == MET
    assert inputs.optimum(search(content, answer=bounded, synthetic=1)).verdict == UNJUDGED
    assert inputs.optimum(search(content, answer={**bounded, "upper": None})).verdict == UNJUDGED
    refused = {**bounded, "upper": 0.6, "assumed_is_refused": True}
    assert inputs.optimum(search(content, answer=refused)).verdict == NOT_MET
    assert "a mean of 0.6" in inputs.optimum(search(content, assumed=0.6)).words
    found = search(content)
    del found.calibration["parameters"]["friction.concrete.concrete"]
    assert inputs.optimum(found).verdict == UNJUDGED


def calibrated(content, table):
    """The content with other stiffness of the samples."""
    return replace(content, calibrated=(replace(content.calibrated[0], stiffness=table),))


def test_stiffness_that_is_one_number_times_the_modulus_follows_it(content):
    modulus = content.design["materials.concrete.youngs_modulus"]
    table = content.calibrated[0].stiffness.copy()
    assert inputs.follow_moduli(content).verdict == MET  # made up without regard to the modulus
    table["ls_dem.normal_stiffness"], table["ls_dem.shear_stiffness"] = 0.5 * modulus, 0.25 * modulus
    found = inputs.follow_moduli(calibrated(content, table))
    assert found.verdict == NOT_MET
    assert "k_n / E 0.5000 per m" in found.words
    assert "k_s / G 0.6000 per m" in found.words  # G is E / 2.4
    assert "correlation 1.0000" in found.words
    none = content.design.drop(columns="materials.concrete.youngs_modulus")
    assert inputs.follow_moduli(replace(content, design=none)).verdict == UNJUDGED


def test_stiffness_of_heavier_blocks(content):
    modulus, density = (
        content.design[f"materials.concrete.{name}"] for name in ("youngs_modulus", "density")
    )
    for factor, verdict in ((0.5, NOT_MET), (density / 2400.0, MET), (2400.0 / density, NOT_MET)):
        table = content.calibrated[0].stiffness.assign(**{"ls_dem.normal_stiffness": factor * modulus})
        assert inputs.heavier_blocks(calibrated(content, table)).verdict == verdict


def test_restitution_is_not_calibrated(content):
    found = inputs.restitution(content)
    assert found.verdict == UNJUDGED
    case = content.cases[FIRST]
    content.cases[FIRST] = replace(case, structure=case.structure.with_parameters({"restitution": 0.3}))
    assert inputs.restitution(content).verdict == NOT_MET


def thicken(content, model, tops):
    """Give the blocks of the cases spreads that grow upward to these at the top [m]."""
    for name, top in tops.items():
        case = content.cases[name]
        height = {marker.name: case.structure.position[case.structure.body_names.index(marker.body), 2]
                  for marker in case.structure.file.markers}  # fmt: skip
        spread = case.responses[model].sensitivity["spread"]
        highest = max(height.values())
        for marker in spread["marker"].values:
            spread.loc[{"quantity": "history", "marker": marker}] = top * height[marker] / highest


def test_envelopes_thicken_upward_or_not(content):
    thicken(content, "ls-dem", {FIRST: 0.01, FOURTH: 0.02})
    found = responses.upward(content, "ls-dem")
    assert found.verdict == MET
    assert "at scale 2" in found.words
    assert "configuration-1 2.0, 6.0, 10.0 mm" in found.words
    thicken(content, "ls-dem", {FOURTH: -0.02})
    found = responses.upward(content, "ls-dem")
    assert found.verdict == NOT_MET
    assert "1 of 2 cases" in found.words


def test_variables_that_matter_are_those_beyond_chance(content):
    for case in content.cases.values():
        result = case.responses["ls-dem"].sensitivity
        result["first_order_chance"][:] = 0.5
        result["rank_correlation_chance"][:] = 0.5
        result["first_order"][:] = 0.1
        result["rank_correlation"][:] = 0.1
        for name in ("materials.concrete.density", "materials.concrete.youngs_modulus"):
            result["first_order"].loc[{"parameter": name}] = 0.8
    found = responses.parameters_matter(content)
    assert found.verdict == UNJUDGED  # no evidence of an influence is none against it
    assert "Not so: friction. Chance alone makes a share or a correlation of 0.50 to 0.50" in found.words
    result["first_order"].loc[{"parameter": "friction.concrete.concrete"}] = 0.8
    assert responses.parameters_matter(content).verdict == MET


def chances(content, values):
    """Give the measured curves of the cases these chances, by every model."""
    for name, value in values.items():
        for one in content.cases[name].responses.values():
            one.comparison["curve_probability"][:] = value


def test_curves_without_a_chance_tell_nothing(real):
    for name in (FIRST, FOURTH):
        chances(real, {name: np.nan})
    found = models.resemblance(real)
    assert found.verdict == UNJUDGED
    assert "too few" in found.words


def test_resemblance_hangs_on_measured_curves(content, real):
    chances(real, {FIRST: 0.5, FOURTH: 0.5})
    assert models.resemblance(real).verdict == MET
    chances(real, {FOURTH: 1.0 / 11.0})  # the lowest that ten samples tell
    assert models.resemblance(real).verdict == NOT_MET
    real.cases[FIRST] = replace(real.cases[FIRST], synthetic=True)
    found = models.resemblance(real)
    assert found.verdict == UNJUDGED
    assert "do not bear the statement out" in found.words


def test_models_that_fit_some_configurations(real):
    chances(real, {FIRST: 0.5, FOURTH: 0.01})
    assert models.satisfactory(real, "nscd-rigid", (FOURTH,)).verdict == UNJUDGED  # two are not there
    found = models.satisfactory(real, "nscd-rigid")
    assert found.verdict == NOT_MET
    assert "fewer than three samples: configuration-2, configuration-3" in found.words
    for name in ("configuration-2", "configuration-3"):
        real.cases[name] = replace(real.cases[FIRST], name=name)
    assert models.satisfactory(real, "nscd-rigid", (FOURTH,)).verdict == MET


def test_the_best_model_has_the_lowest_score_of_every_test(real):
    case = real.cases[FIRST]
    for model in ("nscd-elastic", "nscd-viscoelastic"):
        real.study["models"][model] = {"time_step": 1e-3}
    found = case.differences.copy(deep=True)
    found["counted"][:] = 6
    for lower, verdict in ((1e-3, MET), (-2e-3, NOT_MET), (-1e-3, UNJUDGED)):
        for other in ("nscd-rigid", "nscd-elastic"):
            pair = {"model": "nscd-viscoelastic", "other": other}
            found["score_difference_interval"].loc[pair] = [lower, lower + 1.5e-3]
        for place in (1, 2, 3, 4):
            name = f"configuration-{place}"
            real.cases[name] = replace(case, name=name, differences=found)
        assert models.best_model(real).verdict == verdict
    assert "0 bear the statement out, 0 contradict it, 8 are not told apart" in models.best_model(real).words


def test_one_configuration_the_other_way_round_is_enough_against_the_best_model(real):
    case = real.cases[FIRST]
    for model in ("nscd-elastic", "nscd-viscoelastic"):
        real.study["models"][model] = {"time_step": 1e-3}
    for place, lower, count in ((1, 1e-3, 6), (2, 1e-3, 5), (3, np.nan, 6), (4, -2e-3, 6)):
        found = case.differences.copy(deep=True)
        found["counted"][:] = count
        found["score_difference_interval"].loc[{"bound": "lower"}] = lower
        found["score_difference_interval"].loc[{"bound": "upper"}] = lower + 1e-3
        real.cases[f"configuration-{place}"] = replace(case, name=f"configuration-{place}", differences=found)
    found = models.best_model(real)
    assert found.verdict == NOT_MET
    assert "2 bear the statement out, 2 contradict it, 0 are not told apart" in found.words
    assert "4 are of fewer than 6 samples" in found.words
    del real.cases[FOURTH]
    assert models.best_model(real).verdict == UNJUDGED  # two of four


@pytest.mark.parametrize(("beside", "verdict", "share"), [(2.0, MET, "none of 2"), (0.5, NOT_MET, "all 2")])
def test_models_are_alike_where_two_samples_are_as_far_apart(content, beside, verdict, share):
    for case in content.cases.values():
        apart = float(case.differences["distance"].sel(model="ls-dem", other="nscd-rigid"))
        case.differences["width"][:] = beside * apart
        case.differences["distance_chance"][:] = 0.0
        case.differences["counted"][:] = 6
    found = models.alike(content)
    assert found.verdict == verdict
    assert (
        f"larger one in {share} comparisons, and beyond that of samples exchanged at random in all 2."
        in found.words
    )


def test_viscoelastic_blocks_are_held_against_ls_dem_too(content):
    content.study["models"]["nscd-viscoelastic"] = {"time_step": 1e-3}
    for case in content.cases.values():
        case.responses["nscd-viscoelastic"] = case.responses["nscd-rigid"]
        case.differences["counted"][:] = 6
    assert "configuration-4, NSCD viscoelastic" in models.alike(content).words


def test_too_few_samples_are_not_held_against_each_other(content):
    for case in content.cases.values():
        case.differences["counted"][:] = 6
    content.cases["configuration-4"].differences["counted"].loc[{"model": "nscd-rigid"}] = 5
    found = models.alike(content)
    assert (
        "configuration-4, NSCD rigid" not in found.words.split("Of fewer than 6 samples, and not judged:")[0]
    )
    content.cases[FIRST].differences["counted"][:] = 5
    assert models.alike(content).verdict == UNJUDGED


def test_rotations_are_held_against_the_noise_of_two_markers(real):
    del real.cases[FOURTH]
    case = real.cases[FIRST]
    for turned, verdict in ((1e-6, MET), (1e-3, NOT_MET)):
        for one in case.responses.values():
            one.samples["peak_rotation"][:] = turned
        found = models.rotations(real)
        assert found.verdict == verdict
    # markers of a face 0.6 m and 1.3 m apart
    times = 1e-3 * np.hypot(0.6, 1.3) / (np.sqrt(2.0) * 1e-4)
    assert f"configuration-1 {times:.2g} to {times:.2g} times" in found.words
