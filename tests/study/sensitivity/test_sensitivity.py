"""Sensitivity of an ensemble: which variable is found, what becomes of collapsed samples, what is written."""

import numpy as np
import pandas as pd
import pytest
from fake_study import ensemble_of

from blockshake.geometry.structure import load_structure
from blockshake.study.sampling.latin_hypercube import draw_samples
from blockshake.study.sampling.sample_parameters import (
    sample_parameters,
    unused_variables,
    used_columns,
)
from blockshake.study.sensitivity.sensitivity import sensitivity

FRICTION, DENSITY = "friction.concrete.concrete", "materials.concrete.density"
VISCOUS, YOUNG = "materials.concrete.viscous_modulus", "materials.concrete.youngs_modulus"
TIME = np.arange(401) / 200.0


@pytest.fixture(scope="module")
def design():
    return draw_samples(50, seed=3, effort=1).values


@pytest.fixture
def ensemble(make_run, design):
    """Fifty runs: friction moves the block, chance is a tenth of friction's effect."""

    def gathered(change=lambda sample, run: run, values=design):
        score = (design - design.mean()) / design.std()
        noise = np.random.default_rng(4).normal(size=len(design))
        runs = []
        for sample in design.index:
            moved = 0.02 + 0.002 * score[FRICTION][sample] + 0.0002 * noise[sample]
            runs.append(change(sample, make_run(moved * np.minimum(TIME, 1.0))))
        return ensemble_of(runs, values)

    return gathered


def at(result, name, quantity, parameter, **bound):
    return float(result[name].sel(quantity=quantity, marker="block-1-face", parameter=parameter, **bound))


def test_the_input_that_acts_is_found_and_no_other(ensemble, design):
    result = sensitivity(ensemble(), design)
    for quantity, acting in (("history", FRICTION), ("peak", FRICTION)):
        for name in ("first_order", "rank_correlation"):
            if quantity == "history" and name == "rank_correlation":
                assert np.isnan(result[name].sel(quantity=quantity)).all()
                continue
            level = float(result[f"{name}_chance"].sel(quantity=quantity))
            found = [one for one in design.columns if abs(at(result, name, quantity, one)) > level]
            assert found == [acting]
            low, high = (
                at(result, f"{name}_interval", quantity, acting, bound=one) for one in ("lower", "upper")
            )
            assert level < low <= at(result, name, quantity, acting) <= high <= 1.0
    # 0.99 of the variance, of which five classes of a nearly normal variable see 0.9
    assert at(result, "first_order", "peak", FRICTION) == pytest.approx(0.9, abs=0.05)
    assert float(result["explained"].sel(quantity="peak", marker="block-1-face")) > 0.9


def test_spread_is_the_standard_deviation_and_of_a_history_its_mean_square_over_time(ensemble, design):
    gathered = ensemble()
    result = sensitivity(gathered, design[[FRICTION]]).sel(marker="block-1-face")
    peaks = gathered["peak"].sel(frame="slab", marker="block-1-face")
    assert float(result["spread"].sel(quantity="peak")) == pytest.approx(float(peaks.std()), rel=1e-9)
    along = gathered["marker_displacement"].sel(axis="x", marker="block-1-face")
    mean_square = np.sqrt(float((along.var("sample")).mean()))
    assert float(result["spread"].sel(quantity="history")) == pytest.approx(mean_square, rel=1e-6)


def test_collapsed_samples_rank_first_and_have_no_history(ensemble, design):
    """The ten of least friction fall at 1 s, with hardly any motion before: as peaks they would seem the smallest."""
    weakest = design[FRICTION].nsmallest(10).index

    def fall(sample, run):
        if sample in weakest:
            run.attrs |= {"status": "collapsed", "reason": "fell", "end_time": 1.0}
            run["marker_displacement"][TIME > 1.0] = np.nan
            run["marker_displacement"][:, 1] *= 0.0
        return run

    result = sensitivity(ensemble(fall), design)
    assert list(result["used"].values) == [40, 50]
    # all others grow with friction, the ten of least friction are put above them
    ranks = np.concatenate([np.full(10, 45.5), np.arange(1.0, 41.0)])
    of_ranks = np.corrcoef(np.arange(50.0), ranks)[0, 1]
    assert at(result, "rank_correlation", "peak", FRICTION) == pytest.approx(of_ranks, abs=0.15)
    assert at(result, "first_order", "history", FRICTION) > 0.8
    # without the ten of least friction a rank is another one, and so is its correlation
    known = design.drop(weakest).rank().corr()
    np.testing.assert_allclose(result["correlation"], known, atol=1e-12)


