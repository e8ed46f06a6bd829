import itertools

import numpy as np
import pytest
from scipy import integrate, stats

from blockshake.errors import InputError
from blockshake.study.sampling.distributions import (
    TABLE_2,
    Discrete,
    Lognormal,
    Tabulated,
    draw_true_parameters,
    load_distributions,
    parameter_unit,
)

# Zhou et al. (2023), Table 2: mean and standard deviation as printed
PRINTED = {
    "friction.concrete.concrete": (0.75, 0.075),
    "friction.concrete.foundation": (0.75, 0.075),
    "friction.concrete.steel": (0.3, 0.03),
    "materials.concrete.density": (2400.0, 96.0),
    "materials.concrete.youngs_modulus": (3.45e10, 5.175e9),
    "materials.concrete.viscous_modulus": (1.5e8, 2.25e7),
    "materials.steel.density": (7700.0, 77.0),
    "materials.steel.youngs_modulus": (0.21e12, 6.3e9),
    "materials.steel.viscous_modulus": (0.21e10, 6.3e7),
}
QUADRATURE = 1e-8  # relative error of adaptive quadrature over 12 deviations


@pytest.mark.parametrize("name", PRINTED)
def test_moments_of_the_density_are_those_of_table_2(name):
    mean, deviation = PRINTED[name]
    variable = TABLE_2[name]

    def moment(power):
        def weighed(score):
            value = variable.median * np.exp(score * variable.log_deviation)
            return (value / mean) ** power * variable.density(value) * value * variable.log_deviation

        return integrate.quad(weighed, -12.0, 12.0, epsabs=0.0, epsrel=1e-10)[0]

    assert moment(0) == pytest.approx(1.0, rel=QUADRATURE)
    assert moment(1) == pytest.approx(1.0, rel=QUADRATURE)
    assert moment(2) - 1.0 == pytest.approx(
        (deviation / mean) ** 2, rel=1e-4
    )  # a difference of order COV squared


def test_table_2_has_its_nine_variables_in_order():
    assert list(TABLE_2) == list(PRINTED)


def test_quantiles_are_those_of_the_normal_logarithm():
    variable = Lognormal(mean=2.0, cov=0.5)
    assert variable.quantile(0.5) == pytest.approx(variable.median, rel=1e-15)
    # the 97.5 % quantile of the standard normal is 1.959964
    assert np.log(variable.quantile(0.975) / variable.median) / variable.log_deviation == pytest.approx(
        1.959963985, abs=1e-8
    )


def test_stratum_means_are_conditional_means_by_quadrature():
    variable, size = Lognormal(mean=0.75, cov=0.3), 10
    edges = np.arange(size + 1) / size
    by_quadrature = [
        size * integrate.quad(variable.quantile, low, high, epsrel=1e-10)[0]
        for low, high in itertools.pairwise(edges)
    ]
    # the integrand is unbounded, though integrable, at 0 and 1
    np.testing.assert_allclose(variable.stratum_means(size), by_quadrature, rtol=1e-6)


def test_config_replaces_table_2_as_a_whole():
    entry = {"distribution": "lognormal", "mean": 0.5, "cov": 0.2}
    loaded = load_distributions({"friction.concrete.concrete": entry}, "study.yaml")
    assert loaded == {"friction.concrete.concrete": Lognormal(mean=0.5, cov=0.2)}
    assert load_distributions(None, "study.yaml") == TABLE_2


@pytest.mark.parametrize(
    ("mapping", "key"),
    [
        ({"friction.concrete": {"mean": 1, "cov": 0.1}}, "friction.concrete"),
        ({"materials.concrete.densty": {"mean": 1, "cov": 0.1}}, "materials.concrete.densty"),
        ({"shapes.block.colour": {"mean": 0.02, "cov": 0.1}}, "shapes.block.colour"),
        ({"friction.a.b": {"mean": 1, "cov": 0.1, "sd": 2}}, "friction.a.b.sd"),
        ({"friction.a.b": {"mean": 1}}, "friction.a.b.cov"),
        ({"friction.a.b": {"mean": -1, "cov": 0.1}}, "friction.a.b.mean"),
        ({"friction.a.b": {"mean": 1, "cov": 0.1, "distribution": "norml"}}, "friction.a.b.distribution"),
        ({"friction.a.b": {"mean": 1, "cov": 0.1}, "friction.b.a": {"mean": 1, "cov": 0.1}}, "friction.b.a"),
        ({}, ""),
        ({"friction.a.b": 3}, "friction.a.b"),
    ],
)
def test_a_wrong_config_is_refused_in_one_line(mapping, key):
    with pytest.raises(InputError) as error:
        load_distributions(mapping, "study.yaml")
    assert str(error.value).startswith("study.yaml: distributions" + (f".{key}" if key else ""))
    assert "\n" not in str(error.value)


