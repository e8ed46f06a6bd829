"""Efforts of a diagnosis: how much is simulated."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Effort:
    """Amounts of simulation.

    Attributes
    ----------
    tests : int
        Open tests at most that are simulated.
    draws : int
        Members of every ensemble, by each solver and test.
    twins : int
        By which it is measured how long a test can be predicted, by each solver.
    """

    tests: int
    draws: int
    twins: int


EFFORTS = {
    "quick": Effort(tests=0, draws=0, twins=0),
    "standard": Effort(tests=4, draws=12, twins=4),
    "deep": Effort(tests=12, draws=40, twins=8),
}
