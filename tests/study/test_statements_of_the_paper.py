"""Findings of a study on the statements of the paper, from made-up results: `bench/the_paper.py`."""

import sys
from copy import deepcopy
from dataclasses import replace

import numpy as np
import pytest
from page import CLAIMS

from blockshake.files import HOME
from blockshake.study.report.content import load_content
from blockshake.study.sensitivity.findings import markers_by_height

CASES = FIRST, SECOND, THIRD, FOURTH = [f"configuration-{number}" for number in (1, 2, 3, 4)]
SOFT, RIGID = "ls-dem", "nscd-rigid"
MODULUS = "materials.concrete.youngs_modulus"


@pytest.fixture
def paper(fake, monkeypatch):
    """The judges, where the logs of the made-up study's jobs lie."""
    monkeypatch.syspath_prepend(str(HOME / "bench"))
    monkeypatch.chdir(fake.logs.parents[1])
    import the_paper

    yield the_paper
    sys.modules.pop("the_paper")


@pytest.fixture(scope="module")
def loaded(fake):
    """Content of the made-up study by its models of rigid blocks alone."""
    models = {name: {**fake.study["models"][name], "parameters": {}} for name in (SOFT, RIGID)}
    return load_content({**fake.study, "models": models}, fake.results)


@pytest.fixture
def content(loaded):
    return deepcopy(loaded)


@pytest.fixture
def four(content):
    """The content with copies of configuration 4 as configurations 2 and 3, and six samples by every model."""
    for name in (SECOND, THIRD):
        content.cases[name] = replace(deepcopy(content.cases[FOURTH]), name=name)
    for case in content.cases.values():
        for model, one in case.responses.items():
            samples = one.samples.isel(sample=slice(6)).copy(deep=True)
            samples["status"][:] = "completed"
            case.responses[model] = replace(one, samples=samples)
        case.differences["counted"][:] = 6
    return content


def test_every_statement_has_a_place_a_verdict_and_words(content, paper):
    rows = paper.judge_statements(content)
    assert len({row[1] for row in rows}) == len(rows)
    for place, claim, verdict, words in rows:
        assert place
        assert claim.endswith(".")
        assert verdict in paper.VERDICTS.values()
        assert words.endswith(".")
        assert not [claimed for claimed in CLAIMS if claimed in f"{claim} {words}".lower()]
    words = {row[1]: row[3] for row in rows}
    assert (
        "no NSCD elastic"
        in words["Runs by elastic blocks deviate more from each other in configurations 3 and 4."]
    )
    assert f"Of {len(rows)} statements: " in paper.count_words(rows)


def test_steps_are_judged_by_stability_convergence_energy_and_cost(content, paper):
    assert not paper.stable_step(content)[0]  # the made-up runs tell no stable step
    holds, words = paper.converged(content)
    assert not holds
    assert "before the tolerance of 1e-08" in words
    holds, words = paper.conserves(content)
    assert not holds
    assert "failures: 1 of 16 samples" in words
    holds, words = paper.dear_steps(content)
    assert holds
    assert "configuration-1 20 times a step and 1 times a simulated second" in words
    for case in content.cases.values():
        soft, rigid = (case.responses[model].samples for model in (SOFT, RIGID))
        soft["numerics_stable_time_step"] = ("sample", np.full(soft.sizes["sample"], 1e-4))
        rigid["numerics_capped_steps"][:] = 0
        rigid["status"][:] = "completed"
    assert paper.stable_step(content)[0]
    assert paper.converged(content)[0]
    assert paper.conserves(content)[0]
    rigid["energy_residual"][0] = 0.2
    assert "misses 0.200 of the energy" in paper.conserves(content)[1]
    content.study["models"][RIGID]["time_step"] = 1e-6
    assert not paper.dear_steps(content)[0]


@pytest.mark.parametrize(
    ("normal", "follows", "heavier"),
    [(0.5, True, False), ("density", False, True), ("1/density", False, False)],
)
def test_stiffness_beside_modulus_and_density(content, paper, normal, follows, heavier):
    modulus, density = content.design[MODULUS], content.design["materials.concrete.density"] / 2400.0
    factor = {"density": density, "1/density": 1.0 / density}.get(normal, normal)
    table = content.calibrated[0].stiffness.copy()
    table["ls_dem.normal_stiffness"] = factor * modulus
    table["ls_dem.shear_stiffness"] = factor * modulus / 2.0
    content = replace(content, calibrated=(replace(content.calibrated[0], stiffness=table),))
    holds, words = paper.follow_moduli(content)
    assert holds is not follows
    assert ("k_n / E 0.5000 per m" in words and "k_s / G 0.6000 per m" in words) is follows  # G is E / 2.4
    assert paper.heavier_blocks(content)[0] == heavier


