"""Memory of the sensors' noise in smoothed accelerations."""

import numpy as np

from blockshake.forces.local_fit import fit_locally

_WIDTH, _STEP = 0.015, 0.001


def test_second_derivative_of_smoothed_white_noise_forgets_as_the_covariance_says():
    rows = []
    reach = np.arange(-100, 101)
    for lag in (0.0, 0.01, 0.02, 0.03):
        # weights of all readings in the second derivative at a time
        unit = np.eye(len(reach))
        values, _ = fit_locally(_STEP * reach, unit, np.array([lag]), _WIDTH)
        rows.append(values[2, 0])
    found = np.array([rows[0] @ row for row in rows]) / (rows[0] @ rows[0])
    u = np.array([0.0, 0.01, 0.02, 0.03]) / (np.sqrt(2.0) * _WIDTH)
    expected = (u**4 - 6.0 * u**2 + 3.0) / 3.0 * np.exp(-0.5 * u**2)
    np.testing.assert_allclose(found, expected, atol=0.01)
