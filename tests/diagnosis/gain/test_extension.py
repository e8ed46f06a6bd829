"""The extended model: sizes from their posterior, and exactly the recalibrated model at the null size."""

import numpy as np
import pytest
from test_recalibration import World, draws_of, scores_of

from blockshake.diagnosis.gain.extension import (
    extended_members,
    members_at,
    open_features,
    open_responses,
    posterior_sizes,
)
from blockshake.diagnosis.gain.recalibration import posterior_draws
from blockshake.diagnosis.inference.candidate_scores import ScoreLibrary
from blockshake.diagnosis.libraries.candidates import Candidate
from blockshake.effects.registry import EFFECTS

COUNT, N_FEATURES = 40, 30
PITCH = Candidate("table-pitch", {})


class Known:
    """Two tests of one solver: linear features, an effect in a direction of its own, and a measurement with it."""

    def __init__(self, truth, size):
        generator = np.random.default_rng(11)
        self.world = World(11, 2 * N_FEATURES, noise=1.5)
        self.direction = 2.0 * generator.normal(size=2 * N_FEATURES)
        scores = generator.normal(size=(COUNT, 4))
        self.draws = draws_of(scores)
        nominal = self.world.features(scores, generator)
        sizes = np.array([PITCH.values(number)[1] for number in range(16)])
        with_effect = nominal[:16] + sizes[:, None] * self.direction
        halves = slice(0, N_FEATURES), slice(N_FEATURES, None)
        self.library = ScoreLibrary(
            [{"ls-dem": {"nominal": nominal[:, own], PITCH.key: with_effect[:, own]}} for own in halves],
            {"ls-dem": {PITCH.key: sizes}},
        )
        self.measured = self.world.features(np.atleast_2d(truth), generator)[0] + size * self.direction
        scores = self.library.score([self.measured[own] for own in halves])
        self.posterior = scores.sizes[PITCH.key], scores.weights[PITCH.key]
        self.features = open_features(self.library, "ls-dem")
        self.responses = open_responses(self.library, "ls-dem", PITCH.key)


@pytest.fixture(scope="module")
def known():
    return Known([1.0, -0.5, 0.0, 0.0], 1.2)


def test_sizes_are_medians_of_the_strata_of_their_posterior():
    grid = np.linspace(-1.0, 4.0, 21)
    weights = np.exp(-0.5 * ((grid - 1.5) / 0.6) ** 2)
    sizes = posterior_sizes(grid, weights / weights.sum(), 400)
    assert (np.diff(sizes) > 0.0).all()
    # a density straight between points a step of 0.25 apart is wider by the variance of a step, 0.25^2 / 6
    assert sizes.mean() == pytest.approx(1.5, abs=1e-3)
    assert sizes.std() == pytest.approx(np.sqrt(0.6**2 + 0.25**2 / 6.0), rel=5e-3)
    corner = posterior_sizes(grid, np.eye(21)[20], 10)
    assert (corner > 3.75).all()
    assert (corner < 4.0).all()


def test_at_the_null_size_members_are_the_recalibrated_ones(known):
    null = members_at(PITCH, np.zeros(20), known.draws, known.features, known.measured, known.responses)
    plain = posterior_draws(known.draws, known.features, known.measured).draws[:20]
    size = EFFECTS["table-pitch"].parameters[0]
    for (one, effects), other in zip(null, plain, strict=True):
        assert (one.parameters, one.amplitude, one.seed) == (other.parameters, other.amplitude, other.seed)
        assert effects[0]["values"][size.name] == size.null


def test_members_have_the_size_and_the_nominal_parameters_of_the_truth(known):
    members = extended_members(
        PITCH, known.posterior, known.draws, known.features, known.measured, known.responses, COUNT
    )
    size = EFFECTS["table-pitch"].parameters[0]
    sizes = np.array([effects[0]["values"][size.name] for _, effects in members])
    sizes = (sizes - size.null) / (size.visible - size.null)
    assert sizes.mean() == pytest.approx(1.2, abs=0.25)
    found = scores_of([draw for draw, _ in members])
    rival = scores_of(posterior_draws(known.draws, known.features, known.measured).draws)
    # the friction that was true is inside what the extended members have; one that makes up for the effect is wrong
    assert abs(found[:, 0].mean() - 1.0) < 3.0 * found[:, 0].std() + 0.3
    assert (
        np.abs(found[:, :2].mean(axis=0) - [1.0, -0.5]).sum()
        < np.abs(rival[:, :2].mean(axis=0) - [1.0, -0.5]).sum()
    )
    assert abs(np.corrcoef(np.arange(COUNT), sizes)[0, 1]) < 0.5


def test_members_are_the_same_every_time_and_other_parameters_are_the_library_s(known):
    one, two = (
        extended_members(
            PITCH, known.posterior, known.draws, known.features, known.measured, known.responses, 12
        )
        for _ in range(2)
    )
    assert [effects for _, effects in one] == [effects for _, effects in two]
    for number, (_, (effect,)) in enumerate(one):
        own, _ = PITCH.values(number)
        size, *others = EFFECTS["table-pitch"].parameters
        for item in others:
            assert effect["values"][item.name] == own[item.name]
        assert size.lower <= effect["values"][size.name] <= size.upper


def test_values_at_a_size_are_those_of_the_library():
    for number in range(5):
        values, size = PITCH.values(number)
        assert PITCH.values_at(size, number) == pytest.approx(values)