def test_samples_that_the_solver_could_not_finish_are_left_out(ensemble, design):
    def fail(sample, run):
        if sample < 5:
            run.attrs["status"] = "diverged"
            run["marker_displacement"][:, 1] *= 1000.0
        return run

    result = sensitivity(ensemble(fail), design)
    assert (result["used"] == 45).all()
    assert at(result, "first_order", "peak", FRICTION) > 0.8


def test_same_ensemble_same_numbers(ensemble, design):
    first, second = (sensitivity(ensemble(), design) for _ in range(2))
    assert first.identical(second)


def test_every_variable_has_a_name_and_a_unit(ensemble, design):
    result = sensitivity(ensemble(), design[[FRICTION, DENSITY]])
    for name, variable in result.data_vars.items():
        assert variable.attrs["long_name"], name
        assert variable.attrs["units"] == ("m" if name.endswith("spread") else "1"), name
    assert "slab-face" not in result["marker"].values


def test_stiffness_is_no_variable_unless_asked_for(ensemble, design):
    values = design.assign(**{"ls_dem.normal_stiffness": design[YOUNG] / 1.6})
    result = sensitivity(ensemble(values=values), design)
    assert "ls_dem.normal_stiffness" not in result["parameter"].values


def test_controls_are_what_model_and_structure_have_no_use_for(design):
    row = design.loc[0]
    given = sample_parameters(row, load_structure("configuration-1"), {})
    names = list(design.columns)
    assert load_structure("configuration-1").file.materials.keys() == {"concrete", "foundation"}
    steel = [name for name in names if "steel" in name]
    assert set(unused_variables(names, "ls-dem", given)) == {VISCOUS, *steel}
    assert set(unused_variables(names, "nscd-rigid", given)) == {VISCOUS, YOUNG, *steel}
    with_steel = sample_parameters(row, load_structure("configuration-4"), {})
    viscous = {VISCOUS, "materials.steel.viscous_modulus"}
    # LS-DEM's joint of steel on concrete has both materials' moduli in series
    assert set(unused_variables(names, "ls-dem", with_steel)) == viscous
    elastic = {YOUNG, "materials.steel.youngs_modulus"}
    assert set(unused_variables(names, "nscd-rigid", with_steel)) == viscous | elastic


def test_a_variable_counts_where_a_parameter_takes_its_value():
    """The modulus of a material that the structure lacks is that of its foundation by a link."""
    lacked, foundation = "materials.steel.youngs_modulus", "materials.foundation.youngs_modulus"
    one = pd.DataFrame({lacked: [2e11], FRICTION: [0.7], "friction.ice.ice": [0.1]})
    structure = load_structure("configuration-1")
    assert used_columns(one, structure, {}, "ls-dem") == [FRICTION]
    assert used_columns(one, structure, {foundation: lacked}, "ls-dem") == [lacked, FRICTION]
    assert used_columns(one, structure, {foundation: lacked}, "nscd-rigid") == [FRICTION]


def test_few_samples_leave_variables_correlated_and_too_few_have_no_correlation(ensemble, design):
    """Rows of a design in which no two variables are correlated are correlated among themselves."""
    gathered = ensemble()
    every, eight, five = (
        sensitivity(gathered.isel(sample=slice(size)), design)["correlation"].to_numpy()
        for size in (50, 8, 5)
    )
    pairs = np.triu_indices(design.shape[1], 1)
    assert np.abs(every[pairs]).max() < 0.2 < np.abs(eight[pairs]).max()
    np.testing.assert_allclose(np.diag(eight), 1.0, atol=1e-12)
    assert np.isnan(five).all()
