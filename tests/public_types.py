"""Types that a user's editor sees, for the type checker of `make lint`; never run."""

from pathlib import Path
from typing import Literal, assert_type

import pandas as pd
import xarray as xr
from matplotlib.figure import Figure

import blockshake
from blockshake.diagnosis.planning.plan_campaign import CampaignPlan
from blockshake.diagnosis.verdict.verdict import Verdict
from blockshake.dynamics.motion import GroundMotion
from blockshake.geometry.structure import Structure
from blockshake.measurement.campaigns.campaign import Campaign


def calls(folder: Path) -> None:
    """Calls of every public function, with the type of its result."""
    structure = assert_type(blockshake.load_structure({"name": "wall"}), Structure)
    motion = assert_type(blockshake.load_motion({"time_s": [0.0, 1.0]}, scale=2.0), GroundMotion)
    run = assert_type(blockshake.simulate(structure, motion, "nscd-rigid", scale=1.5), xr.Dataset)
    assert_type(blockshake.simulate("configuration-1", folder / "a.at2", "ls-dem"), xr.Dataset)
    assert_type(blockshake.check(structure), str)
    assert_type(blockshake.plot(run), Figure)
    assert_type(blockshake.animate(run, folder / "run.gif"), Path)
    assert_type(blockshake.export("run.nc", folder / "run.csv"), list[Path])
    assert_type(blockshake.draw_samples(50).rms_error, float)
    assert_type(blockshake.calibrate_stiffness(structure)["normal_stiffness"], float)
    role = blockshake.load_campaign(folder).tests["t1"].role
    assert_type(role, Literal["fit", "select", "sealed"])
    verdict = assert_type(blockshake.diagnose(folder, folder / "out", cores=2), Verdict)
    assert_type(verdict.causes, tuple[str, ...])
    runs = blockshake.simulate(structure, motion, models=["ls-dem", "nscd-rigid"], scale=1.5)
    assert_type(runs, dict[str, xr.Dataset])
    assert_type(blockshake.largest_responses(run), pd.DataFrame)
    assert_type(blockshake.motion_figures(motion), dict[str, float])
    assert_type(blockshake.convert_motion(folder / "a.at2", "motion.csv", unit="g"), GroundMotion)
    assert_type(blockshake.import_campaign({"name": "mine"}, folder), Campaign)
    assert_type(blockshake.plan_campaign("my.yaml", ["alkion@2.5"], folder), CampaignPlan)
    assert_type(blockshake.run_study("study.yaml", cores=1), list[Path])
    assert_type(blockshake.extend_study("verdict.json", "study.yaml", "out.yaml"), list[str])
    blockshake.simulate(structure, motion, modle="ls-dem")  # type: ignore[call-overload]
    raise blockshake.InputError("file.yaml", "key", "expected this")
