import copy
import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from fake_study import FakeStudy, ensemble_of
from page import Page

from blockshake.measurement.sensors.markers import noisy_reading
from blockshake.study.report.content import load_content
from blockshake.study.report.report import compose, make_report

TIME = np.arange(401) / 200.0
MARKERS = ["slab-face", "block-1-face"]
ONE_BLOCK = """
name: one-block
materials: {{stone: {{density: 2400.0, youngs_modulus: 3.45e+10, poisson_ratio: 0.2}}}}
shapes: {{slab: {{box: [6.0, 3.0, 0.4]}}, block: {{box: {box}}}}}
bodies:
  - {{name: slab, shape: slab, material: stone, position: [0.0, 0.0, -0.2], driven: true}}
  - {{name: block, shape: block, material: stone, position: [0.0, 0.0, {half}]}}
friction: [{{pair: [stone, stone], coefficient: 0.6}}]
markers:
  - {{name: slab, body: slab, position: [0.0, 0.0, 0.2]}}
  - {{name: top, body: block, position: [0.0, 0.0, {half}]}}
accelerometers:
  - {{name: slab-acc, body: slab, position: [0.0, 0.0, 0.2], axes: [x]}}
  - {{name: top-acc, body: block, position: [0.0, 0.0, {half}], axes: [x]}}
"""


@pytest.fixture
def make_run():
    """Run Dataset whose block marker is at ``slab + amplitude`` along x, with a known rotation; its joint opens by half
    the block's width times the angle and slips by the amplitude."""

    def make(amplitude, slab=0.0, angle=0.0, status="completed", end=TIME[-1], sample=0):
        displacement = np.zeros((len(TIME), 2, 3))
        displacement[1:, :, 0] = np.broadcast_to(slab, TIME.shape)[1:, None]
        displacement[1:, 1, 0] += np.broadcast_to(amplitude, TIME.shape)[1:]
        position = np.zeros((len(TIME), 2, 3))
        position[:, 1] = displacement[:, 1] + [0.0, 0.0, 0.8]
        lean = angle * TIME / TIME[-1]
        orientation = np.zeros((len(TIME), 2, 4))
        orientation[:, 0, 0] = 1.0
        orientation[:, 1, 0], orientation[:, 1, 2] = np.cos(lean / 2), np.sin(lean / 2)
        over = end + 1e-9 < TIME
        for values in (displacement, position, orientation):
            values[over] = np.nan
        return xr.Dataset(
            {
                "marker_displacement": (("time", "marker", "axis"), displacement, {"units": "m"}),
                "position": (("time", "body", "axis"), position, {"units": "m"}),
                "orientation": (("time", "body", "quaternion"), orientation, {"units": "1"}),
                "joint_compression": ("joint", [1e5], {"units": "N", "long_name": "compression"}),
                "joint_uplift": ("joint", [0.4 * angle], {"units": "m", "long_name": "uplift"}),
                "joint_slip": ("joint", [np.abs(amplitude).max()], {"units": "m", "long_name": "slip"}),
                "joint_margin": ("joint", [np.cos(angle)], {"units": "1", "long_name": "margin"}),
                "joint_spin_kept": ("joint", [np.nan], {"units": "1", "long_name": "spin kept"}),
                "blows": ((), 0.0, {"units": "1", "long_name": "blows"}),
                "blow_velocity": ((), 0.0, {"units": "m s-1", "long_name": "velocity of the fastest blow"}),
                "blow_pair": ((), ""),
            },
            coords={
                "time": ("time", TIME, {"units": "s"}),
                "marker": MARKERS,
                "marker_body": ("marker", ["slab", "block-1"]),
                "body": ["slab", "block-1"],
                "joint": ["slab-block-1"],
                "axis": ["x", "y", "z"],
                "quaternion": ["w", "x", "y", "z"],
            },
            attrs={
                "model": "ls-dem",
                "status": status,
                "reason": "" if status == "completed" else "fell",
                "end_time": end,
                "sample": sample,
            },
        )

    return make


@pytest.fixture
def gather():
    """Ensemble of runs as samples 0, 1, ... of a design with one friction value each."""

    def gathered(runs):
        design = pd.DataFrame({"friction.concrete.concrete": 0.5 + 0.01 * np.arange(len(runs))})
        return ensemble_of(runs, design)

    return gathered


@pytest.fixture
def read_with_noise():
    """Synthetic measurement of a run: its markers with independent Gaussian noise."""

    def read(run, noise, seed):
        displacement = run["marker_displacement"].transpose("time", "marker", "axis")
        noisy = displacement.copy(
            data=noisy_reading(displacement.to_numpy(), noise, np.random.default_rng(seed))
        )
        return xr.Dataset({"marker_displacement": noisy}, attrs={"synthetic": 1})

    return read


@pytest.fixture
def one_block(tmp_path):
    """Writer of a structure file of one block on a slab, from the edge lengths of the block [m]."""

    def written(box, accelerometers=True):
        text = ONE_BLOCK.format(box=box, half=0.5 * box[2])
        path = tmp_path / "one-block.yaml"
        path.write_text(text if accelerometers else text.split("accelerometers:")[0])
        return path

    return written


@pytest.fixture(scope="session")
def fake(tmp_path_factory):
    """The made-up study's files."""
    return FakeStudy(tmp_path_factory.mktemp("fake"))


@pytest.fixture(scope="session")
def report(fake, tmp_path_factory):
    folder = tmp_path_factory.mktemp("report")
    paths = folder / "fake.html", folder / "fake.pdf"
    make_report(fake.study, fake.results, *paths)
    return paths


@pytest.fixture(scope="session")
def document(fake):
    """Composed a second time from the same files."""
    return compose(load_content(fake.study, fake.results))


@pytest.fixture
def copied(fake, tmp_path):
    """The made-up study with results of its own, to be changed."""
    own = copy.copy(fake)
    own.results = Path(shutil.copytree(fake.results, tmp_path / "results"))
    return own


@pytest.fixture(scope="session")
def page(report):
    parsed = Page()
    parsed.feed(report[0].read_text(encoding="utf-8"))
    parsed.close()
    return parsed


@pytest.fixture(scope="session")
def text(page):
    return " ".join(" ".join(page.words).split())
