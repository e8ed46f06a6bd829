"""A statement of the paper, and the finding of a study on it."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from typing import NamedTuple

from blockshake.pages.wording import given, model_label


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
    models : tuple of str
        Models without which no study can judge it.
    measured : bool
        Whether a study needs a measured test to judge it.
    """

    place: str
    claim: str
    judge: Callable
    models: tuple = ()
    measured: bool = False

    def finding(self, content):
        """`PaperFinding` of a study, which cannot judge the statement where it lacks a model or a measured test."""
        lacking = [model_label(model) for model in self.models if model not in content.study["models"]]
        if lacking:
            return unjudged(f"This study has no {' and no '.join(lacking)}.")
        if self.measured and not compared(content):
            return unjudged("This study has no measured test.")
        return self.judge(content)


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


def compared(content):
    """Cases that have a measured test."""
    return [case for case in content.cases.values() if case.measured is not None]


def scale_words(content):
    """Level of shaking of the cases, in words after a quantity."""
    scales = sorted({case.settings["scale"] for case in content.cases.values()})
    return f" at scale {' and '.join(map(given, scales))}"
