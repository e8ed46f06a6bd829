"""The study of a statue from one file: structure, records chosen to a spectrum, uncertain sizes, limit states."""

import shutil
import subprocess
import sys

import pandas as pd
import pytest
import yaml

import blockshake
from blockshake.errors import InputError
from blockshake.files import PACKAGE, load_yaml
from blockshake.own_files.check import check

EXAMPLE = PACKAGE.parents[1] / "examples" / "statue"


@pytest.fixture
def statue(tmp_path, monkeypatch):
    """The study in a folder of its own, with its made-up records."""
    monkeypatch.chdir(tmp_path)
    shutil.copy(EXAMPLE / "statue.yaml", tmp_path)
    subprocess.run([sys.executable, EXAMPLE / "records.py", "records"], check=True)
    return tmp_path / "statue.yaml"


def test_the_study_is_understood(statue):
    said = check("statue.yaml")
    assert "a study of 1 case by nscd-rigid (64 samples)" in said
    assert "statue: 8 records are chosen" in said
    assert said.count(" (csv); assumed") == 8
    lines = [line for line in statue.read_text().splitlines() if not line.startswith("#")]
    assert len(lines) <= 42


def test_forty_records_at_rest_of_twenty_events(statue):
    events = pd.read_csv("records/set.csv")["event"]
    assert (len(events), events.nunique()) == (40, 20)
    remarks = [blockshake.check(f"records/record-{number:02}.csv") for number in (1, 20, 40)]
    assert not any("remark" in one for one in remarks)


def test_the_structure_of_a_study_is_that_of_a_file(statue):
    mapping = load_yaml(statue)
    inside = blockshake.load_structure("statue.yaml", {"shapes.statue.box.z": 2.0})
    alone = blockshake.load_structure(
        {"name": "statue", **mapping["structure"]}, {"shapes.statue.box.z": 2.0}
    )
    assert inside.content == alone.content
    assert inside.file.name == "statue"
    mapping["structure"]["bodies"][2]["on"] = "plinth"
    statue.write_text(yaml.safe_dump(mapping))
    with pytest.raises(
        InputError, match=r"statue\.yaml.*bodies\.statue\.on: expected another body of this structure"
    ):
        check("statue.yaml")
