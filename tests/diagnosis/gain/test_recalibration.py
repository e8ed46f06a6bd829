"""Recalibration in worlds where features are linear in Gaussian parameters, so that the posterior is known."""

from dataclasses import replace

import numpy as np
from scipy.special import ndtr, ndtri

from blockshake.diagnosis.gain.recalibration import posterior_draws
from blockshake.diagnosis.nominal.nominal_model import Draw

FRICTION, DENSITY, SPACING = 0.10, 0.04, (0.3, 0.6)
NAMES = ("friction.concrete.concrete", "materials.concrete.density", "ls_dem.node_spacing", "amplitude")


def draws_of(scores):
    """Draws whose four varied parameters have these standard normal scores."""
    return [
        Draw(
            model="ls-dem",
            time_step=5e-5,
            parameters={
                NAMES[0]: float(0.75 * np.exp(FRICTION * a)),
                NAMES[1]: float(2400.0 * np.exp(DENSITY * b)),
                NAMES[2]: float(SPACING[0] + (SPACING[1] - SPACING[0]) * ndtr(c)),
                "ls_dem.normal_stiffness": 1e9,
            },
            amplitude=float(np.exp(0.01 * d)),
            fast=0.0,
            noise={},
            places=np.full((3, 3), 1e-4 * number),
            seed=number,
        )
        for number, (a, b, c, d) in enumerate(scores)
    ]


def scores_of(draws):
    share = np.array([draw.parameters[NAMES[2]] for draw in draws])
    return np.column_stack(
        [
            np.log([draw.parameters[NAMES[0]] / 0.75 for draw in draws]) / FRICTION,
            np.log([draw.parameters[NAMES[1]] / 2400.0 for draw in draws]) / DENSITY,
            # the ends that draws tell are not quite those of the law
            ndtri(np.clip((share - SPACING[0]) / (SPACING[1] - SPACING[0]), 0.002, 0.998)),
            np.log([draw.amplitude for draw in draws]) / 0.01,
        ]
    )


def informed(draws, conditioned):
    """Whether each parameter is another one after the conditioning in any draw."""
    before, after = (
        np.array([[*(draw.parameters[name] for name in NAMES[:3]), draw.amplitude] for draw in own])
        for own in (draws, conditioned)
    )
    return (before != after).any(axis=0).tolist()


class World:
    """Features = mixing @ scores + noise; the first three scores tell in them, the amplitude does not."""

    def __init__(self, seed, n_features, noise=1.0):
        generator = np.random.default_rng([seed, n_features])
        self.mixing = generator.normal(0.0, 1.0, (n_features, 4)) * [1.0, 0.7, 0.5, 0.0]
        self.noise = noise

    def features(self, scores, generator):
        return scores @ self.mixing.T + generator.normal(0.0, self.noise, (len(scores), len(self.mixing)))

    def posterior(self, measured):
        """Mean and covariance of the scores given features, exactly."""
        precision = np.eye(4) + self.mixing.T @ self.mixing / self.noise**2
        covariance = np.linalg.inv(precision)
        return covariance @ self.mixing.T @ measured / self.noise**2, covariance


def test_many_draws_give_the_posterior_of_theory():
    generator = np.random.default_rng(1)
    world, count = World(1, 8, noise=2.0), 250
    scores = generator.normal(size=(count, 4))
    measured = world.features(np.array([[1.0, -0.8, 0.5, 0.0]]), generator)[0]
    draws = draws_of(scores)
    conditioned = posterior_draws(draws, world.features(scores, generator), measured)
    found = scores_of(conditioned)
    mean, covariance = world.posterior(measured)
    deviation = np.sqrt(np.diag(covariance))
    # a gain learnt from n draws in n_features directions adds about sqrt((n_features + 1) / n) of the deviation
    error = 4.0 * np.sqrt((8 + 1) / count) * deviation
    assert (np.abs(found.mean(axis=0) - mean) < error).all()
    np.testing.assert_allclose(
        found.std(axis=0, ddof=1), deviation, rtol=4.0 / np.sqrt(2 * count) + 9 / count
    )
    assert informed(draws, conditioned) == [True, True, True, False]


