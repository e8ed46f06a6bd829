import shutil
from dataclasses import replace

import pytest

from blockshake.diagnosis.nominal.plan import (
    considered,
    open_tests,
    plan_diagnosis,
    simulated_tests,
)
from blockshake.errors import InputError
from blockshake.files import PACKAGE
from blockshake.measurement.campaigns.campaign import load_campaign

CAMPAIGN = PACKAGE.parents[1] / "data" / "virtual-campaign" / "configuration-2"


def test_strongest_of_each_motion_then_by_falling_scale():
    campaign = load_campaign(CAMPAIGN)
    names = open_tests(campaign)
    assert not set(names) & set(campaign.sealed)
    assert simulated_tests(campaign, names, 2) == ["alkion-200", "basso-tirreno-200"]
    assert simulated_tests(campaign, names, 3) == ["alkion-125", "alkion-200", "basso-tirreno-200"]
    assert simulated_tests(campaign, names, 99) == names
    weak = replace(campaign, tests={
        **campaign.tests, names[0]: campaign.tests[names[0]].model_copy(update={"role": "select"}),
    })  # fmt: skip
    assert names[0] in simulated_tests(weak, names, 2)


def test_quick_effort_simulates_nothing():
    plan = plan_diagnosis(CAMPAIGN, "quick")
    assert plan.open == open_tests(plan.campaign)
    assert not plan.tests
    assert not plan.sealed


def test_a_copy_of_a_campaign_has_the_same_ensembles(tmp_path):
    copy = tmp_path / "another-name"
    shutil.copytree(CAMPAIGN, copy)
    plan, other = (plan_diagnosis(folder, "standard") for folder in (CAMPAIGN, copy))
    test = next(iter(plan.tests))
    assert plan.tests[test].digest == other.tests[test].digest


def test_a_sealed_test_is_simulated_as_an_open_one_under_its_motion():
    plan = plan_diagnosis(CAMPAIGN, "standard")
    for name, planned in plan.sealed.items():
        motion = plan.campaign.tests[name].motion
        like = [one for other, one in plan.tests.items() if plan.campaign.tests[other].motion == motion]
        assert planned.duration == max(one.duration for one in like)
        assert planned.markers == like[0].markers


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda text: text.replace("fit", "sealed").replace("select", "sealed"), "found none"),
        (lambda text: text.replace("motion: alkion,", "motion: unheard-of,"), "expected a shipped motion"),
    ],
)
def test_bad_campaigns_are_refused(tmp_path, change, message):
    copy = tmp_path / "campaign"
    shutil.copytree(CAMPAIGN, copy)
    path = copy / "campaign.yaml"
    path.write_text(change(path.read_text()))
    with pytest.raises(InputError, match=message):
        plan_diagnosis(copy, "standard")


def test_an_effect_can_be_left_out_by_its_name_alone():
    assert "weak-joint" not in considered(["weak-joint"])
    with pytest.raises(InputError, match="expected one of"):
        considered(["weak_joint"])
