"""Types that a user's editor sees, for the type checker of `make lint`; never run."""

from pathlib import Path
from typing import Literal, assert_type

import xarray as xr
from matplotlib.figure import Figure

import blockshake
from blockshake.diagnosis.verdict.verdict import Verdict
from blockshake.dynamics.motion import GroundMotion
from blockshake.geometry.structure import Structure


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
    blockshake.simulate(structure, motion, modle="ls-dem")  # type: ignore[call-arg]
    raise blockshake.InputError("file.yaml", "key", "expected this")
