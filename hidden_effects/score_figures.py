"""Figures of verdicts held against the truth: shares, medians, confusion matrix."""

import numpy as np
from case_plan import HOME
from make_case import LABORATORIES
from oracle_gain import ABLE
from outside_forces import OUTSIDE
from scored_record import Answers, GainedCase, JudgedCase, Median, Row

from blockshake.diagnosis.verdict.track_record import Share
from blockshake.effects.registry import EFFECTS
from blockshake.statistics.intervals import quantile_ranks, share_interval

LATE = 0.2  # s
_TIMED = ("push", "blow")
_MOST = "at most"
_WORSE = -0.1


def figures(scored):
    """Shares, medians, confusion matrix and list of cases.

    Parameters
    ----------
    scored : list of Scored

    Returns
    -------
    dict
        The figures of a `ScoredRecord` by their names in it.
    """
    known, outside = ([case for case in scored if case.kind == kind] for kind in ("effect", "outside"))
    laboratories = sorted({case.laboratory for case in scored}, key=list(LABORATORIES).index)
    own = {one: [case for case in scored if case.laboratory == one] for one in laboratories}
    abroad = [case for case in scored if case.laboratory != HOME]
    return {
        "shares": shares(scored),
        "laboratories": {one: shares(cases) for one, cases in own.items()},
        "abroad": shares(abroad) if abroad else {},
        "medians": _medians(known, outside, scored),
        "gains": [_gained(case) for case in scored if case.gains is not None],
        "confusion": _confusion(scored),
        "cases": [_judged(case) for case in scored],
    }


def shares(scored):
    """Shares of some cases by name; causes from outside that move nothing are counted apart."""
    clean, known, outside, pairs = (
        [case for case in scored if case.kind == kind and not case.unseen]
        for kind in ("clean", "effect", "outside", "pair")
    )
    return {
        **_of_all(scored, clean),
        **_of_effects(known),
        **_of_outside(outside),
        **_of_pairs(pairs, known + outside),
        **_of_gains(scored),
    }


def _of_all(scored, clean):
    return {
        "false_alarms": _share(
            "an effect is called where there is none", [case.answer != "none" for case in clean], 0.02, _MOST
        ),
        "confidently_wrong": _share(
            "one name, and it is wrong: of all cases", [case.answer == "wrong" for case in scored], 0.02, _MOST
        ),
        "false_beside": _share(
            "a cause that is not there is asserted next to a true one: of all cases with a cause",
            [0 < case.held < case.asserted for case in scored if case.causes], 0.03, _MOST,
        ),
        "unseen": _share(
            "a cause from outside moves no marker by five standard deviations next to a twin without it: counted apart",
            [case.unseen for case in scored if case.truth.get("moved") is not None],
        ),
    }  # fmt: skip


def _of_effects(known):
    seen = [case for case in known if case.can_be_seen]
    large = [case for case in known if case.truth["size"] == "large"]
    right = [case for case in known if case.answer == "right"]
    held = [case for case in known if case.held]
    covered = [hit for case in right for hit in case.covered.values()]
    return {
        "can_be_seen": _share(
            "an effect is larger than its detection limit in the tests at hand", [case.can_be_seen for case in known]
        ),
        "truth_in_set": _share("the truth is named or in the set", [case.held > 0 for case in known]),
        "truth_in_set_seen": _share("the same of effects that can be seen", [case.held > 0 for case in seen], 0.92),
        "exact_large": _share(
            "the truth is named alone, or as one class with what is mistaken for it, at the larger size",
            [case.answer == "right" or case.within_class for case in large], 0.9,
        ),
        "exact_large_seen": _share(
            "the same of effects that can be seen",
            [case.answer == "right" or case.within_class for case in large if case.can_be_seen],
        ),
        "exact_large_alone": _share("the same, named alone", [case.answer == "right" for case in large]),
        "location": _share(
            "the place is right, or among those that cannot be distinguished, where the truth is held",
            [case.placed for case in held if case.cause["place"]], 0.95,
        ),
        "sizes_hold": _share("an interval of 90 % holds the true size where it is rightly named", covered, 0.85),
        "sizes_hold_no_wider": _share("the same, so that intervals are no wider than they need", covered, 0.95, _MOST),
    }  # fmt: skip


