"""Parameters of a sample that reach a structure: what it has, and what is linked to what was sampled."""

import pandas as pd

from blockshake.geometry.structure import load_structure
from blockshake.study.sampling.distributions import LINKED
from blockshake.study.sampling.sample_parameters import sample_parameters

SAMPLED = {
    "friction.concrete.foundation": 0.7,
    "friction.concrete.steel": 0.25,
    "materials.concrete.youngs_modulus": 3e10,
    "materials.steel.density": 7800.0,
    "shapes.block.hollow": 5e-4,
    "shapes.beam.hollow": 2e-4,
}


def test_a_structure_takes_what_it_has():
    given = sample_parameters(pd.Series(SAMPLED), load_structure("configuration-1"), LINKED)
    assert given == {
        "friction.concrete.foundation": 0.7,
        "materials.concrete.youngs_modulus": 3e10,
        "materials.foundation.youngs_modulus": 3e10,
        "shapes.block.hollow": 5e-4,
    }
    changed = load_structure("configuration-1", given).file
    assert changed.shapes["block"].hollow == 5e-4
    assert changed.shapes["slab"].hollow == 0.0


def test_a_mesh_has_no_hollow():
    structure = load_structure("configuration-1")
    meshed = structure.file.shapes["block"].model_copy(update={"box": None, "mesh": "block.stl"})
    structure.file.shapes["block"] = meshed
    assert sample_parameters(pd.Series({"shapes.block.hollow": 5e-4}), structure, LINKED) == {}
