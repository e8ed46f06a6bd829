"""Scores of windows on Gaussian innovations of a known law."""

import numpy as np
import pytest

from blockshake.diagnosis.window_scores import Innovations, score_windows

N_WINDOWS, N_COORDINATES = 20, 4
SIZES = np.linspace(-2.0, 2.0, 21)


class World:
    """Scatter, shared errors and tangents that differ from window to window."""

    def __init__(self):
        generator = np.random.default_rng(3)
        self.root = 1e-4 * generator.normal(0.0, 1.0, (N_WINDOWS, N_COORDINATES, N_COORDINATES))
        self.root += 3e-4 * np.eye(N_COORDINATES)
        self.covariance = self.root @ self.root.transpose(0, 2, 1)
        self.shared = 2e-3 * generator.normal(0.0, 1.0, (N_WINDOWS, N_COORDINATES, 3))
        self.tangent = 1e-3 * generator.normal(0.0, 1.0, (N_WINDOWS, N_COORDINATES))

    def draw(self, seed, size=0.0):
        generator = np.random.default_rng([11, seed])
        own = np.einsum("wij,wj->wi", self.root, generator.normal(0.0, 1.0, (N_WINDOWS, N_COORDINATES)))
        values = own + self.shared @ generator.normal(0.0, 1.0, 3) + size * self.tangent
        return Innovations(values, self.covariance, self.shared)


@pytest.fixture(scope="module")
def world():
    return World()


def test_t_has_unit_variance_without_an_effect_though_the_model_errs(world):
    t = [score_windows(world.draw(seed), world.tangent, SIZES, [seed]).t for seed in range(300)]
    # 300 draws: the variance's own standard deviation is 0.08
    assert np.mean(t) == pytest.approx(0.0, abs=0.2)
    assert np.var(t) == pytest.approx(1.0, abs=0.25)


def test_the_size_of_an_effect_is_found_and_the_density_prefers_it(world):
    scores = [score_windows(world.draw(seed, size=0.7), world.tangent, SIZES, [seed]) for seed in range(50)]
    sizes = np.array([score.size for score in scores])
    errors = sizes / np.array([score.t for score in scores])
    assert np.mean(sizes) == pytest.approx(0.7, abs=0.02)
    assert np.std(sizes) == pytest.approx(np.mean(errors), rel=0.3)
    assert min(score.density - score.null_density for score in scores) > 3.0
    without = [score_windows(world.draw(seed), world.tangent, SIZES, [seed]) for seed in range(50)]
    assert np.mean([score.density - score.null_density for score in without]) < -1.0


def test_an_effect_that_the_model_s_own_uncertainty_imitates_is_not_told(world):
    same = world.shared[:, :, 0]
    scores = [score_windows(world.draw(seed), same, SIZES, [seed]) for seed in range(50)]
    assert max(abs(score.density - score.null_density) for score in scores) < 3.0


def test_a_size_far_finer_than_the_prior_s_grid_is_not_missed(world):
    steep = 300.0 * world.tangent
    score = score_windows(world.draw(1, size=0.07 * 300.0), steep, SIZES, [1])
    assert score.size == pytest.approx(0.07, abs=1e-3)
    assert score.density - score.null_density > 50.0


def test_what_was_not_measured_says_nothing(world):
    whole, gap = world.draw(5), world.draw(5)
    gap.values[3:9] = np.nan
    kept = np.r_[0:3, 9:N_WINDOWS]
    fewer = Innovations(whole.values[kept], whole.covariance[kept], whole.shared[kept])
    found = score_windows(gap, world.tangent, SIZES, [1])
    other = score_windows(fewer, world.tangent[kept], SIZES, [1])
    assert found.t == pytest.approx(other.t)
    assert found.density - found.null_density == pytest.approx(other.density - other.null_density)


def test_the_standard_error_is_the_scatter_from_test_to_test_where_windows_are_alike():
    generator = np.random.default_rng(8)
    nothing = np.zeros((N_WINDOWS, N_COORDINATES, 1))
    covariance = np.tile(np.eye(N_COORDINATES), (N_WINDOWS, 1, 1))
    tangent = np.ones((N_WINDOWS, N_COORDINATES))
    gains, errors = [], []
    for seed in range(150):
        values = tangent + generator.normal(0.0, 1.0, tangent.shape)
        score = score_windows(Innovations(values, covariance, nothing), tangent, SIZES, [seed])
        gains.append(score.density - score.null_density)
        errors.append(score.error)
    assert np.mean(errors) == pytest.approx(np.std(gains), rel=0.2)
