"""Scores of all candidates against the nominal model, over all tests and both solvers."""

from dataclasses import dataclass

import numpy as np
from scipy.special import logsumexp

from blockshake.diagnosis.inference.model_evidence import ModelEvidence, size_grid
from blockshake.diagnosis.libraries.candidates import effect_of


@dataclass(frozen=True)
class Scores:
    """Scores of each candidate on a set of tests.

    Attributes
    ----------
    log_ratio : dict of str to float
        By candidate: log density with it, over its prior of sizes, less that of the nominal model [1]. In both the
        solvers are equally likely.
    by_model : dict of str to dict of str to float
        The same by candidate and solver, with the nominal model of that solver.
    size : dict of str to float
        By candidate: size of the largest density, in units of the visible one.
    sizes, weights : dict of str to float64 array, shape (n_sizes,)
        By candidate: posterior of the size.
    by_test : dict of str to float64 array, shape (n_tests, n_sizes)
        By candidate: log density of each test at each size, by the solver that predicts best.
    distance : dict of str to float
        By candidate and ``nominal``: squared distance per feature at the best size and solver [1].
    model : dict of str to str
        By candidate and ``nominal``: the solver that predicts best.
    """

    log_ratio: dict
    by_model: dict
    size: dict
    sizes: dict
    weights: dict
    by_test: dict
    distance: dict
    model: dict


class ScoreLibrary:
    """Libraries of several tests and solvers, ready to score readings.

    Parameters
    ----------
    tamed : list of dict of str to dict of str to float64 array
        By test: as from `tame`.
    sizes : dict of str to dict of str to float64 array, shape (n_own_draws,)
        By solver and candidate, the same in all tests.
    """

    def __init__(self, tamed, sizes):
        self.tamed, self.sizes = tamed, sizes
        self.models = list(tamed[0])
        self.candidates = [key for key in tamed[0][self.models[0]] if key != "nominal"]
        self._known = {}

    def grid(self, key):
        """Sizes at which a candidate is tried."""
        return size_grid(self.sizes[self.models[0]][key])

    def score(self, features, model=None, left_out=None):
        """`Scores` of one set of readings.

        Parameters
        ----------
        features : list of float64 array, shape (n_features,)
            By test, tamed.
        model : str, optional
        left_out : int, optional
            Solver and draw of the library that these readings come from: then that draw, in all its tests and with all
            its candidates, is left out of the library.
        """
        parts = self._parts(len(features), model, left_out)

        def predicted(key):
            """Log densities and squared distances by solver, test and size."""
            pairs = [
                [
                    part.candidate(key, own) if key else part.nominal(own)
                    for part, own in zip(row, features, strict=True)
                ]
                for row in parts
            ]
            return np.moveaxis(np.array(pairs), 2, 0)

        return self._as_scores(predicted, self.candidates, features)

    def score_beside(self, features, first, size):
        """Scores of every candidate beside a first one of a given size, against that one alone.

        Candidates of the first one's own effect are left out. Two effects together are taken to add the sum of both.
        """
        parts = self._parts(len(features), None, None)
        place = int(np.argmin(np.abs(self.grid(first) - size)))
        beside = {}
        for part in (part for row in parts for part in row):
            one = part.responses[first]
            beside[id(part)] = one.mean[[place]], one.covariance()[[place]]

        def predicted(key):
            pairs = []
            for row in parts:
                pairs.append([])
                for part, own in zip(row, features, strict=True):
                    added, covariance = beside[id(part)]
                    if key:
                        other = part.responses[key]
                        added, covariance = added + other.mean, covariance + other.covariance()
                    density, square = part.with_response(own, added, covariance)
                    pairs[-1].append((density, square) if key else (density[0], square[0]))
            return np.moveaxis(np.array(pairs), 2, 0)

        others = [key for key in self.candidates if effect_of(key) != effect_of(first)]
        return self._as_scores(predicted, others, features)

    def placebo_ratios(self, features, count):
        """Log ratios of candidates that mean nothing: responses of true ones with their features exchanged.

        Parameters
        ----------
        features : list of float64 array, shape (n_features,)
        count : int
            Of placebos; they are made of the candidates in turn.

        Returns
        -------
        float64 array, shape (count,)
        """
        parts = self._parts(len(features), None, None)
        nominal = [
            sum(part.nominal(own)[0] for part, own in zip(row, features, strict=True)) for row in parts
        ]
        found = []
        for number in range(count):
            key = self.candidates[number % len(self.candidates)]
            by_size = []
            for row in parts:
                densities = 0.0
                for test, (part, own) in enumerate(zip(row, features, strict=True)):
                    # one exchange a test, the same for both solvers
                    order = np.random.default_rng([number, test]).permutation(len(own))
                    response = part.responses[key].exchanged(order)
                    density, _ = part.with_response(own, response.mean, response.covariance())
                    densities = densities + density
                by_size.append(densities)
            found.append(_mean_density(by_size) - _mean_density(nominal))
        return np.array(found)

    def forget(self, model, left_out):
        """Drop what was computed with a draw left out."""
        for test in range(len(self.tamed)):
            self._known.pop((test, model, left_out), None)

    def _as_scores(self, predicted, candidates, features):
        n_features = sum(len(own) for own in features)
        densities, squares = predicted(None)  # by solver and test
        nominal = densities.sum(axis=1)
        best = int(nominal.argmax())
        scores = Scores(
            {}, {}, {}, {}, {}, {},
            {"nominal": squares[best].sum() / n_features}, {"nominal": self.models[best]},
        )  # fmt: skip
        for key in candidates:
            densities, squares = predicted(key)
            by_size = densities.sum(axis=1)
            grid = self.grid(key)
            scores.log_ratio[key] = _mean_density(by_size) - _mean_density(nominal)
            scores.by_model[key] = {
                name: _mean_density(own) - float(alone)
                for name, own, alone in zip(self.models, by_size, nominal, strict=True)
            }
            solver, place = np.unravel_index(by_size.argmax(), by_size.shape)
            scores.model[key] = self.models[solver]
            scores.size[key] = float(grid[place])
            scores.sizes[key] = grid
            scores.weights[key] = np.exp(logsumexp(by_size, axis=0) - logsumexp(by_size))
            scores.by_test[key] = densities[solver]
            scores.distance[key] = float(squares[solver, :, place].sum() / n_features)
        return scores

    def _parts(self, n_tests, model, left_out):
        """Evidence by solver and test."""
        return [
            [self.evidence(test, name, left_out if name == model else None) for test in range(n_tests)]
            for name in self.models
        ]

    def evidence(self, test, model, left_out=None):
        """Evidence of one test by one solver, with a draw of the library left out or none."""
        key = (test, model, left_out)
        if key not in self._known:
            runs = self.tamed[test][model]
            with_effect = {name: runs[name] for name in self.candidates}
            whole = None if left_out is None else self.evidence(test, model, None)
            self._known[key] = ModelEvidence(runs["nominal"], with_effect, self.sizes[model], left_out, whole)
        return self._known[key]


def _mean_density(densities):
    """Logarithm of the mean of densities given by their logarithms."""
    return float(logsumexp(densities) - np.log(np.size(densities)))
