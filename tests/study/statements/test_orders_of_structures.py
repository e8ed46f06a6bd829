"""Orders of the structures of the paper: beyond limits alone, and where all of them are there."""

from dataclasses import replace

import numpy as np
import pytest

from blockshake.study.statements import responses
from blockshake.study.statements.statement import PaperVerdict

MET, NOT_MET, UNJUDGED = PaperVerdict.MET, PaperVerdict.NOT_MET, PaperVerdict.UNJUDGED
FIRST, FOURTH = "configuration-1", "configuration-4"


@pytest.fixture
def four(content):
    """The content with copies of configuration 4 as configurations 2 and 3, and six samples by every model."""
    for name, case in list(content.cases.items()):
        for model, one in case.responses.items():
            samples = one.samples.isel(sample=slice(6)).copy(deep=True)
            samples["status"][:] = "completed"
            case.responses[model] = replace(one, samples=samples)
        case.differences["counted"][:] = 6
        content.cases[name] = case
    last = content.cases[FOURTH]
    for name in ("configuration-2", "configuration-3"):
        responses = {
            model: replace(one, samples=one.samples.copy(deep=True), envelope=one.envelope.copy(deep=True))
            for model, one in last.responses.items()
        }
        content.cases[name] = replace(
            last, name=name, responses=responses, differences=last.differences.copy(deep=True)
        )
    return content


def widen(content, model, tops, figure="width"):
    """Give the cases mean differences of two samples at the top, or another figure, with limits 10 % off [m]."""
    for name, top in tops.items():
        differences = content.cases[name].differences
        differences[figure].loc[{"model": model}] = top
        for bound, factor in (("lower", 0.9), ("upper", 1.1)):
            differences[f"{figure}_interval"].loc[{"model": model, "bound": bound}] = factor * top


def thicker_than_first(content):
    """Finding that each structure has a thicker envelope at its top than configuration 1."""
    pairs = [(FIRST, other) for other in ("configuration-2", "configuration-3", FOURTH)]
    return responses.thicker_tops(content, "ls-dem", pairs)


def counted(stated, pairs, opposite):
    """Words on the pairs of structures in the stated order and in the opposite one."""
    return (
        f"the stated order beyond the limits, all of which met asks for: {stated} of {pairs}; in the opposite one, of "
        f"which one is enough for not met: {opposite}."
    )


def test_envelopes_at_the_top_are_compared_by_their_limits(four):
    others = ("configuration-2", "configuration-3", FOURTH)
    for top, verdict, counts in (
        (0.02, MET, counted(3, 3, 0)),
        (0.011, UNJUDGED, counted(0, 3, 0)),
        (0.005, NOT_MET, counted(0, 3, 3)),
    ):
        widen(four, "ls-dem", {FIRST: 0.01, **dict.fromkeys(others, top)})
        found = thicker_than_first(four)
        assert found.verdict == verdict
        assert counts in found.words
        assert "configuration-1 10.0 [9.0, 11.0]" in found.words
    assert responses.thicker_tops(four, "ls-dem", [(responses.THIRD, FOURTH)]).verdict == UNJUDGED
    widen(four, "ls-dem", {FOURTH: 0.007})
    assert responses.thicker_tops(four, "ls-dem", [(responses.THIRD, FOURTH)]).verdict == MET


def test_runs_of_walls_are_held_against_those_of_stacks(four):
    tops = {FIRST: 0.01, "configuration-2": 0.02, "configuration-3": 0.03, FOURTH: 0.04}
    widen(four, "nscd-rigid", tops)
    assert responses.thicker_tops(four, "nscd-rigid", responses.STACKS_AND_WALLS).verdict == MET
    widen(four, "nscd-rigid", {FOURTH: 0.015})
    found = responses.thicker_tops(four, "nscd-rigid", responses.STACKS_AND_WALLS)
    assert found.verdict == NOT_MET
    assert counted(3, 4, 1) in found.words


