import numpy as np
import pytest

from blockshake.errors import InputError
from blockshake.study.ensembles.coverage import compared_curves, coverage, members_inside

NOISE = 1e-4  # m


def _levels(make_run, gather, levels):
    return gather([make_run(level) for level in levels])


def _members_coverage(measured, ensemble):
    """Coverage of each member by the others at the first block, without noise."""
    read, _, curves, readings = compared_curves(measured, ensemble, 0.0, 0)
    return members_inside(curves, readings)[:, list(read["marker"].values).index("block-1-face")]


def test_a_curve_inside_for_three_quarters_of_the_time(make_run, gather):
    ensemble = _levels(make_run, gather, [0.01, 0.02, 0.03])
    time = make_run(0.0)["time"].to_numpy()
    measured = make_run(np.where(time < 0.5, 0.05, 0.025))
    result = coverage(measured, ensemble, marker_noise=0.0)
    # 401 times: 0 is common, 99 up to 0.495 s are outside
    assert result["coverage"].sel(marker="block-1-face") == pytest.approx(302 / 401)
    assert result["coverage"].sel(marker="slab-face") == 1.0


def test_members_are_held_against_the_others(make_run, gather):
    measured, ensemble = make_run(0.02), _levels(make_run, gather, [0.01, 0.02, 0.03, 0.025])
    result = coverage(measured, ensemble, marker_noise=0.0)
    # the lowest and the highest are outside the band of the others but for the first time
    np.testing.assert_allclose(_members_coverage(measured, ensemble), [1 / 401, 1.0, 1 / 401, 1.0])
    assert result["reference"].sel(marker="block-1-face", quantile=0.5) == pytest.approx((1 / 401 + 1.0) / 2)


def test_equal_members_support_each_other(make_run, gather):
    result = coverage(make_run(0.02), _levels(make_run, gather, [0.02, 0.02, 0.02]), marker_noise=0.0)
    np.testing.assert_array_equal(result["reference"], 1.0)


def test_the_reference_carries_the_noise_of_the_measurement(make_run, gather, read_with_noise):
    # a band of no width: the noisy curve is outside it nearly always, and so is a noisy member
    ensemble = _levels(make_run, gather, [0.02] * 20)
    result = coverage(read_with_noise(make_run(0.02), NOISE, 1), ensemble, NOISE)
    assert result["coverage"].sel(marker="block-1-face") < 0.05
    assert result["reference"].sel(marker="block-1-face", quantile=0.95) < 0.05
    assert result.attrs["synthetic"] == 1


def test_a_further_draw_scores_like_the_members(make_run, gather):
    generator = np.random.default_rng(2)
    time = make_run(0.0)["time"].to_numpy()

    def draw():
        return make_run(
            sum(generator.normal(0, 0.01) * np.sin(k * time + generator.uniform(0, 6)) for k in range(1, 6))
        )

    ranks = []
    for _ in range(30):
        measured, ensemble = draw(), gather([draw() for _ in range(12)])
        of_members = _members_coverage(measured, ensemble)
        inside = float(coverage(measured, ensemble, marker_noise=0.0)["coverage"].sel(marker="block-1-face"))
        lower = (of_members < inside).mean()
        equal = (of_members == inside).mean()
        ranks.append(float(lower + equal / 2))
    # exchangeable draws have mid-ranks of mean 1/2, standard error at most 0.29 / sqrt(30); bounds from one
    # member less, 10/12 against 11/13 expected inside, cost the members next to nothing in rank
    assert np.mean(ranks) == pytest.approx(0.5, abs=3 * 0.29 / np.sqrt(30))


def test_gaps_do_not_count(make_run, gather):
    measured = make_run(0.02)
    measured["marker_displacement"][200:] = np.nan
    measured["marker_displacement"][100:150, 1, 0] = 1.0
    result = coverage(measured, _levels(make_run, gather, [0.01, 0.02, 0.03]), marker_noise=0.0)
    assert result["coverage"].sel(marker="block-1-face") == pytest.approx(150 / 200)


def test_the_band_of_collapsed_members_ends_with_them(make_run, gather):
    ensemble = gather([make_run(0.01, status="collapsed", end=1.0)] * 3 + [make_run(9.0, status="diverged")])
    result = coverage(make_run(0.01), ensemble, marker_noise=0.0)
    assert result["coverage"].sel(marker="block-1-face") == 1.0
    assert result.attrs["counted"] == 3


def test_what_cannot_be_compared_is_refused(make_run, gather):
    ensemble = _levels(make_run, gather, [0.01, 0.02, 0.03])
    run = make_run(0.02)
    with pytest.raises(InputError, match="measured times within the ensemble's"):
        coverage(run.assign_coords(time=run["time"] + 100.0), ensemble, NOISE)
    with pytest.raises(InputError, match="measured marker"):
        coverage(run.assign_coords(marker=["a", "b"]), ensemble, NOISE)


def test_a_miss_is_seen_where_the_band_is_thinner_than_the_noise(make_run, gather, read_with_noise):
    """Members within 1 nm and noise of 0.1 mm: all coverages are alike, whatever is compared."""
    ensemble = gather([make_run(0.02 + 1e-10 * place) for place in range(30)])
    near, far = (
        coverage(read_with_noise(make_run(level), NOISE, 7), ensemble, NOISE) for level in (0.02, 0.144)
    )
    near, far = near.sel(marker="block-1-face"), far.sel(marker="block-1-face")
    assert float(near["coverage"]) < 0.05
    assert float(near["curve_probability"]) > 0.1
    assert float(near["distance"]) == pytest.approx(1.0, abs=0.6)
    assert float(far["curve_probability"]) == pytest.approx(1.0 / 31.0)
    assert float(far["distance"]) == pytest.approx(0.124 / (np.sqrt(2.0) * NOISE), rel=0.02)


def test_the_chance_of_a_whole_curve_is_calibrated(make_run, gather):
    """Draws of the same distribution fall below 0.1 in at most a tenth of the cases, a larger motion nearly always."""
    generator = np.random.default_rng(5)
    time = make_run(0.0)["time"].to_numpy()

    def draw(size=1.0):
        terms = (generator.normal(0, 0.01) * np.sin(k * time + generator.uniform(0, 6)) for k in range(1, 6))
        return make_run(size * sum(terms))

    alike, larger = [], []
    for _ in range(20):
        ensemble = gather([draw() for _ in range(19)])
        for size, found in ((1.0, alike), (8.0, larger)):
            result = coverage(draw(size), ensemble, marker_noise=0.0)
            found.append(float(result["curve_probability"].sel(marker="block-1-face")))
    assert min(alike + larger) >= 1.0 / 20.0
    # 2 of 20 expected at the most, with a standard deviation of 1.35
    assert np.sum(np.array(alike) <= 0.1) <= 2 + 3 * 1.35
    assert np.mean(np.array(larger) <= 0.1) > 0.8


@pytest.mark.parametrize("size", [0, 1, 2])
def test_too_few_members_are_no_reference(make_run, gather, size):
    status = ["completed"] * size + ["not-converged"]
    ensemble = gather([make_run(0.02, status=one) for one in status])
    found = coverage(make_run(0.03), ensemble, NOISE)
    for name in ("coverage", "reference", "distance", "curve_probability"):
        assert np.isnan(found[name]).all()
    assert found.attrs["counted"] == size
