"""Runs of odd physics - huge, tiny, falling, wedged - end with a status and a reason, or are refused in one line."""

from pathlib import Path

import pytest
import xarray as xr
import yaml
from contract import NUMERICAL_FAILURE, run_command, scratch
from good_campaign import MOTION, STRUCTURE
from hypothesis import given
from hypothesis import strategies as st
from mutations import FEW, MANY, mutations

from blockshake.dynamics.system import Status

# By dotted name: values from harmless to absurd.
ODD_PHYSICS = {
    "gravity": ([0.0, 0.0, 0.0], [0.0, 0.0, 9.81], [1e6, 0.0, -9.81], [0.0, 0.0, -1e12], [1e200, 0.0, 0.0]),
    "friction.stone.stone": (0.0, 1e-300, 5.0, 1e6, 1e300),
    "materials.stone.density": (1e-300, 1e-3, 1e9, 1e200),
    "materials.stone.youngs_modulus": (1e-300, 1.0, 1e15, 1e300),
    "materials.stone.poisson_ratio": (-0.999999, 0.4999999),
    "materials.stone.viscous_modulus": (1e-300, 1e12, 1e300),
    "bodies.high.velocity": ([0.0, 0.0, -500.0], [1e3, 0.0, 0.0], [1e200, 0.0, 0.0]),
    "bodies.high.angular_velocity": ([0.0, 1e3, 0.0], [1e6, 1e6, 1e6], [0.0, 1e200, 0.0]),
    "bodies.high.position": ([0.0, 0.0, 100.0], [1e15, 0.0, 0.0], [0.0, 0.0, 1.4995], [1e200, 0.0, 0.0]),
    "bodies.high.density": (1e-300, 1e-6, 1e12),
    "joints.low.high.friction_factor": (0.0, 1e300),
    "joints.low.high.compliance": (1e-300, 1e-3, 1e300),
    "restitution": (0.0, 1e-9, 1.0),
    "nscd_restitution": (1.0,),
    "stoppers.0.stiffness": (0.0, 1e15, 1e300),
    "stoppers.0.gap": (0.0, 1e300),
    "external_forces.0.amplitude": (1e9, -1e15, 1e300),
    "external_forces.0.start": (0.0,),
    "external_forces.0.damping": (-1e6, 1e12, 1e300),
    "external_forces.0.stiffness": (-1e9, 1e15, 1e300),
}
MODELS = {"nscd-rigid": ("1e-3", "1e-2"), "ls-dem": ("1e-5", "5e-5", "1e-3"), "nscd-elastic": ("1e-3",)}
ODD_RUNS = st.tuples(
    st.sampled_from(list(MODELS)),
    st.dictionaries(st.sampled_from(list(ODD_PHYSICS)), st.integers(0, 4), min_size=1, max_size=3),
    st.sampled_from(("1", "-1", "0", "1e3", "1e9", "1e250", "nan", "inf")),
    st.integers(0, 2),
)


def ran(chosen):
    """Exit code of a simulation; a run that was computed says how it ended."""
    model, settings, scale, step = chosen
    arguments = [
        "simulate",
        "--structure",
        "s.yaml",
        "--motion",
        "m.csv",
        "--scale",
        scale,
        "--duration",
        "0.02",
    ]
    arguments += [
        "--model",
        model,
        "--time-step",
        MODELS[model][step % len(MODELS[model])],
        "--output",
        "r.nc",
    ]
    for name, place in settings.items():
        value = ODD_PHYSICS[name][place % len(ODD_PHYSICS[name])]
        arguments += ["--set", f"{name}={yaml.safe_dump(value, default_flow_style=True).split(chr(10))[0]}"]
    with scratch() as folder:
        Path(folder, "s.yaml").write_text(yaml.safe_dump(STRUCTURE))
        Path(folder, "m.csv").write_text(MOTION)
        code, _, complained = run_command(arguments, folder, codes=(0, 2, NUMERICAL_FAILURE))
        if code == 2:
            assert not Path(folder, "r.nc").exists()
            return code
        run = xr.load_dataset(f"{folder}/r.nc")
        assert run.attrs["status"] in set(Status)
        if code == NUMERICAL_FAILURE:
            assert run.attrs["reason"]
            assert run.attrs["reason"] in complained
        return code


def test_an_ordinary_run_is_done():
    assert ran(("nscd-rigid", {"restitution": 1}, "1", 0)) == 0


@mutations(FEW)
@given(ODD_RUNS)
def test_runs_of_odd_physics(chosen):
    ran(chosen)


@pytest.mark.slow
@mutations(MANY)
@given(ODD_RUNS)
def test_many_runs_of_odd_physics(chosen):
    ran(chosen)