def _of_outside(outside):
    described = [case for case in outside if case.held]
    late = [late for case in described if case.form in _TIMED for late in case.lateness]
    return {
        "outside_unknown": _share(
            "a cause outside of the registry is called unknown, or a rope one class with a stop",
            [case.called_unknown for case in outside], 0.9,
        ),
        "outside_form": _share("its form is right", [case.held > 0 for case in outside], 0.8),
        "outside_named": _share(
            "it gets a registered name alone", [case.answer == "wrong" and not case.held for case in outside], 0.03,
            _MOST,
        ),
        "outside_time": _share(
            f"a push or a blow that is described starts within {LATE:g} s of the time that is said, by test",
            [lateness <= LATE for lateness in late], 0.9,
        ),
        "outside_block": _share(
            "its block is right, or among those that cannot be distinguished, where the form is right",
            [case.placed for case in described], 0.95,
        ),
    }  # fmt: skip


def _of_pairs(pairs, single):
    return {
        "pairs_one": _share("one of two causes is held", [case.held > 0 for case in pairs], 0.95),
        "pairs_both": _share("both of two causes are held", [case.held == 2 for case in pairs], 0.7),
        "single_called_pair": _share(
            "two causes are asserted where there is one", [case.asserted > 1 for case in single], 0.03, _MOST
        ),
    }


def _of_gains(scored):
    named = [
        case.verdict for case in scored
        if case.truth["sealed"] and (len(case.verdict.causes) == 1 or case.verdict.outside)
    ]  # fmt: skip
    return {
        "gain_given": _share(
            "a gain with its interval is given where one cause is named, or described, and tests are sealed",
            [verdict.row_gain is not None or verdict.gain is not None for verdict in named], 0.95,
        ),
        "gain_idle": _share(
            "the oracle gains nothing: the cause is there and changes no prediction of the responses",
            [case.gains.idle for case in scored if case.gains is not None],
        ),
        "gain_harmful": _share(
            "a proposed extension predicts the responses worse, by a gain below -0.1",
            [
                case.gains.found is not None and case.gains.found.estimate < _WORSE
                for case in scored
                if case.gains is not None and case.gains.proposed
            ],
            0.0, _MOST,
        ),
    }  # fmt: skip


def _medians(known, outside, scored):
    right = [case for case in known if case.answer == "right"]
    described = [case for case in outside if case.held]
    found = {}
    for key, words, cases, goals in (
        ("named", "where an effect is rightly named", right, (0.8, 0.6)),
        ("described", "where a form from outside is rightly described", described, (None, None)),
    ):
        found[f"gain_rows_{key}"] = _median(
            f"gain on the rows of sealed tests {words}", _rows(cases), goals[0]
        )
        found[f"gain_{key}"] = _median(
            f"gain of a proposed extension on the responses {words}", _responses(cases), goals[1]
        )
    return found | {
        "gain_over_oracle": _median(
            f"gain of a proposed extension over the oracle's, where the oracle gains {ABLE:g} or more",
            [case.gains.share for case in scored if case.gains is not None and case.gains.share is not None], 0.8,
        ),
        "gain_oracle": _median(
            "gain of the oracle, where it gains anything",
            [case.gains.oracle.estimate for case in scored if case.gains is not None and not case.gains.idle],
        ),
    }  # fmt: skip


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


def _rows(cases):
    return [
        case.verdict.row_gain.recalibrated.estimate for case in cases if case.verdict.row_gain is not None
    ]


def _responses(cases):
    return [
        case.gains.found.estimate for case in cases if case.gains is not None and case.gains.found is not None
    ]


def _gained(case):
    return GainedCase(
        name=case.name, laboratory=case.laboratory, truth=_truth(case), size=case.truth["size"],
        answer=case.answer, rows=case.verdict.row_gain.recalibrated if case.verdict.row_gain else None,
        **case.gains.model_dump(),
    )  # fmt: skip


def _confusion(scored):
    rows = {}
    for case in sorted(scored, key=_order):
        rows.setdefault((_truth(case), case.truth["size"]), []).append(case.answer)
    return [
        Row(
            truth=truth, size=size, answers=Answers(**{answer: own.count(answer) for answer in Answers.model_fields})
        )
        for (truth, size), own in rows.items()
    ]  # fmt: skip


def _order(case):
    """Clean cases, effects in the order of the registry, small ones first, causes from outside, pairs."""
    names = [*EFFECTS, *OUTSIDE]
    places = [names.index(name) for name in case.causes]
    return len(places), places[:1], case.truth["size"] != "small", places


def _truth(case):
    return " + ".join(case.causes) or "none"


def _judged(case):
    return JudgedCase(
        name=case.name, seed=case.truth["seed"], laboratory=case.laboratory, strength=case.truth.get("strength"),
        structure=case.truth["structure"], truth=_truth(case), unseen=case.unseen,
        size=case.truth["size"], answer=case.answer, causes=case.verdict.causes,
    )  # fmt: skip