def test_a_case_that_is_missing_lets_no_order_be_met(four):
    widen(four, "ls-dem", {FIRST: 0.01, "configuration-2": 0.02, "configuration-3": 0.02, FOURTH: 0.02})
    four.cases[FOURTH].differences["counted"][:] = 5
    found = thicker_than_first(four)
    assert found.verdict == UNJUDGED
    assert "of too few samples: configuration-4." in found.words
    widen(four, "ls-dem", {"configuration-2": 0.005})
    assert thicker_than_first(four).verdict == NOT_MET
    del four.cases["configuration-2"]
    assert thicker_than_first(four).verdict == UNJUDGED


def test_cases_that_are_shaken_differently_are_not_compared(four):
    four.cases[FOURTH] = replace(four.cases[FOURTH], settings={**four.cases[FOURTH].settings, "scale": 1.25})
    assert "shaken differently" in thicker_than_first(four).words


def test_thickness_grows_with_the_structure_by_every_kind_of_block(four):
    tops = {FIRST: 0.01, "configuration-2": 0.02, "configuration-3": 0.03, FOURTH: 0.04}
    for model in ("ls-dem", "nscd-rigid"):
        widen(four, model, tops)
    assert responses.with_structure(four, ("ls-dem", "nscd-rigid")).verdict == MET
    widen(four, "nscd-rigid", {FOURTH: 0.01})
    found = responses.with_structure(four, ("ls-dem", "nscd-rigid"))
    assert found.verdict == NOT_MET
    assert counted(3, 6, 2) in found.words


def move(content, name, counts):
    """Let so many joints of the cases open or slip by 1 mm in all samples, and the others not at all."""
    for case, count in counts.items():
        for one in content.cases[case].responses.values():
            one.samples[name][:] = 0.0
            one.samples[name].loc[{"joint": one.samples["joint"].values[:count]}] = 1e-3


def test_rocking_and_sliding_are_those_of_joints_that_move(four):
    names = (FIRST, "configuration-2", "configuration-3", FOURTH)  # of 3 joints, and of 20 by the copies
    for first, others, verdict in ((1, 10, MET), (2, 13, NOT_MET), (3, 20, UNJUDGED), (3, 19, UNJUDGED)):
        move(four, "joint_uplift", dict(zip(names, (first, others, others, others), strict=True)))
        found = responses.occurrences(four)
        assert found.verdict == verdict
        assert f"configuration-4 {5 * others}.0 [{5 * others}.0, {5 * others}.0]" in found.words
        assert "Share of the joints (3 of configuration-1, " in found.words
        # no share is larger than that of all joints
        full = "Nothing can be larger than that of configuration-1. No pair of structures is left."
        assert (full in found.words) == (first == 3)
    # a rocking block's joint slips a little too, and counts once
    for name in ("joint_uplift", "joint_slip"):
        move(four, name, dict(zip(names, (1, 1, 8, 8), strict=True)))
    assert responses.complicated(four).verdict == MET
    move(four, "joint_slip", {FIRST: 2})
    found = responses.complicated(four)
    assert found.verdict == NOT_MET
    assert found.words.endswith("The worst of the models counts.")
    assert "NSCD rigid: Share of the joints" in found.words
    four.cases[FOURTH].responses["ls-dem"].samples["status"][0] = "not-converged"
    assert "of too few samples: configuration-4" in responses.occurrences(four).words


def test_residuals_are_judged_once_the_shaking_has_ended(four):
    for motion in four.motions.values():
        motion["acceleration"][:] = 1.0
    found = responses.residuals(four)
    assert found.verdict == UNJUDGED
    assert "0.05 g, the bracket of Bolt (1969), in the last 0.5 s" in found.words
    for motion in four.motions.values():
        motion["acceleration"][:] = 0.01
    for width, verdict in ((1.0, MET), (0.1, UNJUDGED), (0.01, NOT_MET)):
        for model in four.study["models"]:
            ranges = {name: width if name == FOURTH else 0.1 for name in four.cases}
            widen(four, model, ranges, "residual_range")
        assert responses.residuals(four).verdict == verdict
    for case in four.cases.values():
        case.differences["residual_range_interval"][:] = np.nan  # too few samples that have a residual
    assert responses.residuals(four).verdict == UNJUDGED
