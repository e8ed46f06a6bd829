import case_plan
import make_case
import pytest

from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import load_campaign, load_test

SEED = 5  # of a clean case


@pytest.fixture(scope="session")
def clean_campaign(tmp_path_factory):
    """A clean case of the maker, of its tests to fit alone."""
    folder = tmp_path_factory.mktemp("clean")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(case_plan, "PLAN", [test for test in case_plan.PLAN if test[2] == "fit"])
        make_case.make_case(SEED, (), None, folder / "campaign", folder / "truth")
    return load_campaign(folder / "campaign")


@pytest.fixture(scope="session")
def open_tests(clean_campaign):
    """Its tests, by name."""
    return {name: load_test(clean_campaign, name) for name in clean_campaign.tests}


@pytest.fixture(scope="session")
def two_blocks(clean_campaign):
    """Its structure."""
    return load_structure(clean_campaign.structure)
