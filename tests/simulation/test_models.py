"""Which parameters a model has no use for, and that they change no bit of its runs."""

import numpy as np
import pytest

from blockshake.dynamics.motion import ground_motion
from blockshake.errors import InputError
from blockshake.simulation.models import ignored_by
from blockshake.simulation.simulate import simulate
from blockshake.study.remarks import unused_settings


def test_a_setting_that_a_model_ignores_is_told_with_the_one_that_it_has():
    settings = {
        "restitution": 0.9, "ls_dem.pulling": True, "nscd_deformable.impact_parts": 4, "nscd.shrink": 0.01,
        "nscd_restitution": 0.1, "materials.stone.poisson_ratio": 0.1, "materials.stone.density": 2400.0,
    }  # fmt: skip
    assert unused_settings(settings, ["nscd-rigid"]) == [
        "restitution has no effect on nscd-rigid, which has nscd_restitution",
        "ls_dem.pulling has no effect on nscd-rigid",
        "nscd_deformable.impact_parts has no effect on nscd-rigid, which has nscd.impact_parts",
        "materials.stone.poisson_ratio has no effect on nscd-rigid",
    ]
    # of a solver that runs too, a setting is meant for it alone
    assert unused_settings(settings, ["ls-dem", "nscd-rigid", "nscd-elastic"]) == [
        "restitution has no effect on nscd-rigid, which has nscd_restitution",
        "restitution has no effect on nscd-elastic, which has nscd_restitution",
        "nscd_restitution has no effect on ls-dem, which has restitution",
        "materials.stone.poisson_ratio has no effect on nscd-rigid",
    ]
    with pytest.raises(InputError, match="model: expected one of ls-dem"):
        ignored_by("restitution", ["dem"])


@pytest.mark.parametrize(
    ("key", "value", "model", "matters"),
    [
        ("restitution", 0.9, "nscd-rigid", False), ("nscd_restitution", 0.9, "nscd-rigid", True),
        ("materials.stone.poisson_ratio", 0.4, "nscd-rigid", False),
        ("materials.stone.poisson_ratio", 0.4, "ls-dem", True),
        ("nscd_restitution", 0.9, "ls-dem", False), ("restitution", 0.9, "ls-dem", True),
    ],
)  # fmt: skip
def test_what_has_no_effect_changes_no_bit(make_structure, key, value, model, matters):
    """A block that drops by 1 mm and is pushed."""
    structure = make_structure([{"name": "block", "shape": "block", "position": [0.0, 0.0, 0.801]}])
    time = np.linspace(0.0, 0.1, 11)
    motion = ground_motion("push", time, {"x": 5.0 * np.sin(30.0 * time)}, "acceleration")
    given = {key: value}
    step = 5e-5 if model == "ls-dem" else 1e-3
    runs = [
        simulate(structure, motion, model, parameters, step, accelerometers=False)["position"].to_numpy()
        for parameters in ({}, given)
    ]
    assert (runs[0].tobytes() != runs[1].tobytes()) == matters
    assert (model not in ignored_by(key, [model])) == matters
