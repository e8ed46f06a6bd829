import shutil

from blockshake.diagnosis.gain.extended_runs import planned_sealed
from blockshake.diagnosis.libraries.plan import plan_diagnosis, sealed_tests
from blockshake.files import PACKAGE
from blockshake.measurement.campaigns.campaign import load_campaign

CAMPAIGN = PACKAGE.parents[1] / "data" / "virtual-campaign" / "configuration-2"


def test_a_sealed_test_is_planned_without_its_file(tmp_path):
    copy = tmp_path / "campaign"
    shutil.copytree(CAMPAIGN, copy)
    campaign = load_campaign(copy)
    for name in sealed_tests(campaign):
        (copy / campaign.tests[name].file).write_bytes(b"nobody may read this")
    plan = plan_diagnosis(copy, "quick")
    like = next(iter(plan.tests.values()))
    for name in sealed_tests(campaign):
        planned = planned_sealed(campaign, name, like)
        assert (planned.duration, planned.markers) == (like.duration, like.markers)
