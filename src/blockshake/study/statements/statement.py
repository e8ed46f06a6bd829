"""A statement of the paper, and the finding of a study on it."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from typing import NamedTuple

from blockshake.pages.wording import given, model_label
from blockshake.simulation.models import MODELS


class PaperVerdict(StrEnum):
    """How a study judges a statement."""

    MET = "met"
    NOT_MET = "not met"
    UNJUDGED = "cannot be judged"


class PaperFinding(NamedTuple):
    """A verdict and the numbers that it rests on, in words."""

    verdict: PaperVerdict
    words: str


@dataclass(frozen=True)
class Statement:
    """One statement of Zhou et al. (2023).

    Attributes
    ----------
    place : str
        Section, figure, table or equation of the paper.
    claim : str
        The statement in the words of this program.
    judge : callable
        `Content` of a study to `PaperFinding`.
    target : str
        Result that the finding rests on: a target of the workflow, with ``{study}`` and ``{case}`` to be filled in,
        or, with a space in it, a whole command.
    """

    place: str
    claim: str
    judge: Callable
    target: str


def judged(holds, words):
    """`PaperFinding` of a statement that holds or does not."""
    return PaperFinding(PaperVerdict.MET if holds else PaperVerdict.NOT_MET, words)


def unjudged(words):
    """`PaperFinding` of a statement that the study cannot judge, with the reason in words."""
    return PaperFinding(PaperVerdict.UNJUDGED, words)


def against_tests(cases, holds, words):
    """`PaperFinding` that hangs on measured curves: those of virtual tests say nothing of the paper's specimens."""
    synthetic = [case.name for case in cases if case.synthetic]
    if not synthetic:
        return judged(holds, words)
    side = "bear the statement out" if holds else "do not bear the statement out"
    return unjudged(
        f"The tests of {', '.join(synthetic)} are synthetic and tell nothing of the specimens; they {side}. {words}"
    )


def missing(content, *models):
    """Words on the models that the study lacks; empty where it has all of them."""
    lacking = [model_label(model) for model in models if model not in content.study["models"]]
    return f"This study has no {' and no '.join(lacking)}." if lacking else ""


def setting(content, model, name):
    """Value that a numerical parameter of a model has in the study, by dotted name: its default unless it is set."""
    given = content.study["models"].get(model, {}).get("parameters", {})
    return given.get(name, MODELS[model].numerical_parameters()[name][0])


def compared(content):
    """Cases that have a measured test."""
    return [case for case in content.cases.values() if case.measured is not None]


def scale_words(content):
    """Level of shaking of the cases, in words after a quantity."""
    scales = sorted({case.settings["scale"] for case in content.cases.values()})
    return f" at scale {' and '.join(map(given, scales))}"
