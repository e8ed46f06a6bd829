import pytest

from blockshake.measurement.campaigns.campaign import Sensors


@pytest.fixture(scope="session")
def sensors():
    return Sensors(marker_noise=1e-4, accelerometer_noise=0.02)
