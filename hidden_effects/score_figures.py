"""Figures of verdicts held against the truth: shares, medians, confusion matrix."""

from dataclasses import dataclass

import numpy as np
from case_noise import MARKER_NOISE
from outside_forces import OUTSIDE

from blockshake.diagnosis.verdict.track_record import Answers, JudgedCase, Median, Row, Share
from blockshake.diagnosis.verdict.verdict import Verdict
from blockshake.effects.registry import EFFECTS
from blockshake.study.ensembles.intervals import quantile_ranks, share_interval

NONE = "none"
_TIMED = ("outside-push", "outside-blow")
_LATE = 0.3  # s


@dataclass(frozen=True)
class Scored:
    """One case: its truth as the maker wrote it, and the verdict.

    Attributes
    ----------
    name : str
    truth : dict
        ``truth``, ``size_class``, ``effect``, ``seed``, ``sealed``, ``tests``.
    verdict : Verdict
    removed : bool
        The truth was taken out of the candidates.
    """

    name: str
    truth: dict
    verdict: Verdict
    removed: bool = False

    @property
    def answer(self):
        """Column of the confusion matrix."""
        causes, decision = self.verdict.causes, self.verdict.decision
        holds = not self.removed and self.truth["truth"] in causes
        if decision == "named":
            return "right" if holds else "wrong"
        if decision == "ambiguous":
            return "set_with" if holds else "set_without"
        return decision

    @property
    def traced(self):
        """Whether the cause moves a reading of an open test by more than the noise of one."""
        return any(test.get("trace", 0.0) > MARKER_NOISE for test in self.truth["tests"].values())

    @property
    def holds_truth(self):
        """Whether the truth is among the causes."""
        return not self.removed and self.truth["truth"] in self.verdict.causes


def figures(scored):
    """Shares, medians, confusion matrix and list of cases.

    Parameters
    ----------
    scored : list of Scored

    Returns
    -------
    dict
        ``shares``, ``medians``, ``confusion`` and ``cases`` of a `TrackRecord`.
    """
    clean = [case for case in scored if case.truth["truth"] == NONE]
    known = [case for case in scored if case.truth["truth"] in EFFECTS and not case.removed]
    outside = [case for case in scored if case.truth["truth"] in OUTSIDE]
    described = [case for case in outside if case.verdict.outside]
    timed = [case for case in described if case.truth["truth"] in _TIMED]
    removed = [case for case in scored if case.removed]
    large = [case for case in known if case.truth["size_class"] == "large"]
    right = [case for case in known if case.answer == "right"]
    placed = [case for case in right if case.truth["effect"]["place"]]
    seen = [case for case in known if case.verdict.decision != "none"]
    limited = [case for case in known if case.verdict.decision == "none" and _limit(case) is not None]
    sizes = [covered for case in right for covered in _covered(case)[:1]]
    others = [covered for case in right for covered in _covered(case)[1:]]
    apart = [case for case in large if not _own_group(case)]
    shares = {
        "false_alarms": _share(
            "an effect is called where there is none", [case.answer != "none" for case in clean], 0.03, "at most"
        ),
        "confidently_wrong": _share(
            "one name, and it is wrong: of all cases", [case.answer == "wrong" for case in scored], 0.02, "at most"
        ),
        "truth_in_set": _share("the truth is named or in the set", [case.holds_truth for case in known], 0.92),
        "truth_in_set_traced": _share(
            "the same where the effect moves a reading of an open test by more than the noise of one",
            [case.holds_truth for case in known if case.traced],
        ),
        "truth_in_set_large": _share(
            "the truth is named or in the set at the larger size", [case.holds_truth for case in large], 0.97
        ),
        "truth_in_set_seen": _share(
            "the truth is named or in the set where an effect is called", [case.holds_truth for case in seen]
        ),
        "exact_large": _share(
            "the truth alone is named at the larger size; sets within the truth's own group are left out",
            [case.answer == "right" for case in apart], 0.9,
        ),
        "exact_large_all": _share("the same, no set left out", [case.answer == "right" for case in large]),
        "bound_holds": _share(
            "no effect is called, and the truth is no larger than what is said to be excluded",
            [abs(_size(case)) <= abs(_limit(case)) for case in limited],
        ),
        "unknown_recall": _share(
            "an effect that the candidates lack is called unknown", [case.answer == "unknown" for case in removed], 0.7
        ),
        "unknown_named": _share(
            "an effect that the candidates lack gets another's name", [case.answer == "wrong" for case in removed],
            0.1, "at most",
        ),
        "outside_unknown": _share(
            "a cause outside of the registry is called unknown", [case.answer == "unknown" for case in outside], 0.85
        ),
        "outside_unknown_traced": _share(
            "the same where the cause moves a reading of an open test by more than the noise of one",
            [case.answer == "unknown" for case in outside if case.traced],
        ),
        "outside_named": _share(
            "a cause outside of the registry gets a registered name", [case.answer == "wrong" for case in outside],
            0.1, "at most",
        ),
        "outside_block": _share(
            "the block of such a cause is among those that are said, where it is described",
            [case.truth["effect"]["place"]["body"] in case.verdict.outside.bodies for case in described], 0.85,
        ),
        "outside_time": _share(
            "the start of a described push or blow is right within 0.3 s", [_on_time(case) for case in timed], 0.85
        ),
        "location": _share("its place is right where it is rightly named", [_placed(case) for case in placed], 0.95),
        "size_covered": _share("the 90 % interval of its size holds the truth where it is rightly named", sizes, 0.85),
        "others_covered": _share("the same of its other parameters", others),
    }  # fmt: skip
    extended = [
        case
        for case in scored
        if case.truth["sealed"] and (len(case.verdict.causes) == 1 or case.verdict.outside)
    ]
    shares["gain_given"] = _share(
        "a gain with its interval is given where one cause is named, or described, and tests are sealed",
        [case.verdict.gain is not None for case in extended], 0.95,
    )  # fmt: skip
    medians = {
        "gain_named": _median(
            "gain on the responses of sealed tests where it is rightly named", _gains(right), 0.6
        ),
        "gain_laws_named": _median(
            "gain on the laws of sealed tests where it is rightly named", _law_gains(right), 0.8
        ),
        "gain_described": _median(
            "gain on the responses of sealed tests where a force from outside is described", _gains(described)
        ),
        "gain_laws_described": _median("the same on their laws", _law_gains(described)),
        "gain_clean": _median("gain on sealed tests where there is none", _gains(clean), 0.05, "at most"),
        "set_size_large": _median(
            "number of causes at the larger size where an effect is called",
            [len(case.verdict.causes) for case in large if case.verdict.causes],
        ),
    }
    return {"shares": shares, "medians": medians, "confusion": _confusion(scored), "cases": _cases(scored)}