def test_units_follow_the_property():
    assert parameter_unit("friction.concrete.concrete") == "1"
    assert parameter_unit("materials.concrete.density") == "kg/m3"
    assert parameter_unit("materials.steel.viscous_modulus") == "Pa s"
    assert parameter_unit("shapes.block.hollow") == "m"
    assert parameter_unit("ls_dem.shear_stiffness") == "N/m3"
    with pytest.raises(InputError, match=r"nscd\.impact_parts: expected"):
        parameter_unit("nscd.impact_parts")  # a count


@pytest.mark.parametrize(
    ("name", "unit"),
    [
        ("restitution", "1"),
        ("shapes.block.box.z", "m"),
        ("shapes.block.chamfer", "m"),
        ("bodies.block-1.position.x", "m"),
        ("bodies.block-1.offset.z", "m"),
        ("bodies.block-1.mass_offset.y", "m"),
        ("joints.slab.block-1.friction_factor", "1"),
        ("stoppers.0.gap", "m"),
        ("gravity.z", "m/s2"),
        ("ls_dem.normal_stiffness", "N/m3"),
        ("nscd.shrink", "1"),
        ("motion.scale", "1"),
        ("motion.heading", "rad"),
    ],
)
def test_numbers_that_set_takes_can_be_drawn(name, unit):
    assert load_distributions({name: {"mean": 0.5, "cov": 0.1}}, "study.yaml")
    assert parameter_unit(name) == unit


@pytest.mark.parametrize(
    "name", ["bodies.a.position", "bodies.a.orientation.w", "bodies.a.inertia", "gravity"]
)
def test_a_vector_is_drawn_part_by_part(name):
    with pytest.raises(InputError, match="a part of a vector by its axis"):
        load_distributions({name: {"mean": 0.5, "cov": 0.1}}, "study.yaml")


def test_a_joint_is_drawn_once_whatever_the_order_of_its_bodies():
    entry = {"mean": 1.0, "cov": 0.1}
    with pytest.raises(InputError, match="every pair once"):
        load_distributions({"joints.a.b.compliance": entry, "joints.b.a.compliance": entry}, "study.yaml")
    assert load_distributions({"friction.a.b": entry, "friction.a.b.rate_drop": entry}, "study.yaml")


def test_true_parameters_are_independent_draws_of_table_2():
    means = {name: variable.mean for name, variable in TABLE_2.items()}
    assert draw_true_parameters(7, means) == draw_true_parameters(7, means)
    assert draw_true_parameters(7, means) != draw_true_parameters(8, means)
    draws = np.array([list(draw_true_parameters(seed, means).values()) for seed in range(2000)])
    logs = np.array([variable.log_deviation for variable in TABLE_2.values()])
    medians = np.array([variable.median for variable in TABLE_2.values()])
    scores = np.log(draws / medians) / logs
    # 4 standard errors of 2000 normal draws: mean 0.022, deviation 0.016, correlation 0.022
    assert np.abs(scores.mean(axis=0)).max() < 4 * 0.0224
    assert np.abs(scores.std(axis=0) - 1.0).max() < 4 * 0.0158
    assert np.abs(np.corrcoef(scores, rowvar=False) - np.eye(9)).max() < 4.5 * 0.0224


def test_true_parameters_scatter_about_the_means_given_and_leave_the_others_out():
    name = "materials.concrete.youngs_modulus"
    usual = draw_true_parameters(7, {name: TABLE_2[name].mean})
    assert draw_true_parameters(7, {name: 2.0 * TABLE_2[name].mean}) == {
        name: pytest.approx(2.0 * usual[name])
    }


