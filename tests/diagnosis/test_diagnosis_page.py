"""Names, constants and efforts on both pages of the diagnosis, and fields of the verdict, are the program's."""

import importlib
import re

import pytest

from blockshake.diagnosis.nominal.plan import EFFORTS as AMOUNTS
from blockshake.diagnosis.outside.registry import FORMS
from blockshake.diagnosis.verdict.verdict import Verdict
from blockshake.effects.registry import EFFECTS
from blockshake.files import PACKAGE

DOCS = PACKAGE.parents[1] / "docs"
PAGE = "".join((DOCS / room / "diagnosis.md").read_text(encoding="utf-8") for room in ("guide", "theory"))
ROWS = [
    [cell.strip() for cell in line.strip("|").split("|")]
    for line in PAGE.splitlines()
    if line.startswith("|") and not line.startswith("|---")
]
UNITS = {
    "mm": 1e-3, "mm/s": 1e-3, "mrad": 1e-3, "ms": 1e-3, "s": 1.0, "%": 1e-2, "standard deviations": 1.0, "widths": 1.0
}  # fmt: skip
VALUE = re.compile(rf"([\d.]+) ({'|'.join(sorted(UNITS, key=len, reverse=True))})(?!\w)")
CONSTANTS = [row for row in ROWS if re.fullmatch(r"`src/\S+\.py: \w+`", row[-1])]
CAUSES = {
    row[0].strip("`")
    for row in ROWS
    if len(row) == 5 and row[0].startswith("`") and row[0].strip("`") not in AMOUNTS
}


def test_every_cause_that_is_tried_is_in_the_table_and_no_other():
    tried = {name for name, one in EFFECTS.items() if one.columns or one.turns or one.lifts}
    assert tried | set(FORMS) == CAUSES


@pytest.mark.parametrize("row", CONSTANTS, ids=lambda row: row[-1].strip("`"))
def test_a_constant_has_the_value_of_its_home(row):
    path, name = row[-1].strip("`").removeprefix("src/").removesuffix("`").split(".py: ")
    number, unit = VALUE.search(row[1]).groups()
    found = getattr(importlib.import_module(path.replace("/", ".")), name)
    assert float(number) * UNITS[unit] == pytest.approx(found, rel=1e-12)


def test_the_efforts():
    stated = {
        row[0].strip("`"): [int(cell) for cell in row[1:]] for row in ROWS if row[0].strip("`") in AMOUNTS
    }
    assert stated == {name: [one.tests, one.draws, one.twins, one.clean] for name, one in AMOUNTS.items()}


def test_the_contract_has_every_field_of_the_verdict():
    text = (DOCS / "guide" / "contracts.md").read_text(encoding="utf-8")
    section = text[text.index("\n## Verdict") : text.index("\n## Conventions")]
    stated = [
        name
        for line in re.findall(r"^\| (`.*?) \|", section, re.MULTILINE)
        for name in re.findall(r"`(\w+)`", line)
    ]
    assert sorted(stated) == sorted(Verdict.model_fields)
