import time

import numpy as np
import pandas as pd
import pytest
from scipy.stats import norm, rankdata

from blockshake.errors import InputError
from blockshake.study.sampling.distributions import TABLE_2, Lognormal
from blockshake.study.sampling.latin_hypercube import draw_samples
from blockshake.study.sampling.sample_table import load_design, write_design

LEVEL = 8e-4  # rms correlation error to reach for 50 x 9
CPU_LIMIT = 5.0  # s of processor time, compilation not counted
# cement makes concrete stiff and heavy together; a viscous modulus follows the elastic one
CORRELATED = pd.DataFrame(
    [[1.0, 0.5, -0.3, 0.4], [0.5, 1.0, 0.0, 0.2], [-0.3, 0.0, 1.0, 0.6], [0.4, 0.2, 0.6, 1.0]],
    index=list(TABLE_2)[2:6],
    columns=list(TABLE_2)[2:6],
)


@pytest.fixture(scope="module")
def design():
    return draw_samples()


def _rms(values, target):
    off = (np.corrcoef(values, rowvar=False) - target)[np.triu_indices(len(target), k=1)]
    return np.sqrt(np.mean(off**2))


def test_marginals_are_table_2_within_the_stated_loss(design):
    for name, variable in TABLE_2.items():
        values = design.values[name].to_numpy()
        # medians of 50 strata: mean short by at most 3e-4 of itself, COV by 1.2 to 1.5 %
        assert -3e-4 < values.mean() / variable.mean - 1.0 < 0.0
        assert -0.015 < values.std() / values.mean() / variable.cov - 1.0 < -0.012


def test_stratum_means_keep_the_mean_and_most_of_the_variation():
    values = draw_samples(stratum="mean", effort=1).values
    for name, variable in TABLE_2.items():
        assert values[name].mean() == pytest.approx(variable.mean, rel=1e-13)
        assert -0.004 < values[name].std(ddof=0) / variable.mean / variable.cov - 1.0 < -0.002


def test_every_variable_hits_the_median_of_every_stratum_once(design):
    for name, variable in TABLE_2.items():
        probability = norm.cdf(
            np.log(np.sort(design.values[name]) / variable.median) / variable.log_deviation
        )
        np.testing.assert_allclose(probability, (np.arange(50) + 0.5) / 50, rtol=1e-12)


@pytest.mark.parametrize("correlation", [None, CORRELATED], ids=["identity", "correlated"])
@pytest.mark.parametrize("kind", ["pearson", "spearman"])
def test_correlation_error_of_50_by_9(correlation, kind):
    draw_samples(10, effort=1)  # compiles
    start = time.process_time()
    design = draw_samples(50, seed=2, correlation=correlation, kind=kind)
    assert time.process_time() - start < CPU_LIMIT
    target = np.eye(9)
    if correlation is not None:
        target[2:6, 2:6] = correlation
    values = design.values.to_numpy()
    reached = _rms(values if kind == "pearson" else rankdata(values, axis=0), target)
    assert reached <= LEVEL
    assert design.rms_error == pytest.approx(reached, rel=1e-9)
    assert design.largest_error >= design.rms_error
    np.testing.assert_array_equal(design.target.to_numpy(), target)


def test_thousand_samples_of_thirty_variables():
    variables = {f"materials.m{i}.density": Lognormal(mean=1.0, cov=0.1) for i in range(30)}
    # swaps are finer the more samples there are: well below the level of 50 x 9
    assert draw_samples(1000, distributions=variables, effort=1).rms_error < 1e-4


def test_a_target_beyond_reach_is_reported_as_missed():
    # two log-normals with COV 2 cannot be correlated below -1/5 (Frechet-Hoeffding bound
    # (exp(-s^2) - 1) / (exp(s^2) - 1) with s^2 = ln 5)
    variables = {"friction.a.b": Lognormal(mean=1.0, cov=2.0), "friction.a.c": Lognormal(mean=1.0, cov=2.0)}
    target = pd.DataFrame([[1.0, -0.9], [-0.9, 1.0]], index=list(variables), columns=list(variables))
    design = draw_samples(50, distributions=variables, correlation=target, effort=1)
    countermonotone = np.corrcoef(
        np.sort(design.values["friction.a.b"]), -np.sort(-design.values["friction.a.c"])
    )
    assert design.correlation.iloc[0, 1] == pytest.approx(countermonotone[0, 1], abs=1e-9)
    assert design.rms_error == pytest.approx(countermonotone[0, 1] + 0.9, abs=1e-9)