def test_a_tabulated_variable_of_two_values_is_uniform():
    """Mean (a + b) / 2, variance (b - a)^2 / 12, density 1 / (b - a), quantile a + p (b - a)."""
    variable = Tabulated(distribution="tabulated", values=(-1.0, 3.0))
    assert variable.mean == pytest.approx(1.0)
    assert variable.median == pytest.approx(1.0)
    assert variable.cov == pytest.approx(4.0 / np.sqrt(12.0), rel=1e-5)  # the midpoint rule of 640 points
    np.testing.assert_allclose(variable.quantile([0.0, 0.25, 1.0]), [-1.0, 0.0, 3.0])
    np.testing.assert_allclose(variable.density([-1.5, -0.5, 2.9, 3.1]), [0.0, 0.25, 0.25, 0.0])
    np.testing.assert_allclose(variable.stratum_medians(4), [-0.5, 0.5, 1.5, 2.5])
    np.testing.assert_allclose(variable.stratum_means(4), [-0.5, 0.5, 1.5, 2.5])


def test_the_density_of_a_tabulated_variable_is_that_of_its_quantiles():
    variable = Tabulated(distribution="tabulated", values=(0.0, 1.0, 1.5, 4.0))
    fine = np.linspace(-1.0, 5.0, 60_001)
    density = variable.density(fine)
    assert integrate.trapezoid(density, fine) == pytest.approx(1.0, abs=1e-3)
    assert integrate.trapezoid(fine * density, fine) == pytest.approx(variable.mean, abs=1e-3)
    # an even part of the probability between two values that follow each other
    assert integrate.quad(lambda value: float(variable.density(value)), 1.0, 1.5)[0] == pytest.approx(
        1.0 / 3.0
    )


@pytest.mark.parametrize(
    ("name", "entry", "line"),
    [
        (
            "extension.shapes.block.chamfer",
            {"distribution": "tabulated", "values": [2.0, 1.0]},
            "values that rise",
        ),
        (
            "extension.shapes.block.colour",
            {"distribution": "tabulated", "values": [1.0, 2.0]},
            "unknown parameter",
        ),
        ("shapes.block.box", {"distribution": "tabulated", "values": [1.0, 2.0]}, "unknown parameter"),
        ("extension.shapes.block.chamfer", {"distribution": "tabulated", "mean": 1.0}, "unknown key"),
    ],
)
def test_a_wrong_tabulated_variable_is_named(name, entry, line):
    with pytest.raises(InputError, match=line) as error:
        load_distributions({name: entry}, "study.yaml")
    assert f"study.yaml: distributions.{name}" in str(error.value)


@pytest.mark.parametrize(
    ("name", "unit"),
    [
        ("shapes.block.chamfer", "m"),
        ("bodies.block-2.mass_offset.x", "m"),
        ("joints.slab.block-1.compliance", "m3/N"),
        ("external_forces.0.amplitude", "N"),
    ],
)
def test_units_of_what_a_cause_states(name, unit):
    assert parameter_unit(f"extension.{name}") == unit


def loaded(**entry):
    return load_distributions({"friction.a.b": entry}, "study.yaml")["friction.a.b"]


@pytest.mark.parametrize(
    ("entry", "known"),
    [
        ({"distribution": "normal", "loc": 0.7, "scale": 0.07}, stats.norm(0.7, 0.07)),
        ({"distribution": "uniform", "loc": 0.4, "scale": 0.2}, stats.uniform(0.4, 0.2)),
        (
            {"distribution": "truncnorm", "a": -2, "b": 1.5, "loc": 0.7, "scale": 0.1},
            stats.truncnorm(-2, 1.5, 0.7, 0.1),
        ),
        ({"distribution": "lognorm", "s": 0.3, "scale": 0.7}, stats.lognorm(0.3, 0.0, 0.7)),
        ({"distribution": "beta", "a": 2.0, "b": 5.0}, stats.beta(2.0, 5.0)),
    ],
)
def test_a_name_of_scipy_is_that_distribution(entry, known):
    variable = loaded(**entry)
    chances = np.array([0.01, 0.3, 0.5, 0.99])
    np.testing.assert_array_equal(variable.quantile(chances), known.ppf(chances))
    np.testing.assert_array_equal(variable.density(known.ppf(chances)), known.pdf(known.ppf(chances)))
    assert variable.mean == pytest.approx(known.mean())
    assert variable.cov == pytest.approx(known.std() / known.mean())
    # medians of strata are exact quantiles, and means of strata average to the mean
    np.testing.assert_array_equal(variable.stratum_medians(10), known.ppf((np.arange(10) + 0.5) / 10))
    assert variable.stratum_means(10).mean() == pytest.approx(known.mean(), rel=1e-3)
    assert load_distributions({"friction.a.b": variable.model_dump(mode="json")}, "again") == {
        "friction.a.b": variable
    }


