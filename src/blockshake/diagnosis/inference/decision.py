"""The decision on a campaign's open tests: which effects they speak for, with all that it rests on."""

from typing import Literal

from blockshake.diagnosis.laws.findings import LawFindings
from blockshake.files import load_json, write_json
from blockshake.validation import Strict, validated

FALSE_ALARM = 0.05  # level at which readings are called an effect
NOT_IN_SET = 0.10  # level below which an effect leaves the set
INADEQUATE = 0.05  # level below which even the best fit of an effect leaves too much
INCONSTANT = 0.05  # level below which an effect compensates for another, rather than being the cause


class SizeRange(Strict):
    """A size with the ends of its range, in units of the visible size."""

    estimate: float
    lower: float
    upper: float


class ParameterEstimate(Strict):
    """A parameter of an effect with its 90 % interval.

    ``informed`` is false where the tests do not tell the parameter; the interval is then that of the prior.
    """

    estimate: float
    lower: float
    upper: float
    unit: str
    informed: bool


class CandidateScore(Strict):
    """Scores of one candidate, as of `Scores`; ``by_test`` has the likeliest sizes of each test by itself."""

    key: str
    effect: str
    log_ratio: float
    by_model: dict[str, float]
    size: float
    sizes: tuple[float, ...]
    weights: tuple[float, ...]
    model: str
    distance: float
    by_test: tuple[SizeRange, ...]


class Decision(Strict):
    """The decision and the scores behind it.

    Attributes
    ----------
    decision : str
        Kind of the answer.
    causes : tuple of str
        Effects that are not excluded, the likeliest first.
    places : dict of str to str
        By effect: key of the candidate that stands for the effect.
    sizes : dict of str to float
        By cause: its best size, in units of the visible one.
    p_none : float
        Chance of scores like these without an effect [1].
    probabilities : dict of str to float
        By effect: its conformal p value [1].
    adequacy : dict of str to float
        By effect: chance of as bad a best fit where the effect is the truth [1].
    constancy : dict of str to float
        By effect: chance of sizes that differ as much from test to test [1].
    placebo : float
        Largest log ratio of a candidate that means nothing [1].
    struck_out : dict of str to tuple of str
        By effect: the reasons for which it is not among the causes, in words.
    solver_dependent : tuple of str
        Solvers by which alone another effect than the named one explains more.
    shown_above : dict of str to float or None
        By effect: size from which on nine in ten would have been seen, in units of the visible one.
    nominal_distance : float
        Squared distance per feature of the readings from the nominal model [1].
    parameters : dict of str to dict of str to ParameterEstimate
        By cause and parameter. The second effect of a combination has none: its size is a single estimate.
    location : dict of str to dict
        By cause: its place in the structure.
    candidates : tuple of CandidateScore
        All candidates by falling log ratio.
    laws : LawFindings or None
        Laws of the joints; None where the sensors give no joint forces.
    """

    decision: Literal["none", "named", "ambiguous", "combination", "unknown"]
    causes: tuple[str, ...]
    places: dict[str, str]
    sizes: dict[str, float]
    p_none: float
    probabilities: dict[str, float]
    adequacy: dict[str, float]
    constancy: dict[str, float]
    placebo: float
    struck_out: dict[str, tuple[str, ...]]
    solver_dependent: tuple[str, ...]
    shown_above: dict[str, float | None]
    nominal_distance: float
    parameters: dict[str, dict[str, ParameterEstimate]]
    location: dict[str, dict[str, str | tuple[str, ...]]]
    candidates: tuple[CandidateScore, ...]
    laws: LawFindings | None = None

    def candidate(self, key):
        """Scores of the candidate with this key."""
        return next(row for row in self.candidates if row.key == key)

    @property
    def described(self):
        """Force from outside that extends the model in place of an unknown cause; None without one."""
        return self.laws.outside if self.decision == "unknown" and self.laws else None

    @property
    def first_key(self):
        """Key of the candidate that stands for the first cause, or without a cause for the strongest effect."""
        return self.places[(self.causes or tuple(self.places))[0]]


class CauseSize(Strict):
    """The size of the first cause, from all draws with it.

    Attributes
    ----------
    key : str
        Of the candidate.
    sizes, posterior : tuple of float
        Sizes in units of the visible one, and their weights [1].
    error : float
        Root mean square by which the posterior's mean misses the true size of left-out draws, in the same unit.
    draws : int
        By each solver and test.
    parameters : dict of str to ParameterEstimate
        By name.
    """

    key: str
    sizes: tuple[float, ...]
    posterior: tuple[float, ...]
    error: float
    draws: int
    parameters: dict[str, ParameterEstimate]


def write_result(path, result):
    """Write a decision, a size or another typed result as JSON, keys in the order of its class."""
    write_json(path, result.model_dump())


def load_result(schema, path):
    """Typed result of a file that `write_result` wrote.

    Raises
    ------
    InputError
        The file is missing or holds something else.
    """
    return validated(schema, load_json(path), path)
