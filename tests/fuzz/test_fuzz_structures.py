"""Structure files with mutations are read or refused in one line."""

import pytest
import yaml
from contract import run_command, scratch
from hypothesis import given
from hypothesis import strategies as st
from mutations import FEW, MANY, mutated_mappings, mutated_texts, mutations

from blockshake.files import load_yaml, shipped

pytestmark = pytest.mark.slow  # a limit of CPU time, which kernels that are compiled first would break

GOOD = {
    "name": "two", "description": "Two blocks.", "gravity": [0.0, 0.0, -9.81],
    "materials": {"stone": {"density": 2400.0, "youngs_modulus": 3e10, "poisson_ratio": 0.2}},
    "shapes": {"slab": {"box": [3.0, 3.0, 0.2]}, "block": {"box": [0.5, 0.8, 1.0], "chamfer": 0.01}},
    "bodies": [
        {"name": "slab", "shape": "slab", "material": "stone", "position": [0.0, 0.0, -0.1], "driven": True},
        {"name": "low", "shape": "block", "material": "stone", "position": [0.0, 0.0, 0.5],
         "orientation": [1.0, 0.0, 0.0, 0.0], "mass_offset": [0.01, 0.0, 0.0]},
        {"name": "high", "shape": "block", "material": "stone", "position": [0.0, 0.0, 1.5], "density": 2500.0},
    ],
    "friction": [{"pair": ["stone", "stone"], "coefficient": 0.7, "rate_drop": 0.1}],
    "joints": [{"bodies": ["low", "high"], "friction_factor": 0.9}],
    "restitution": 0.5,
    "stoppers": [{"body": "high", "position": [0.25, 0.0, 0.5], "axis": "+x", "gap": 0.1, "stiffness": 1e6}],
    "external_forces": [{"body": "high", "amplitude": 100.0, "start": 1.0, "end": 2.0}],
    "markers": [{"name": "m", "body": "high", "position": [0.25, 0.0, 0.0]},
                {"name": "s", "body": "slab", "position": [1.5, 0.0, 0.0]}],
    "accelerometers": [{"name": "a", "body": "high", "position": [0.0, 0.0, 0.0], "axes": ["x", "z"]}],
}  # fmt: skip
_SHIPPED = shipped("structures", "configuration-1")
DAMAGED = st.one_of(
    mutated_mappings(GOOD).map(lambda mapping: yaml.safe_dump(mapping, allow_unicode=True)),
    mutated_texts(yaml.safe_dump(GOOD)),
    mutated_mappings(load_yaml(_SHIPPED)).map(yaml.safe_dump),
)


def check(text):
    with scratch() as folder:
        with open(f"{folder}/s.yaml", "w", encoding="utf-8", errors="surrogatepass") as file:
            file.write(text)
        run_command(["check", "s.yaml"], folder)


def test_good_structure_is_read():
    check(yaml.safe_dump(GOOD))


@mutations(FEW)
@given(DAMAGED)
def test_mutated_structures(text):
    check(text)


@pytest.mark.slow
@mutations(MANY)
@given(DAMAGED)
def test_many_mutated_structures(text):
    check(text)
