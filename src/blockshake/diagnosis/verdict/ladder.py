"""The ladder of words: how strong a statement a diagnosis makes, and the reasons why it is not a stronger one."""

from typing import NamedTuple

import numpy as np

from blockshake.diagnosis.inference.decision import INCONSTANT
from blockshake.effects.registry import title_of
from blockshake.simulation.models import model_of

ESTABLISHED, PROBABLE, ONE_OF = "established", "probable", "one of"
UNKNOWN, NOTHING = "something acts, cause unknown", "no misfit larger than chance"
_TESTS_TO_ESTABLISH = 3


class Rung(NamedTuple):
    """Word of a verdict, and what a probable cause lacks to be called established (empty on other rungs)."""

    word: str
    missing: tuple


def rung(kind, decision, beside_sensor, effort, n_tests, gain, scores):
    """`Rung` of the ladder on which a verdict stands.

    Parameters
    ----------
    kind : str
        Decision of the verdict, sensor faults included.
    decision : Decision
        On physical causes.
    beside_sensor : bool
        Whether a sensor fault is among the causes.
    effort : str
    n_tests : int
        Open tests that were judged by.
    gain : Gain or None
    scores : xarray.Dataset or None
        From `gain_on`, where a physical cause's gain was measured.
    """
    if kind == "none":
        return Rung(NOTHING, ())
    if kind == "unknown":
        return Rung(UNKNOWN, ())
    if decision.decision == "ambiguous":
        return Rung(ONE_OF, ())
    missing = []
    if len(decision.causes) > 1:
        missing.append("two effects act together, for which nothing was calibrated")
    if decision.causes and beside_sensor:
        missing.append("a sensor's fault acts beside it")
    if effort == "quick":
        missing.append("the effort was quick")
    if n_tests < _TESTS_TO_ESTABLISH:
        missing.append(f"it was judged by {n_tests} tests only")
    missing += _of_cause(decision) + _of_gain(gain, scores) if decision.causes else _of_sensor(gain)
    return Rung(PROBABLE if missing else ESTABLISHED, tuple(missing))


def _of_sensor(gain):
    alone = ["the sensors' checks alone found it"]
    return alone if gain else [*alone, "no gain was measured on a sealed test"]


def _of_cause(decision):
    missing = []
    if decision.solver_dependent:
        solvers = ", ".join(model_of(name).label for name in decision.solver_dependent)
        missing.append(f"by {solvers} alone another effect explains more")
    drifting = [title_of(name) for name in decision.causes if decision.constancy[name] <= INCONSTANT]
    if drifting:
        missing.append(f"the size of {' and of '.join(drifting)} is not the same in all tests")
    return missing


def _of_gain(gain, scores):
    if gain is None:
        return ["no gain was measured on a sealed test"]
    if not np.isfinite(scores["gain"].sel(rival="recalibrated")):
        return ["the sealed tests leave nothing to gain"]
    missing = [] if gain.recalibrated.lower > 0.0 else ["the gain on sealed tests may be nothing or a loss"]
    if gain.discrepancy.estimate < 0.0:
        missing.append("a discrepancy without a name predicts the sealed tests better")
    if not bool(scores["confirmed"]):
        missing.append("not each solver by itself shows the gain")
    return missing
