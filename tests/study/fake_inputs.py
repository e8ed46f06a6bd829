"""Made-up inputs of a study: motions, wave tests, a joint calibration."""

import numpy as np
import xarray as xr

from blockshake.study.calibration.answers import chance_of_test, distances
from blockshake.study.calibration.calibration import calibrate

PEAK_ACCELERATION = 1.234  # m/s2


def motion(name, place):
    """A motion's Dataset as `describe_motion` makes it."""
    time = np.arange(0.0, 4.0, 0.02)
    sine = np.sin((place + 4.0) * time)
    periods = np.geomspace(0.04, 4.0, 30)
    return xr.Dataset(
        {
            "acceleration": ("time", PEAK_ACCELERATION * sine),
            "velocity": ("time", 0.1 * sine),
            "displacement": ("time", 0.02 * sine),
            "pseudo_acceleration": ("period", 3.0 / (1.0 + periods)),
            "target": ("ordinate", [2.5, 1.5]),
            "target_period": ("ordinate", [0.2, 1.0]),
            "published": ("ordinate", [1, 0]),
        },
        coords={"time": time, "period": periods},
        attrs={
            "name": name,
            "synthetic": 1,
            "source": "made up",
            "format": "synthetic",
            "peak_acceleration": PEAK_ACCELERATION,
            "peak_velocity": 0.1,
            "peak_displacement": 0.02,
            "arias_intensity": 0.3,
            "significant_duration": 2.5,
            "significant_end": 3.0,
            "duration": 4.0,
        },
    )


def waves():
    """Wave tests as `wave_tests` makes them; the second is the longer one."""
    time = np.arange(0.0, 8e-3, 1e-4)
    arrival = np.array([[4e-4, 9e-4], [7e-4, 1.4e-3]])
    displacement = 1e-3 * np.maximum(time[None, :, None] - arrival[:, None, :], 0.0)
    velocity = 1e-3 * (time[None, :, None] > arrival[:, None, :])
    for one in (displacement, velocity):
        one[0, time > 6e-3] = np.nan
    return xr.Dataset(
        {
            "displacement": (("direction", "time", "block"), displacement),
            "velocity": (("direction", "time", "block"), velocity),
            "arrival": (("direction", "block"), arrival),
            "stiffness": ("direction", [1.8e10, 0.9e10]),
            "wave_speed": ("direction", [3791.3, 2447.1]),
            "target_wave_speed": ("direction", [3791.4, 2447.4]),
        },
        coords={"direction": ["normal", "shear"], "time": time, "block": ["block-1", "block-2"]},
        attrs={"definition": "half of the step", "step_velocity": 1e-3},
    )


def calibrated(study):
    """Joint calibration of two tests by two models: friction acts on the readings, restitution and stiffness do not."""
    size, used = 24, ("friction.concrete.concrete", "restitution", "stiffness_factor")
    generator = np.random.default_rng(9)
    shares = np.array([generator.permutation((np.arange(size) + 0.5) / size) for _ in used])
    compared = []
    for model, kept in (("ls-dem", 3), ("nscd-rigid", 1)):
        found = [
            distances(shares[0][:, None] + 0.05 * generator.normal(size=(size, 8)), np.full(8, truth))
            for truth in (0.7, 9.0)  # the second test is like no sample
        ]
        compared.append(
            xr.Dataset(
                {
                    "to_test": (("test", "reading", "sample"), [[one.to_test] for one in found]),
                    "between": (("test", "reading", "sample", "other"), [[one.between] for one in found]),
                    "chance": (("test", "reading"), [[chance_of_test(one)] for one in found]),
                    "share": (("parameter", "sample"), shares[:kept]),
                    "motion": ("test", ["alkion", "alkion"]),
                    "scale": ("test", [1.0, 2.0]),
                    "synthetic": ("test", [1, 1]),
                    "unsolved": ("test", [0, 2]),
                },
                {"test": ["weak", "strong"], "reading": ["displacement"], "parameter": list(used[:kept])},
                {"case": "configuration-1", "model": model},
            )
        )
    return calibrate(compared, study)
