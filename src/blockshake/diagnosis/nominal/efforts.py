"""Efforts of a diagnosis: how much is simulated."""

from dataclasses import dataclass

ENSEMBLES_OF_SEALED_TEST = 4  # nominal, recalibrated, extended, placebo


@dataclass(frozen=True)
class Effort:
    """Amounts of simulation.

    Attributes
    ----------
    tests : int
        Open tests at most that are simulated.
    draws : int
        Nominal models of each open test, by each solver.
    members : int
        Of every ensemble that predicts a sealed test, by each solver.
    twins : int
        By which it is measured how long a test can be predicted, by each solver.
    """

    tests: int
    draws: int
    members: int
    twins: int


EFFORTS = {
    "quick": Effort(tests=0, draws=0, members=0, twins=0),
    "standard": Effort(tests=3, draws=40, members=12, twins=4),
    "deep": Effort(tests=12, draws=80, members=40, twins=8),
}
