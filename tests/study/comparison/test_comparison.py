"""Made-up ensembles of two models whose differences are known."""

import numpy as np
import pytest
import xarray as xr

from blockshake.files import write_dataset
from blockshake.study.comparison import comparison
from blockshake.study.comparison.comparison import compare_models, parting_time

BLOCK = "block-1-face"
NOISE = 1e-4  # m
SHIFT = 0.02  # m
LEVELS = (0.010, 0.011, 0.012, 0.013)  # m, amplitudes of the samples of the first model
STANDING = 400 / 401  # share of the times after the first, at which nothing has moved


@pytest.fixture
def ensembles(make_run, gather):
    return {
        "ls-dem": gather([make_run(level) for level in LEVELS]),
        "nscd-rigid": gather([make_run(level + SHIFT) for level in LEVELS[:3]]),
        "nscd-elastic": gather([make_run(LEVELS[0])]),
    }


def replicate_of(ensembles, model):
    """Twin of the first sample of a model that is 1 mm off, from half of the window on."""
    replicate = ensembles[model].isel(sample=[0]).copy(deep=True)
    replicate["marker_displacement"].loc[{"marker": BLOCK, "axis": "x", "time": slice(1.0, None)}] += 1e-3
    return replicate


@pytest.fixture
def compared(ensembles, make_run):
    replicates = {"ls-dem": replicate_of(ensembles, "ls-dem")}
    return compare_models(ensembles, replicates, (make_run(LEVELS[1]), NOISE))


def test_a_shift_is_measured_in_ensembles_and_in_runs(compared):
    pair = compared.sel(model="ls-dem", other="nscd-rigid")
    # narrow ensembles: the shift, between mean levels half a millimetre nearer, less the spreads within
    between = np.abs(np.subtract.outer(LEVELS, np.array(LEVELS[:3]) + SHIFT)).mean()
    within = [np.abs(np.subtract.outer(one, one)).mean() for one in (LEVELS, LEVELS[:3])]
    assert float(pair["distance"]) == pytest.approx(STANDING * (between - sum(within) / 2.0), rel=1e-12)
    assert pair["distance"] > pair["distance_chance"]
    assert float(pair["history_difference"]) == pytest.approx(STANDING * SHIFT, rel=1e-12)
    assert int(pair["common"]) == 3
    assert float(pair["parting_time"]) == 1 / 200
    np.testing.assert_array_equal(compared["distance"], compared["distance"].T)


def test_equal_ensembles_are_not_apart(ensembles):
    both = {name: ensembles["ls-dem"] for name in ("ls-dem", "nscd-viscoelastic")}
    pair = compare_models(both, {}, None).sel(model="ls-dem", other="nscd-viscoelastic")
    assert float(pair["distance"]) == pytest.approx(0.0, abs=1e-18)
    assert float(pair["history_difference"]) == 0.0
    assert float(pair["parting_time"]) == np.inf


def test_medians_and_width_of_a_block(compared):
    at = compared.sel(model="ls-dem", marker=BLOCK)
    assert float(at["peak"]) == pytest.approx(np.median(LEVELS), rel=1e-12)
    # four samples bear no limits
    assert np.isnan(at["peak_interval"]).all()
    assert np.isnan(at["width_interval"]).all()
    pairs = [b - a for place, a in enumerate(LEVELS) for b in LEVELS[place + 1 :]]
    assert float(at["width"]) == pytest.approx(STANDING * np.mean(pairs), rel=1e-9)
    assert "slab-face" not in compared["marker"].values


def test_of_many_samples_the_first_are_compared(ensembles, tmp_path, monkeypatch):
    monkeypatch.setattr(comparison, "MOST", 3)
    whole = ensembles["ls-dem"]
    files = [tmp_path / f"{first}.nc" for first in (0, 2)]
    for first, file in zip((0, 2), files, strict=True):
        write_dataset(file, whole.isel(sample=slice(first, first + 2)))
    found = comparison.compare_case({"ls-dem": files}, {}, None, None, {})
    xr.testing.assert_equal(found, compare_models({"ls-dem": whole.isel(sample=slice(3))}, {}, None))
    assert int(found["counted"].sel(model="ls-dem")) == 3


def test_distances_are_made_level_by_level(ensembles, tmp_path):
    """Samples of one level alone stand behind a distance: those of the other may lie anywhere."""
    files, other = {}, {}
    for model, whole in ensembles.items():
        files[model] = [tmp_path / f"{model}.nc"]
        write_dataset(files[model][0], whole)
        other[model] = whole.isel(sample=slice(0, None, 2))
    levels = {sample: (3.0, 6.0)[sample % 2] for sample in range(4)}
    found = comparison.compare_case(files, {}, None, None, levels)
    assert found["level"].values.tolist() == [3.0, 6.0]
    own = compare_models(other, {}, None)
    xr.testing.assert_equal(found.sel(level=3.0, drop=True), own)
    assert int(found["counted"].sel(level=6.0, model="ls-dem")) == 2


