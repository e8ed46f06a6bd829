import pytest
from synthetic_campaigns import make_tests, structure_of_three


@pytest.fixture(scope="session")
def three():
    """Three blocks with a marker off the line of the others on each body."""
    return structure_of_three()


@pytest.fixture(scope="session")
def clean_tests(three):
    """Sound sensors: coloured noise, gaps, outliers, offsets, markers within 1 mm."""
    return make_tests(
        three, 1, mounting=1e-3, marker_dropouts=0.01, accelerometer_offset=0.05, outliers=0.002
    )
