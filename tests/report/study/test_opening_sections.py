from dataclasses import replace

import numpy as np
import pandas as pd
from fake_study import MODELS
from page import texts

from blockshake.report.document.blocks import Heading, Text
from blockshake.report.study.content import load_content
from blockshake.report.study.opening_sections import motions, samples, stiffness, structures
from blockshake.study.sampling.latin_hypercube import load_design


def test_a_structure_of_two_cases_is_shown_once(fake):
    found = load_content(fake.study, fake.results, fake.logs)
    found.cases["stronger"] = replace(found.cases["configuration-1"], name="stronger")
    blocks = structures(found).blocks
    headings = [block.text for block in blocks if isinstance(block, Heading)]
    assert headings[0] == "configuration-1, stronger"
    assert len(headings) == len(fake.study["cases"])


def test_stiffness_that_is_one_in_all_samples_is_a_number(copied):
    alike = {"ls_dem.normal_stiffness": np.full(20, 1.8e10), "ls_dem.shear_stiffness": np.full(20, 9e9)}
    for case in copied.study["cases"]:
        copied.write_stiffness(case["name"], pd.DataFrame(alike))
    blocks = stiffness(load_content(copied.study, copied.results, copied.logs)).blocks
    said = [block.text for block in blocks if isinstance(block, Text)]
    assert any("normal stiffness k_n 18 GN/m" in words and "the same in all" in words for words in said)


def test_cases_of_unlike_blocks_have_their_own_stiffness(copied):
    study = copied
    together = load_content(study.study, study.results, study.logs)
    assert [one.cases for one in together.calibrated] == [("configuration-1", "configuration-4")]
    table = load_design(study.results / "stiffness" / "configuration-4.csv")
    study.write_stiffness("configuration-4", 2.0 * table)
    apart = load_content(study.study, study.results, study.logs)
    assert [one.cases for one in apart.calibrated] == [("configuration-1",), ("configuration-4",)]
    captions = " ".join(getattr(block, "caption", "") for block in stiffness(apart).blocks)
    assert "10 samples; configuration-4 (after" in captions


def test_variables_without_use_are_those_of_the_models_of_the_study(fake):
    study = {**fake.study, "models": {"ls-dem": MODELS["ls-dem"]}}
    said = " ".join(texts(samples(load_content(study, fake.results, fake.logs))))
    assert "LS-DEM has no use for viscous modulus of concrete" in said
    assert "NSCD rigid has no use" not in said


def test_a_record_is_said_with_its_format_and_baseline(fake):
    found = load_content(fake.study, fake.results, fake.logs)
    name = next(iter(found.motions))
    record = {"source": "r.AT2", "format": "PEER NGA AT2", "baseline": "corrected, not at rest"}
    found.motions[name] = found.motions[name].assign_attrs(synthetic=0, **record)
    said = " ".join(texts(motions(found)))
    assert f"{name}: r.AT2 (PEER NGA AT2); baseline: corrected, not at rest." in said
