"""Faults as unknowns of linear equations, each tied to zero by what a faultless sensor may have, named one by one."""

from itertools import product
from typing import NamedTuple

import numpy as np

from blockshake.parity.finding import chance_within

_VAGUE = 1e3  # times a tolerance: as good as unknown


class Fault(NamedTuple):
    """Hypothesis of a fault: its `Column`, its sensor, and its test where it is one test's alone."""

    column: object
    sensor: int
    test: int = 0


class Unknowns:
    """Sizes of all faults of all sensors of one sort in all tests, as one vector.

    Parameters
    ----------
    columns : sequence of Column
    n_sensors, n_tests : int
    """

    def __init__(self, columns, n_sensors, n_tests):
        # numbers of the unknowns in the vector: Column to int array, shape (n_tests or 1, n_sensors, components)
        self.numbers, tolerances = {}, [np.empty(0)]
        for column in columns:
            shape = n_tests if column.by_test else 1, n_sensors, column.components
            first = sum(map(len, tolerances))
            self.numbers[column] = first + np.arange(np.prod(shape)).reshape(shape)
            tolerances.append(np.full(np.prod(shape), column.tolerance))
        self.spread = np.concatenate(tolerances) / 2.0  # standard deviation of each before anything is read

    def of(self, fault):
        """Numbers of a fault's unknowns."""
        return self.numbers[fault.column][fault.test, fault.sensor]

    def of_test(self, test):
        """Numbers of all unknowns in the equations of a test, column by column and sensor by sensor."""
        return np.concatenate(
            [numbers[test if len(numbers) > 1 else 0].ravel() for numbers in self.numbers.values()]
        )

    def freed(self, faults):
        """Spread with some faults as good as unknown."""
        spread = self.spread.copy()
        for fault in faults:
            spread[self.of(fault)] *= _VAGUE
        return spread

    def faults(self, column):
        """All `Fault` of a column."""
        n_tests, n_sensors, _ = self.numbers[column].shape
        return [Fault(column, sensor, test) for sensor, test in product(range(n_sensors), range(n_tests))]


class Equations(NamedTuple):
    """Normal equations of the unknowns."""

    # normal, right: float64 (n, n), (n,)
    normal: np.ndarray
    right: np.ndarray
    variance: float  # of a reading; NaN where too little was read
    # Fault to (numbers, trials); unknowns of a fault that the readings tell of, and among how many forms the
    # best one was chosen
    faults: dict
    freedom: float = np.inf  # degrees of freedom behind the variance

    def posterior(self, spread):
        """Mean and covariance of the unknowns, shapes (n,), (n, n), with their spread before anything is read."""
        information = self.normal / self.variance + np.diag(1.0 / spread**2)
        covariance = np.linalg.inv(information)
        return covariance @ (self.right / self.variance), covariance


def data_alone(mean, covariance, spread):
    """Estimate and covariance of some unknowns with their own prior made vague; the others keep theirs."""
    information = np.linalg.inv(covariance)
    vague = information - np.diag(1.0 / spread**2) + np.diag(1.0 / (_VAGUE * spread) ** 2)
    alone = np.linalg.inv(vague)
    return alone @ (information @ mean), alone


def name_faults(equations_of, unknowns, level, names, most, faultless=0, possible=None):
    """Name the clearest fault, make the equations anew with this one free, and so on, until no fault is clear.

    Parameters
    ----------
    equations_of : callable of (named, spread)
        `Equations` with some faults as good as unknown.
    unknowns : Unknowns
    level : Level
    names : sequence of str
        The sensors.
    most : int
        Faults.
    faultless : int
        Sensors that have to be left without a fault.
    possible : callable of (fault, estimate), optional
        Whether a fault may have that size; by default any.

    Returns
    -------
    named : dict of Fault to float
        Chance times all hypotheses.
    equations : Equations
        The last ones.
    spread : float64 array
        Their unknowns.

    Notes
    -----
    A fault is clear where the estimate by the readings alone is beyond its tolerance. It gains what it takes from the
    sum of weighted squares, less twice its unknowns; the clearest one gains most.
    """
    named = {}
    while True:
        spread = unknowns.freed(named)
        equations = equations_of(named, spread)
        if len(named) == most or not np.isfinite(equations.variance):
            return named, equations, spread
        suspects = {fault.sensor for fault in named}
        full = len(suspects) >= len(names) - faultless
        mean, covariance = equations.posterior(spread)
        gained, clear = {}, {}
        for fault, (numbers, trials) in equations.faults.items():
            if fault in named:
                continue
            estimate, alone = data_alone(mean[numbers], covariance[np.ix_(numbers, numbers)], spread[numbers])
            if possible is not None and not possible(fault, estimate):
                continue
            tied = alone + np.diag(spread[numbers] ** 2)
            gained[fault] = estimate @ np.linalg.solve(tied, estimate) - 2.0 * len(numbers)
            p = chance_within(estimate, alone, fault.column.tolerance, equations.freedom)
            p *= level.hypotheses * trials
            if p < level.chance and (fault.sensor in suspects or not full):
                clear[fault] = p
        if not clear:
            return named, equations, spread
        best = max(clear, key=gained.get)
        named[best] = clear[best]


def coloured_variance(parts, freedom, segment):
    """Variance of a reading, times the factor by which its noise averages out more slowly than white noise would.

    Parameters
    ----------
    parts : sequence of float64 array, shape (n_readings, n)
        What is left of the readings, of each test.
    freedom : float
        Number of independent readings.
    segment : int
        Readings over which coloured noise averages out.
    """
    squares = slow = fast = 0.0
    for rest in parts:
        whole = rest[: len(rest) // segment * segment]
        squares += (rest**2).sum()
        slow += (whole.reshape(-1, segment, rest.shape[1]).sum(axis=1) ** 2).sum()
        fast += (whole**2).sum()
    return squares / freedom * max(slow / fast, 1.0) if freedom and fast else np.nan