def _share(meaning, hits, goal=None, side="at least"):
    lower, upper = share_interval(sum(hits), len(hits))
    return Share(
        meaning=meaning, hits=int(sum(hits)), n=len(hits), lower=lower, upper=upper, goal=goal, side=side
    )


def _median(meaning, values, goal=None, side="at least"):
    """Median with the pair of order statistics that holds it in 95 of 100 cases."""
    ordered, count = sorted(values), len(values)
    ranks = quantile_ranks(count, 0.5)
    ends = {"lower": ordered[ranks[0] - 1], "upper": ordered[ranks[1] - 1]} if ranks else {}
    estimate = float(np.median(ordered)) if count else None
    return Median(meaning=meaning, n=count, estimate=estimate, goal=goal, side=side, **ends)


def _own_group(case):
    """Whether the answer is a set within what the registry says the truth is confused with."""
    truth = case.truth["truth"]
    group = {truth, *EFFECTS[truth].confused_with}
    group |= {name for name, effect in EFFECTS.items() if truth in effect.confused_with}
    return case.answer == "set_with" and set(case.verdict.causes) <= group


def _size(case):
    first = EFFECTS[case.truth["truth"]].parameters[0]
    return case.truth["effect"]["values"][first.name] - first.null


def _limit(case):
    """Distance from the null value above which the verdict excludes the truth, where it says so."""
    first = EFFECTS[case.truth["truth"]].parameters[0]
    limit = case.verdict.excluded_above.get(case.truth["truth"])
    return None if limit is None else limit - first.null


def _placed(case):
    """Whether all that the verdict says of the place is true, and it says something."""
    said = case.verdict.location.get(case.truth["truth"], {})
    true = {kind: _as_names(where) for kind, where in case.truth["effect"]["place"].items()}
    return bool(said) and all(true.get(kind) == _as_names(where) for kind, where in said.items())


def _as_names(where):
    return (where,) if isinstance(where, str) else tuple(sorted(where))


def _on_time(case):
    """Whether the description starts when the cause does, in every test that shows one."""
    start = dict(zip(case.truth["tests"], case.truth["effect"]["start"], strict=True))
    said = {test: values.get("start", 0.0) for test, values in case.verdict.outside.tests.items()}
    return all(start[test] is not None and abs(start[test] - at) < _LATE for test, at in said.items())


def _covered(case):
    """By parameter of the truth, the size first: whether its interval holds it; those without an interval are not."""
    truth = case.truth["truth"]
    said, true = case.verdict.parameters.get(truth, {}), case.truth["effect"]["values"]
    return [
        said[item.name].lower <= true[item.name] <= said[item.name].upper if item.name in said else False
        for item in EFFECTS[truth].parameters
    ]


def _gains(cases):
    return [case.verdict.gain.recalibrated.estimate for case in cases if case.verdict.gain is not None]


def _law_gains(cases):
    return [case.verdict.law_gain.estimate for case in cases if case.verdict.law_gain is not None]


def _confusion(scored):
    kinds = [(NONE, None, False)]
    kinds += [(name, size, False) for name in EFFECTS for size in ("small", "large")]
    kinds += [(name, "large", True) for name in EFFECTS] + [(name, None, False) for name in OUTSIDE]
    rows = []
    for truth, size, removed in kinds:
        own = [
            case.answer
            for case in scored
            if (case.truth["truth"], case.truth["size_class"], case.removed) == (truth, size, removed)
        ]
        counts = {answer: own.count(answer) for answer in Answers.model_fields}
        if own:
            rows.append(Row(truth=truth, size=size, removed=removed, answers=Answers(**counts)))
    return rows


def _cases(scored):
    return [
        JudgedCase(
            name=case.name, seed=case.truth["seed"], structure=case.truth["structure"], truth=case.truth["truth"],
            size=case.truth["size_class"], removed=case.removed, answer=case.answer, causes=case.verdict.causes,
        )
        for case in scored
    ]  # fmt: skip