def test_envelopes_thicken_upward_or_not(content, paper):
    for sign in (1.0, -1.0):
        case = content.cases[FOURTH]
        spread = case.responses[SOFT].sensitivity["spread"]
        for body, marker in markers_by_height(case).items():
            height = case.structure.position[case.structure.body_names.index(body), 2]
            spread.loc[{"quantity": "history", "marker": marker}] = 0.01 * sign * height
        holds, words = paper.upward(content)
        assert holds == (sign > 0.0)
        assert ("all 2 cases" if holds else "1 of 2 cases") in words


def widen(content, model, tops):
    """Give cases mean differences of two samples at the top, with limits 10 % off [m]."""
    for name, top in tops.items():
        differences = content.cases[name].differences
        differences["width"].loc[{"model": model}] = top
        for bound, factor in (("lower", 0.9), ("upper", 1.1)):
            differences["width_interval"].loc[{"model": model, "bound": bound}] = factor * top


@pytest.mark.parametrize(
    ("top", "holds", "stated", "opposite"), [(0.02, True, 3, 0), (0.011, None, 0, 0), (0.005, False, 0, 3)]
)
def test_structures_are_ordered_beyond_the_limits(four, paper, top, holds, stated, opposite):
    judge = paper.thicker(SOFT, [(FIRST, other) for other in CASES[1:]])
    widen(four, SOFT, {FIRST: 0.01, **dict.fromkeys(CASES[1:], top)})
    found, words = judge(four)
    assert found is holds or found == holds
    assert f"all of which met asks for: {stated} of 3; " in words
    assert words.endswith(f"for not met: {opposite}.")
    assert "configuration-1 10.0 [9.0, 11.0]" in words
    four.cases[FOURTH].differences["counted"][:] = 5
    found, words = judge(four)
    assert found is (False if opposite else None)  # nothing is met without all cases
    assert "of too few samples: configuration-4." in words
    four.cases[SECOND] = replace(four.cases[SECOND], settings={**four.cases[SECOND].settings, "scale": 1.25})
    assert "shaken differently" in judge(four)[1]


def test_the_worst_of_the_models_counts(paper):
    for verdicts, worst in (((True, True), True), ((True, None), None), ((None, False), False)):
        found = sys.modules["paper_results"]._worst(
            {model: (one, "So.") for model, one in zip((SOFT, RIGID), verdicts, strict=True)}
        )
        assert found == (worst, "LS-DEM: So. NSCD rigid: So. The worst of the models counts.")


def test_rocking_and_sliding_are_those_of_joints_that_move(four, paper):
    def move(names, counts):
        for case, count in zip(CASES, counts, strict=True):
            for one in four.cases[case].responses.values():
                for name in names:
                    one.samples[name][:] = 0.0
                    one.samples[name].loc[{"joint": one.samples["joint"].values[:count]}] = 1e-3

    for counts, holds in (((1, 10, 10, 10), True), ((2, 13, 13, 13), False), ((3, 20, 20, 20), None)):
        move(["joint_uplift"], counts)  # of 3 joints, and of 20 by the copies
        found, words = paper.occurrences(four)
        assert found is holds or found == holds
        full = "Nothing can be larger than that of configuration-1. No pair of structures is left."
        assert (full in words) == (holds is None)
    move(
        ["joint_uplift", "joint_slip"], (1, 1, 8, 8)
    )  # a rocking block's joint slips a little too, and counts once
    assert paper.complicated(four)[0]
    move(["joint_slip"], (2, 1, 8, 8))
    assert paper.complicated(four)[0] is False


def test_variables_that_matter_are_those_beyond_chance(content, paper):
    for case in content.cases.values():
        result = case.responses[SOFT].sensitivity
        for name in ("first_order", "rank_correlation"):
            result[f"{name}_chance"][:] = 0.5
            result[name][:] = 0.1
        for name in ("materials.concrete.density", MODULUS):
            result["first_order"].loc[{"parameter": name}] = 0.8
    holds, words = paper.parameters_matter(content)
    assert holds is None  # no evidence of an influence is none against it
    assert "Not so: friction. Chance alone makes a share or a correlation of 0.50 to 0.50" in words
    result["first_order"].loc[{"parameter": "friction.concrete.concrete"}] = 0.8
    assert paper.parameters_matter(content)[0]


@pytest.mark.parametrize(("beside", "holds", "share"), [(2.0, True, "none of 2"), (0.5, False, "all 2")])
def test_models_are_alike_where_two_samples_are_as_far_apart(content, paper, beside, holds, share):
    for case in content.cases.values():
        apart = float(case.differences["distance"].sel(model=SOFT, other=RIGID))
        case.differences["width"][:] = beside * apart
        case.differences["distance_chance"][:] = 0.0
        case.differences["counted"][:] = 6
    found, words = paper.alike(content)
    assert found == holds
    assert (
        f"larger one in {share} comparisons, and beyond that of samples exchanged at random in all 2."
        in words
    )
    for case in content.cases.values():
        case.differences["counted"][:] = 5
    assert paper.alike(content)[0] is None
