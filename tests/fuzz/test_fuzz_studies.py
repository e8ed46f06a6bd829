"""Configurations of studies with mutations are read or refused in one line."""

from pathlib import Path

import pytest
import yaml
from contract import run_command, scratch
from good_campaign import MOTION, STRUCTURE
from hypothesis import given
from hypothesis import strategies as st
from mutations import FEW, MANY, mutated_mappings, mutated_texts, mutations

pytestmark = pytest.mark.slow  # a limit of CPU time, which kernels that are compiled first would break

STUDY = {
    "name": "small", "description": "Two blocks.", "output_rate": 100.0, "samples_per_job": 5, "date": "2020-01-01",
    "models": {"ls-dem": {"time_step": 5e-5}, "nscd-rigid": {"time_step": 1e-3,
    "parameters": {"nscd.impact_parts": 20}}},
    "cases": [{"structure": "structure.yaml", "motion": "m.csv", "scale": 2.0, "duration": 1.0,
               "samples": {"nscd-rigid": 3}}],
    "ensemble": {
        "size": 10, "seed": 1,
        "distributions": {"friction.stone.stone": {"distribution": "lognormal", "mean": 0.7, "cov": 0.1},
                          "materials.stone.density": {"distribution": "lognormal", "mean": 2400.0, "cov": 0.04}},
        "correlation": "c.csv", "linked": {},
    },
    "ladder": {"first": 0.5, "increment": 0.25, "highest": 4.0, "largest_drift": 0.4},
    "diagnosis": {"campaigns": [], "effort": "quick"},
}  # fmt: skip
CORRELATION = (
    "name,friction.stone.stone,materials.stone.density\n"
    "friction.stone.stone,1,0.3\nmaterials.stone.density,0.3,1\n"
)
DAMAGED = st.one_of(
    mutated_mappings(STUDY).map(
        lambda mapping: ({"study.yaml": yaml.safe_dump(mapping, allow_unicode=True)})
    ),
    mutated_texts(yaml.safe_dump(STUDY)).map(lambda text: {"study.yaml": text}),
    mutated_texts(CORRELATION).map(lambda text: {"c.csv": text}),
)


def checked(changed):
    """Exit code of the check of a study with some files changed."""
    contents = {
        "study.yaml": yaml.safe_dump(STUDY), "structure.yaml": yaml.safe_dump(STRUCTURE), "m.csv": MOTION,
        "c.csv": CORRELATION
    } | changed  # fmt: skip
    with scratch() as folder:
        for name, content in contents.items():
            Path(folder, name).write_bytes(content.encode("utf-8", "surrogatepass"))
        return run_command(["check", "study.yaml"], folder)[0]


def test_a_good_study_is_read():
    assert checked({}) == 0


@mutations(FEW)
@given(DAMAGED)
def test_mutated_studies(changed):
    checked(changed)


@pytest.mark.slow
@mutations(MANY)
@given(DAMAGED)
def test_many_mutated_studies(changed):
    checked(changed)
