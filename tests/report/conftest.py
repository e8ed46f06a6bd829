import pytest
from fake_study import FakeStudy


@pytest.fixture(scope="session")
def fake(tmp_path_factory):
    """The made-up study's files."""
    return FakeStudy(tmp_path_factory.mktemp("fake"))
