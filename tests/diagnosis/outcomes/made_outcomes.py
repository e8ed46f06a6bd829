"""Made-up campaigns of outcomes, and leans of their tests by a law that is known."""

import numpy as np
import pandas as pd
import xarray as xr
import yaml

from blockshake.diagnosis.outcomes.runs import shares_of
from blockshake.diagnosis.outcomes.unknowns import UNKNOWNS
from blockshake.files import write_dataset

STRUCTURE = {
    "name": "column",
    "materials": {"stone": {"density": 2400.0, "youngs_modulus": 3e10, "poisson_ratio": 0.2}},
    "shapes": {"slab": {"box": [2.0, 2.0, 0.2]}, "column": {"box": [0.2, 0.2, 0.8]}},
    "bodies": [
        {"name": "slab", "shape": "slab", "material": "stone", "position": [0, 0, -0.1], "driven": True},
        {"name": "column", "shape": "column", "material": "stone", "position": [0, 0, 0.4]},
    ],
    "friction": [{"pair": ["stone", "stone"], "coefficient": 0.6}],
}
DRAWS = 5
SLOPES = {"offset_x": 1.5, "friction_factor": 0.3}  # of the logarithm of the lean, by share
_OWN, _SPREAD = 0.3, 0.2


def leans(peaks, shares, generator):
    """Leans [rad] of the law, infinite beyond 20 degrees: (n_tests, n_models)."""
    slope = np.array([SLOPES.get(unknown.name, 0.0) for unknown in UNKNOWNS])
    log = 2.0 * np.log(peaks / 2.0) + np.log(np.radians(20.0)) + _OWN * generator.normal(size=len(peaks))
    log = log[:, None] + shares @ slope
    lean = np.exp(log + _SPREAD * generator.normal(size=log.shape))
    return np.where(lean > np.radians(20.0), np.inf, lean)


def made_campaign(folder, truth, tests=120, seed=1):
    """Folder of a campaign whose outcomes are those of the model ``truth``, and the file of its simulated leans.

    ``truth``: shares by name of the unknown. Every third test is sealed.
    """
    generator = np.random.default_rng(seed)
    folder.mkdir()
    (folder / "column.yaml").write_text(yaml.safe_dump(STRUCTURE))
    peaks = np.exp(generator.uniform(np.log(0.5), np.log(6.0), tests))
    time = np.arange(0.0, 1.0, 0.01)
    table = pd.DataFrame({"time_s": time, "acceleration_x": np.sin(2.0 * np.pi * time)})
    table.to_csv(folder / "sine.csv", index=False)
    acting = np.array([truth.get(unknown.name, 0.0) for unknown in UNKNOWNS])
    shares = np.stack([shares_of(number, DRAWS) for number in range(tests)])
    everything = np.concatenate([shares, np.broadcast_to(acting, (tests, 1, len(UNKNOWNS)))], axis=1)
    lean = leans(peaks, everything, generator)
    listed = pd.DataFrame(
        {
            "name": [f"test-{number}" for number in range(tests)],
            "motion": "sine.csv",
            "scale": peaks,
            "role": np.where(np.arange(tests) % 3 == 2, "sealed", "fit"),
            "outcome": np.where(np.isinf(lean[:, -1]), "fell", "stood"),
        }
    )
    listed.to_csv(folder / "tests.csv", index=False)
    campaign = {"name": "made up", "structure": "column.yaml", "tests": "tests.csv"}
    (folder / "campaign.yaml").write_text(yaml.safe_dump(campaign))
    runs = xr.Dataset(
        {
            "lean": (("test", "draw"), lean[:, :-1]),
            "settled": (("test", "draw"), np.zeros(lean[:, :-1].shape, bool)),
            "share": (("test", "draw", "unknown"), shares),
            "pga": ("test", peaks),
            "pgv": ("test", peaks / 6.0),
        },
        {"test": list(listed["name"]), "unknown": [unknown.name for unknown in UNKNOWNS]},
        {"model": "nscd-rigid"},
    )
    write_dataset(folder / "runs.nc", runs)
    return folder, [folder / "runs.nc"]
