"""Scores of ensembles cell by cell; a cell is the features of one family in one test."""

from dataclasses import dataclass

import numpy as np

from blockshake.diagnosis.gain.sealed_prediction import family


@dataclass(frozen=True)
class Cells:
    """Cells of some tests.

    Attributes
    ----------
    tests : int array, shape (n_cells,)
        Number of the test.
    families : list of str, length n_cells
    places : list of int array
        Of the cell's features in the test.
    """

    tests: np.ndarray
    families: list
    places: list

    def weights(self, tests, within):
        """Weight of each cell in a mean over tests of the mean over features.

        Parameters
        ----------
        tests : float64 array, shape (n_tests,)
            Count of each test.
        within : float64 array, shape (n_cells,)
            Count of each cell in its test.

        Returns
        -------
        float64 array, shape (n_cells,)
            Their sum is 1.
        """
        count = within * [len(places) for places in self.places]
        return (tests / tests.sum())[self.tests] * count / np.bincount(self.tests, count)[self.tests]


@dataclass(frozen=True)
class Distances:
    """Distances of an ensemble's members from the measured values and from each other.

    Attributes
    ----------
    models : str array, shape (n_members,)
        Solver of each member.
    record : float64 array, shape (n_cells, n_members)
        From the measured values, mean over the features of the cell.
    pairs : float64 array, shape (n_cells, n_members, n_members)
        Between two members.
    """

    models: np.ndarray
    record: np.ndarray
    pairs: np.ndarray

    def scores(self, weights):
        """Continuous ranked probability score by cell, and the floor that noise and chaos set.

        Parameters
        ----------
        weights : float64 array, shape (n_members,)
            Sum 1; members of both solvers weigh alike by `even_weights`.

        Returns
        -------
        scores, floor : float64 arrays, shape (n_cells,)

        Notes
        -----
        ``sum_i w_i |X_i - y| - sum_ij w_i w_j |X_i - X_j| / (2 (1 - sum_i w_i^2))``: the score fair to small ensembles
        (Ferro 2014), `blockshake.study.ensembles.scores.crps` where all weights are equal; members that a bootstrap
        drew twice are no pair. In the mean over members, each scored by the others, this is the second sum: the floor.
        """
        floor = 0.5 * (self.pairs @ weights @ weights) / (1.0 - weights @ weights)
        return self.record @ weights - floor, floor

    def own_scores(self):
        """Score of each member by the others, shape (n_cells, n_members), as `curve_scores.members_crps`."""
        count = self.pairs.shape[-1]
        from_others = self.pairs.sum(axis=-1)
        pairs = 0.5 * from_others.sum(axis=-1, keepdims=True)
        return from_others / (count - 1) - (pairs - from_others) / ((count - 1) * (count - 2))

    def even_weights(self, models):
        """Weights of members, sum 1: these solvers count alike, and so do the members of each."""
        return sum((self.models == model) / (self.models == model).sum() for model in models) / len(models)

    def drawn_weights(self, models, seed):
        """The same for members drawn anew, solver by solver; one seed draws alike from ensembles of one size."""
        drawn = np.zeros(len(self.models))
        for model in models:
            own = np.flatnonzero(self.models == model)
            generator = np.random.default_rng([seed, len(own)])
            drawn += np.bincount(generator.choice(own, len(own)), minlength=len(drawn)) / len(own)
        return drawn / len(models)


def cells_of(tests):
    """`Cells` of a list of `SealedTest`."""
    found = [
        (number, name, np.flatnonzero([family(one) == name for one in test.features]))
        for number, test in enumerate(tests)
        for name in dict.fromkeys(family(one) for one in test.features)
    ]
    numbers, families, places = zip(*found, strict=True)
    return Cells(np.array(numbers), list(families), list(places))


def distances(tests, cells, kind):
    """`Distances` of one kind of ensemble, by its name, from its tests and their `Cells`.

    ``tests``: list of `SealedTest`, with the same members in all, in one order.
    """
    by_model = tests[0].members[kind]
    record, pairs = [], []
    for number, places in zip(cells.tests, cells.places, strict=True):
        values = np.concatenate([runs[:, places] for runs in tests[number].members[kind].values()])
        record.append(np.abs(values - tests[number].measured[places]).mean(axis=1))
        pairs.append(sum(np.abs(column[:, None] - column) for column in values.T) / len(places))
    return Distances(
        models=np.repeat(list(by_model), [len(runs) for runs in by_model.values()]),
        record=np.array(record),
        pairs=np.array(pairs),
    )
