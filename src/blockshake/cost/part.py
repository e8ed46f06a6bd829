"""Part of a computation, and its cost."""

from typing import NamedTuple


class Part(NamedTuple):
    """Runs or jobs of one kind.

    Attributes
    ----------
    name : str
    count : int
    seconds : float
        CPU time of all of them [s].
    """

    name: str
    count: int
    seconds: float
