import shutil

import pytest

from blockshake.diagnosis.libraries.efforts import EFFORTS, open_tests, own_draws
from blockshake.diagnosis.libraries.plan import (
    considered,
    plan_diagnosis,
    plan_of_library,
    sealed_tests,
)
from blockshake.errors import InputError
from blockshake.files import PACKAGE
from blockshake.measurement.campaigns.campaign import load_campaign

CAMPAIGN = PACKAGE.parents[1] / "data" / "virtual-campaign" / "configuration-2"


def test_strongest_of_each_motion_then_the_weakest_then_by_falling_scale():
    campaign = load_campaign(CAMPAIGN)
    assert open_tests(campaign, EFFORTS["quick"]) == ["alkion-275", "basso-tirreno-200"]
    assert open_tests(campaign, EFFORTS["standard"]) == [
        "alkion-275",
        "basso-tirreno-050",
        "basso-tirreno-200",
    ]
    assert not set(open_tests(campaign, EFFORTS["deep"])) & set(sealed_tests(campaign))


def test_runs_stay_within_the_effort():
    for name, effort in EFFORTS.items():
        for candidates in (16, 20, 25):
            for sealed in (0, 1, 2):
                tests = effort.tests
                own = own_draws(effort, candidates, tests, sealed)
                of_ensembles = 3 * sealed * effort.members
                of_test = effort.nominal_draws + own * candidates + 1 + effort.twins
                runs = 2 * (tests * of_test + of_ensembles)
                assert runs <= effort.runs, name


def test_more_candidates_than_runs_are_refused():
    with pytest.raises(InputError, match="larger effort"):
        own_draws(EFFORTS["quick"], 200, 2, 1)


def test_a_copy_of_a_campaign_has_the_same_library(tmp_path):
    copy = tmp_path / "another-name"
    shutil.copytree(CAMPAIGN, copy)
    plan, other = (plan_diagnosis(folder, "quick") for folder in (CAMPAIGN, copy))
    test = next(iter(plan.tests))
    assert plan.library(test, "s") == other.library(test, "s")
    assert plan.library(test, "s") != plan.library(test, "t")
    assert plan.calibration("s") == other.calibration("s")
    assert plan.calibration("s") != plan_diagnosis(copy, "quick", ["weak-joint"]).calibration("s")
    found, name = plan_of_library(plan.library(test, "s"), [str(copy)], "quick", "s")
    assert (name, found.campaign.folder) == (test, copy)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda text: text.replace("role: fit", "role: sealed"), "expected at least 2 different tests"),
        (lambda text: text.replace("fit", "sealed").replace("select", "sealed"), "found 0"),
        (lambda text: text.replace("motion: alkion,", "motion: unheard-of,"), "expected a shipped motion"),
    ],
)
def test_bad_campaigns_are_refused(tmp_path, change, message):
    copy = tmp_path / "campaign"
    shutil.copytree(CAMPAIGN, copy)
    path = copy / "campaign.yaml"
    path.write_text(change(path.read_text()))
    with pytest.raises(InputError, match=message):
        plan_diagnosis(copy, "quick")


def test_an_effect_can_be_left_out_by_its_name_alone():
    assert "weak-joint" not in considered(["weak-joint"])
    with pytest.raises(InputError, match="expected one of"):
        considered(["weak_joint"])