@pytest.mark.parametrize(
    "entry",
    [{"distribution": "normal"}, {"distribution": "uniform"}, {"distribution": "truncnorm", "a": -1, "b": 3}],
)
def test_mean_and_variation_may_tell_place_and_scale(entry):
    variable = loaded(**entry, mean=0.7, cov=0.1)
    assert variable.mean == pytest.approx(0.7)
    assert variable.cov == pytest.approx(0.1)
    strata = variable.stratum_means(10)
    assert strata.mean() == pytest.approx(0.7, rel=1e-3)


def test_a_lognormal_by_scipy_is_the_one_by_mean_and_variation():
    own = Lognormal(mean=0.75, cov=0.1)
    same = loaded(distribution="lognorm", s=own.log_deviation, scale=own.median)
    np.testing.assert_allclose(same.stratum_medians(50), own.stratum_medians(50), rtol=1e-12)


def test_a_discrete_variable_takes_each_value_as_often_as_it_is_probable():
    variable = loaded(distribution="discrete", values=[0.4, 0.6, 0.9], probabilities=[0.2, 0.5, 0.3])
    values, counts = np.unique(variable.stratum_medians(50), return_counts=True)
    np.testing.assert_array_equal(values, [0.4, 0.6, 0.9])
    np.testing.assert_array_equal(counts, [10, 25, 15])
    assert variable.mean == pytest.approx(0.65)
    assert variable.cov == pytest.approx(np.sqrt(0.2 * 0.0625 + 0.5 * 0.0025 + 0.3 * 0.0625) / 0.65)


def test_an_empirical_variable_gives_the_values_of_its_column_once_each(tmp_path):
    table = tmp_path / "tests.csv"
    values = [0.61, 0.55, 0.72, 0.55, 0.66, 0.58, 0.63, 0.7, 0.59, 0.64]
    table.write_text("specimen,mu\n" + "".join(f"{place},{one}\n" for place, one in enumerate(values)))
    variable = loaded(distribution="empirical", file=str(table), column="mu")
    np.testing.assert_array_equal(variable.stratum_medians(10), sorted(values))
    assert variable.median == 0.61  # the smallest value with half of the probability up to it
    assert isinstance(variable, Discrete)


@pytest.mark.parametrize(
    ("entry", "line"),
    [
        ({"distribution": "truncnorm", "a": -2, "mean": 0.7, "cov": 0.1}, r"b\.b: expected the keys a, b"),
        ({"distribution": "norml", "mean": 0.7, "cov": 0.1}, r"b\.distribution: expected lognormal"),
        ({"distribution": "normal", "mean": 0.7, "cov": 0}, r"b\.scale: "),
        ({"distribution": "norml"}, r"b\.distribution: expected lognormal, .* scipy\.stats such as norm"),
        ({"distribution": "poisson", "mu": 3}, "the name of a continuous distribution"),
        (
            {"distribution": "truncnorm", "a": -2},
            r"b\.b: expected the keys a, b, loc, scale, as scipy\.stats\.truncnorm",
        ),
        (
            {"distribution": "normal", "mean": 0.7},
            r"b\.mean: expected the keys loc, scale, as scipy\.stats\.norm",
        ),
        ({"distribution": "normal", "loc": 0.7, "scale": 0}, r"b\.scale: "),
        ({"distribution": "beta", "a": "x", "b": 2}, r"b\.a: input should be a valid number"),
        ({"distribution": "cauchy"}, "has a mean and a variance"),
        ({"distribution": "discrete", "values": [1, 2], "probabilities": [0.5, 0.6]}, "and a sum of 1"),
        ({"distribution": "discrete", "values": [2, 1]}, "values that rise"),
        ({"distribution": "empirical", "file": "none.csv"}, r"b\.file: none\.csv"),
    ],
)
def test_a_wrong_distribution_is_refused_with_its_key(entry, line):
    with pytest.raises(InputError, match=line) as error:
        loaded(**entry)
    assert str(error.value).startswith("study.yaml: distributions.friction.a.b")