def test_floor_and_horizon_are_those_of_the_replicate(compared):
    at = compared.sel(model="ls-dem")
    # 201 of 401 times from 1 s on
    assert float(at["floor"]) == pytest.approx(1e-3 * 201 / 401, rel=1e-9)
    assert float(at["horizon"]) == pytest.approx(1.0, rel=1e-12)
    assert np.isnan(compared["floor"].sel(model="nscd-rigid"))


def test_one_sample_has_no_distance_but_its_history(compared):
    pair = compared.sel(model="ls-dem", other="nscd-elastic")
    assert np.isnan(pair["distance"])
    assert np.isnan(compared["score"].sel(model="nscd-elastic"))
    assert float(pair["history_difference"]) == 0.0
    assert int(pair["common"]) == 1


def test_the_nearer_model_has_the_lower_score(compared):
    assert compared["score"].sel(model="ls-dem") < compared["score"].sel(model="nscd-rigid")


def test_same_ensembles_same_numbers_and_every_number_has_its_unit(ensembles, compared, make_run):
    replicates = {"ls-dem": replicate_of(ensembles, "ls-dem")}
    assert compared.identical(compare_models(ensembles, replicates, (make_run(LEVELS[1]), NOISE)))
    assert all({"units", "long_name"} <= set(one.attrs) for one in compared.values())


def test_models_all_of_whose_samples_failed_have_no_numbers(ensembles, make_run, gather):
    failed = gather([make_run(0.01, status="not-converged")])
    found = compare_models({**ensembles, "nscd-elastic": failed}, {}, (make_run(0.01), NOISE))
    at = found.sel(model="nscd-elastic")
    assert int(at["counted"]) == 0
    assert np.isnan(at[["peak", "width", "score"]].to_array()).all()
    assert np.isnan(at["history_difference"].sel(other="ls-dem"))


def test_curves_part_where_one_is_beyond_the_limit_or_has_ended():
    time = np.arange(4.0)
    own = np.zeros((4, 2))
    other = np.array([[0.0, 0.0], [0.1, 0.0], [0.1, 0.5], [0.1, 0.0]])
    assert parting_time(time, own, other, 0.2) == 2.0
    assert parting_time(time, own, other, 0.6) == np.inf
    other[1:] = np.nan
    assert parting_time(time, own, other, 0.6) == 1.0


def test_other_settings_are_held_against_the_plain_model_over_the_samples_of_both(make_run, gather):
    plain, wider = 0.010 + 0.001 * np.arange(8), 0.030 + 0.002 * np.arange(8)
    runs = [make_run(level) for level in wider]
    runs[0] = make_run(wider[0], status="not-converged")
    runs[7] = make_run(wider[7], status="collapsed", end=1.0)
    both = {"ls-dem": gather([make_run(level) for level in plain]), "ls-dem-wider": gather(runs)}
    found = compare_models(both, {}, None).sel(marker=BLOCK)
    at = found.sel(model="ls-dem-wider")
    assert int(at["changed"]) == 7  # of the sample that failed nothing is known
    assert float(at["peak_change"]) == pytest.approx(np.median((wider - plain)[1:]), rel=1e-12)
    # a sample that fell has no residual
    assert float(at["residual_change"]) == pytest.approx(np.median((wider - plain)[1:7]), rel=1e-12)
    alone = [compare_models({"ls-dem": gather(one)}, {}, None).sel(model="ls-dem", marker=BLOCK)["width"]
             for one in (runs[1:], [make_run(level) for level in plain[1:]])]  # fmt: skip
    assert float(at["width_change"]) == pytest.approx(float(alone[0] - alone[1]), rel=1e-9)
    for name, value in (("peak", at["peak_change"]), ("width", at["width_change"])):
        lower, upper = at[f"{name}_change_interval"].to_numpy()
        assert 0.0 < lower <= float(value) <= upper
    assert np.isnan(found["peak_change"].sel(model="ls-dem"))


def test_equal_settings_change_nothing_and_a_study_without_the_plain_model_tells_of_no_change(ensembles):
    whole = ensembles["ls-dem"]
    same = compare_models({"ls-dem": whole, "ls-dem-again": whole}, {}, None).sel(
        model="ls-dem-again", marker=BLOCK
    )
    assert [float(same[f"{name}_change"]) for name in comparison.CHANGES] == [0.0, 0.0, 0.0]
    assert np.isnan(same["peak_change_interval"]).all()  # four samples bear no limits
    other = compare_models({"nscd-rigid": whole, "ls-dem-again": whole}, {}, None).sel(model="ls-dem-again")
    assert int(other["changed"]) == 0
    assert np.isnan(other["width_change"]).all()