def test_few_draws_and_many_features_are_neither_too_sure_nor_useless():
    generator = np.random.default_rng(2)
    z, errors, theory = [], [], []
    for case in range(40):
        world = World(case, 150, noise=6.0)
        scores, truth = generator.normal(size=(40, 4)), generator.normal(size=(1, 4))
        measured = world.features(truth, generator)[0]
        found = scores_of(posterior_draws(draws_of(scores), world.features(scores, generator), measured))
        z.append((truth[0] - found.mean(axis=0)) / found.std(axis=0, ddof=1))
        errors.append(truth[0] - found.mean(axis=0))
        theory.append(np.diag(world.posterior(measured)[1]))
    z, error = np.array(z), np.sqrt(np.mean(np.square(errors), axis=0))
    # mean square of 40 standardised errors by parameter: within 4 standard errors of 1, and Student's t of few draws
    assert (np.mean(z**2, axis=0) < 1.1 + 4.0 * np.sqrt(2.0 / 40)).all()
    assert (np.mean(z**2, axis=0) > 1.0 - 4.0 * np.sqrt(2.0 / 40)).all()
    # better than the prior's 1 where the features tell, never better than the theory that knows the world
    assert error[0] < 0.75
    assert (error[:3] > 0.7 * np.sqrt(np.mean(theory, axis=0)[:3])).all()


def test_features_that_tell_nothing_leave_the_prior():
    generator = np.random.default_rng(3)
    moved = []
    for _ in range(25):
        draws = draws_of(generator.normal(size=(40, 4)))
        conditioned = posterior_draws(
            draws, generator.normal(size=(40, 200)), generator.normal(3.0, 1.0, 200)
        )
        moved += informed(draws, conditioned)
    # 100 parameters at a chance of 1 %: more than 5 are seen in 3 of 10 000 such tests
    assert sum(moved) <= 5


def test_an_absurd_feature_counts_as_one_at_the_edge_of_the_draws():
    generator = np.random.default_rng(5)
    world = World(5, 30)
    scores = generator.normal(size=(40, 4))
    draws, features = draws_of(scores), world.features(scores, generator)
    usual = world.features(np.array([[0.5, 0.0, 0.0, 0.0]]), generator)[0]
    edge, far = usual.copy(), usual.copy()
    edge[3] = features[:, 3].mean() + 3.0 * features[:, 3].std(ddof=1)
    far[3] = 16000.0
    at_edge, beyond = (posterior_draws(draws, features, measured) for measured in (edge, far))
    np.testing.assert_allclose(scores_of(beyond), scores_of(at_edge), rtol=1e-9)


def test_a_misfit_of_all_features_does_not_move_parameters_out_of_their_prior():
    generator = np.random.default_rng(5)
    world = World(5, 30)
    scores = generator.normal(size=(40, 4))
    draws = draws_of(scores)
    conditioned = posterior_draws(draws, world.features(scores, generator), 300.0 * world.mixing[:, 0])
    prior, friction = scores_of(draws)[:, 0], scores_of(conditioned)[:, 0]
    stop = prior.mean() + 3.0 * prior.std(ddof=1)
    assert np.isclose(friction, stop).mean() > 0.5
    for draw in conditioned:
        assert 0.75 < draw.parameters[NAMES[0]] < 0.75 * np.exp(4.0 * FRICTION)
        assert SPACING[0] * 0.9 < draw.parameters[NAMES[2]] < SPACING[1] * 1.1


def test_what_is_drawn_evenly_in_its_logarithm_stays_between_its_ends():
    generator = np.random.default_rng(8)
    share = generator.uniform(size=40)
    draws = [
        replace(draw, parameters={"shapes.block.hollow": float(1e-5 * 300.0**one)})
        for draw, one in zip(draws_of(np.zeros((40, 4))), share, strict=True)
    ]
    features = ndtri(share)[:, None] + generator.normal(0.0, 0.3, (40, 1))
    conditioned = posterior_draws(draws, features, np.array([2.5]))
    found = np.array([draw.parameters["shapes.block.hollow"] for draw in conditioned])
    reach = 300.0 ** ((share.max() - share.min()) / 39)  # the ends as 40 draws tell them
    assert found.max() < 1e-5 * 300.0 ** share.max() * reach
    # theory: a score of 2.5 / (1 + 0.3^2), 0.989 of the way up
    assert np.median(np.log(found / 1e-5) / np.log(300.0)) > 0.9