def test_same_seed_same_bytes_and_other_seed_other_design(tmp_path):
    for name, seed in (("a", 4), ("b", 4), ("c", 5)):
        write_design(tmp_path / name, draw_samples(12, seed=seed, effort=1).values)
    first, second, other = ((tmp_path / name).read_bytes() for name in "abc")
    assert first == second
    assert first != other


def test_one_variable_needs_no_pairing():
    design = draw_samples(10, distributions={"friction.a.b": Lognormal(mean=1.0, cov=0.1)})
    assert design.values.shape == (10, 1)
    assert design.rms_error == 0.0


def test_design_csv_has_one_row_a_sample_and_loads_to_the_same_values(design, tmp_path):
    write_design(tmp_path / "design.csv", design.values)
    lines = (tmp_path / "design.csv").read_text().splitlines()
    assert lines[0].split(",") == list(TABLE_2)
    assert len(lines) == 51
    pd.testing.assert_frame_equal(load_design(tmp_path / "design.csv"), design.values, check_exact=True)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("friction.a.b\n", "one row a sample"),
        ("friction.a.b,friction.a.b\n1,2\n", "name of its own"),
        ("friction.a.b,friction.a.c\n1\n", "row 1: expected 2 cells, not 1"),
        ("friction.a.b\n1\nnan\n", "row 2, friction.a.b: expected a finite number, not 'nan'"),
        ("friction.a.b\nx\n", "finite number"),
    ],
)
def test_a_wrong_design_is_refused(tmp_path, text, words):
    path = tmp_path / "design.csv"
    path.write_text(text)
    with pytest.raises(InputError, match=words):
        load_design(path)


def test_summary_is_what_the_design_holds(design):
    summary = design.summary()
    assert summary["size"] == 50
    assert summary["rms_correlation_error"] == design.rms_error
    assert summary["mean"]["friction.concrete.steel"] == design.values["friction.concrete.steel"].mean()
    assert summary["cov"]["friction.concrete.steel"] == pytest.approx(0.1, rel=0.015)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"size": 9}, "size: expected a whole number of at least 10, not 9"),
        ({"size": 12.5}, "whole number"),
        ({"seed": -1}, "seed: "),
        ({"effort": 0}, "effort: "),
        ({"stratum": "middle"}, "median, mean"),
        ({"kind": "kendall"}, "pearson, spearman"),
        ({"correlation": pd.DataFrame([[1.0]], index=["mass"], columns=["mass"])}, "mass: expected one of"),
        ({"correlation": CORRELATED.iloc[:2]}, "square"),
    ],
)
def test_wrong_options_are_refused_in_one_line(options, words):
    with pytest.raises(InputError, match=words) as error:
        draw_samples(**options)
    assert "\n" not in str(error.value)


STUDYS = {
    "friction.granite.plate": {"distribution": "lognormal", "mean": 0.7, "cov": 0.1},
    "materials.granite.density": {"mean": 2650.0, "cov": 0.04},
}
CORRELATION = "name,{0},materials.granite.density\n{0},1,0.5\nmaterials.granite.density,0.5,1\n"


def test_the_notation_of_a_study_is_that_of_its_distributions():
    """Both ways to name a distribution and its correlation give the same bytes."""
    named = {
        "friction.granite.plate": Lognormal(mean=0.7, cov=0.1),
        "materials.granite.density": Lognormal(mean=2650.0, cov=0.04),
    }
    values = draw_samples(10, 1, STUDYS).values
    pd.testing.assert_frame_equal(values, draw_samples(10, 1, named).values)


@pytest.mark.parametrize("pair", ["friction.granite.plate", "friction.plate.granite"])
def test_a_correlation_names_a_pair_in_either_order(tmp_path, pair):
    (tmp_path / "c.csv").write_text(CORRELATION.format(pair))
    design = draw_samples(10, 1, STUDYS, tmp_path / "c.csv")
    assert design.target.to_numpy()[0, 1] == 0.5
    assert list(design.target.columns) == list(STUDYS)
    assert abs(design.correlation.to_numpy()[0, 1] - 0.5) < 0.01


def test_wrong_distributions_are_refused_in_one_line():
    for wrong in ({"friction.a.b": {"mean": 0.7}}, [0.7]):
        with pytest.raises(InputError, match="sampling: distributions"):
            draw_samples(10, 1, wrong)


def test_a_correlation_that_names_a_pair_twice_is_refused(tmp_path):
    both = "name,friction.a.b,friction.b.a\nfriction.a.b,1,0.5\nfriction.b.a,0.5,1\n"
    (tmp_path / "c.csv").write_text(both)
    with pytest.raises(InputError, match="the same names, each once"):
        draw_samples(10, 1, {"friction.a.b": {"mean": 0.7, "cov": 0.1}}, tmp_path / "c.csv")
