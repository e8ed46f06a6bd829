import numpy as np
import pandas as pd

from blockshake.pages.blocks import Text
from blockshake.study.report.content import load_content
from blockshake.study.sampling.sample_table import load_design
from blockshake.study.stiffness.section import stiffness


def test_stiffness_of_the_samples_is_told(copied):
    alike = {"ls_dem.normal_stiffness": np.full(20, 1.8e10), "ls_dem.shear_stiffness": np.full(20, 9e9)}
    for case in copied.study["cases"]:
        copied.write_stiffness(case["name"], pd.DataFrame(alike))
    blocks = stiffness(load_content(copied.study, copied.results)).blocks
    said = [block.text for block in blocks if isinstance(block, Text)]
    assert any("normal stiffness k_n 18 to 18 GN/m" in words for words in said)


def test_cases_of_unlike_blocks_have_their_own_stiffness(copied):
    study = copied
    together = load_content(study.study, study.results)
    assert [one.cases for one in together.calibrated] == [("configuration-1", "configuration-4")]
    table = load_design(study.results / "stiffness" / "configuration-4.csv")
    study.write_stiffness("configuration-4", 2.0 * table)
    apart = load_content(study.study, study.results)
    assert [one.cases for one in apart.calibrated] == [("configuration-1",), ("configuration-4",)]
    said = " ".join(getattr(block, "text", "") for block in stiffness(apart).blocks)
    assert "10 samples; configuration-4: " in said
