"""Scores of all candidates against the nominal model, over all tests and both solvers."""

from dataclasses import dataclass

import numpy as np
from scipy.special import logsumexp

from blockshake.diagnosis.model_evidence import ModelEvidence, size_grid


@dataclass(frozen=True)
class Scores:
    """What a set of tests says of each candidate.

    Attributes
    ----------
    log_ratio : dict of str to float
        By candidate: log density with it, over its prior of sizes, less that of the nominal model [1]. In both the
        solvers are equally likely.
    size : dict of str to float
        By candidate: size of the largest density, in units of the visible one.
    sizes, weights : dict of str to float64 array, shape (n_sizes,)
        By candidate: posterior of the size.
    distance : dict of str to float
        By candidate and ``nominal``: squared distance per feature at the best size and solver [1].
    model : dict of str to str
        By candidate and ``nominal``: the solver that predicts best.
    """

    log_ratio: dict
    size: dict
    sizes: dict
    weights: dict
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

    def score(self, features, model=None, left_out=None):
        """Scores of one set of readings.

        Parameters
        ----------
        features : list of float64 array, shape (n_features,)
            By test, tamed.
        model : str, optional
        left_out : int, optional
            Solver and draw of the library that these readings come from: then that draw, in all its tests and with all
            its candidates, is left out of the library.

        Returns
        -------
        Scores
        """
        nominal, with_effect, squares = {}, {}, {}
        n_features = sum(len(own) for own in features)
        for name in self.models:
            out = left_out if name == model else None
            parts = [self._evidence(test, name, out) for test in range(len(features))]
            alone = [part.nominal(own) for part, own in zip(parts, features, strict=True)]
            nominal[name] = sum(density for density, _ in alone)
            squares["nominal", name] = sum(square for _, square in alone)
            for key in self.candidates:
                both = [part.candidate(key, own) for part, own in zip(parts, features, strict=True)]
                with_effect[key, name] = sum(density for density, _ in both)
                squares[key, name] = sum(square for _, square in both)
        plain = logsumexp(list(nominal.values())) - np.log(len(self.models))
        best = max(self.models, key=nominal.get)
        scores = Scores({}, {}, {}, {}, {"nominal": squares["nominal", best] / n_features}, {"nominal": best})
        for key in self.candidates:
            by_size = np.array([with_effect[key, name] for name in self.models])
            grid = size_grid(self.sizes[self.models[0]][key])
            scores.log_ratio[key] = float(logsumexp(by_size) - np.log(by_size.size) - plain)
            solver, place = np.unravel_index(by_size.argmax(), by_size.shape)
            scores.model[key] = self.models[solver]
            scores.size[key] = float(grid[place])
            scores.sizes[key] = grid
            scores.weights[key] = np.exp(logsumexp(by_size, axis=0) - logsumexp(by_size))
            scores.distance[key] = float(squares[key, self.models[solver]][place] / n_features)
        return scores

    def _evidence(self, test, model, left_out):
        key = (test, model, left_out)
        if key not in self._known:
            runs = self.tamed[test][model]
            with_effect = {name: runs[name] for name in self.candidates}
            self._known[key] = ModelEvidence(runs["nominal"], with_effect, self.sizes[model], left_out)
        return self._known[key]
