"""The same bytes with one core and two, with kernels compiled anew and kept; other processors differ by little."""

import os
import subprocess
import sys

import numpy as np
import pytest
import xarray as xr
from checkout import LIMIT
from ledger import DONE, LOST
from likeness import unlike
from work import WORKS, checkout_with_campaign

pytestmark = pytest.mark.faults
PLAIN = {"NUMBA_CPU_NAME": "generic", "NUMBA_CPU_FEATURES": ""}
# m; after a second of shaking: sums that a processor packs otherwise round otherwise, and contacts are stiff
LARGEST_DIFFERENCE = 1e-9


def test_one_core_and_kernels_compiled_anew_give_the_same_bytes(whole, tmp_path):
    checkout = checkout_with_campaign(tmp_path / "one-core")
    answer = subprocess.run(
        checkout.command(*WORKS["study"], engine=("--cores", "1")), cwd=checkout.folder, capture_output=True,
        text=True, timeout=LIMIT, check=False, env={**os.environ, "BLOCKSHAKE_CACHE": str(tmp_path / "cache")},
    )  # fmt: skip
    assert answer.returncode == 0, answer.stdout + answer.stderr
    others = unlike(whole("study").checkout.folder, checkout.folder)
    DONE["study: one core, kernels compiled anew"] += 1
    LOST["study: files unlike those of two cores"] += len(others)
    assert others == []


@pytest.mark.parametrize("model", ["ls-dem", "nscd-rigid"])
def test_a_plain_processor_computes_nearly_the_same(model, tmp_path):
    own, plain = (
        _positions(model, tmp_path / f"{name}.nc", processor)
        for name, processor in (("own", {}), ("plain", PLAIN | {"BLOCKSHAKE_CACHE": str(tmp_path / "plain")}))
    )
    DONE[f"{model}: run compiled for a plain processor"] += 1
    assert np.abs(own - own[0]).max() > 1e-3  # it moves
    assert np.abs(own - plain).max() < LARGEST_DIFFERENCE


def _positions(model, output, environment):
    command = [
        sys.executable, "-m", "blockshake", "simulate", "--structure", "configuration-1", "--motion", "alkion",
        "--scale", "2", "--duration", "1", "--model", model, "--output", output,
    ]  # fmt: skip
    subprocess.run(command, env={**os.environ, **environment}, check=True)
    with xr.open_dataset(output) as run:
        return run["position"].to_numpy()
