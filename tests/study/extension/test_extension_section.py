"""Words and tables of an extended study, from the made-up study with one case held against itself."""

from dataclasses import replace

import numpy as np
import pytest
from fake_study import STRENGTH, ensemble_of

from blockshake.pages.blocks import Items, Table
from blockshake.study.ensembles.ensemble import join_batches
from blockshake.study.extension.changes import QUANTITIES, changes
from blockshake.study.extension.section import extension
from blockshake.study.report.content import load_content

NAME = "configuration-1-extended"


@pytest.fixture(scope="module")
def content(fake):
    """Content with a case of configuration 1 that a made-up cause lets drift by 2 mm less."""
    loaded = load_content(fake.study, fake.results)
    case = loaded.cases["configuration-1"]
    worn = case.structure.with_parameters({"extension": "worn edges"})
    ensembles = {model: [_ensemble(fake, case, model)] * 2 for model in ("ls-dem", "nscd-rigid")}
    found = changes(ensembles, case.test)
    for model, change in (("ls-dem", -2e-3), ("nscd-rigid", 0.0)):
        row = found.sel(model=model, quantity="drift")["value"].sel(side="without")
        at = {"model": model, "quantity": "drift"}
        found["value"].loc[at] = [float(row), float(row) + change, change]
        found["value_interval"].loc[{**at, "side": "change"}] = [change - 1e-3, change + 1e-3]
    found["gain"][:], found["gain_interval"][:] = 0.5, [0.2, 0.7]
    study = {**loaded.study, "extension": {"cases": {NAME: "configuration-1"}, "named_by": [NAME]}}
    cases = {**loaded.cases, NAME: replace(case, name=NAME, structure=worn)}
    return replace(loaded, study=study, cases=cases, changes={NAME: found})


def _ensemble(fake, case, model):
    runs = [fake.run(case.structure, model, STRENGTH[model] + 0.04 * sample) for sample in range(10)]
    return join_batches([ensemble_of(runs, fake.design)])


def test_a_change_beyond_its_limits_is_told_and_another_is_not(content):
    (items,) = [block for block in extension(content).blocks if isinstance(block, Items)]
    told, silent = items.items
    assert told.startswith(
        f"{NAME}, LS-DEM, 10 pairs of samples: worn edges changes 95 % quantile of the drift [mm]"
    )
    assert "by -2.0 [-3.0, -1.0]." in told
    assert "nothing beyond its limits" in silent
    assert "Not distinguished from no change: median of the drift, 95 % quantile of the drift" in silent


def test_tables_have_every_quantity_that_is_known_and_the_tests(content):
    tables = [block for block in extension(content).blocks if isinstance(block, Table)]
    known = [one for one in QUANTITIES if one != "safe_scale"]
    assert len(tables[0].rows) == 2 * len(known)
    assert tables[1].rows[0][:4] == (NAME, "virtual, virtual test (synthetic)", "yes", "LS-DEM")
    assert tables[1].rows[0][-1] == "0.50 [0.20, 0.70]"
    unknown = content.changes[NAME].copy()
    unknown["gain"] = np.nan * unknown["gain"]
    without = extension(replace(content, changes={NAME: unknown}))
    assert without.blocks[-1].rows[0][-1] == "none"


def test_a_study_without_a_cause_has_no_section_and_nor_has_a_case_alone(content, document):
    assert "extension" not in [section.key for section in document.sections]
    assert extension(replace(content, only="configuration-1")) is None
