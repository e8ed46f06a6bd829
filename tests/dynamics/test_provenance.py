"""A record that went through `convert-motion` keeps where it comes from and what was done to it."""

import json

import numpy as np
import pytest

from blockshake.cli import main
from blockshake.dynamics.describe_motion import describe_motion
from blockshake.dynamics.load_motion import load_motion
from blockshake.files import file_digest, history
from blockshake.measurement.campaigns.campaign_folder import motion_in_folder


@pytest.fixture
def converted(tmp_path):
    """A record of PEER that does not end at rest, and its CSV."""
    acceleration = 0.1 * np.sin(2.0 * np.pi * np.arange(2000) / 100.0) + 0.002
    head = [
        "PEER NGA STRONG MOTION DATABASE RECORD",
        "Made up, 2026",
        "ACCELERATION TIME SERIES IN UNITS OF G",
    ]
    rows = [" ".join(f"{one: .7E}" for one in row) for row in acceleration.reshape(-1, 5)]
    (tmp_path / "own.at2").write_text("\n".join([*head, "NPTS= 2000, DT= 0.01 SEC", *rows]) + "\n")
    assert main(["convert-motion", str(tmp_path / "own.at2"), "--output", str(tmp_path / "own.csv")]) == 0
    return tmp_path


def test_a_converted_record_keeps_its_attributes(converted):
    record, read = (load_motion(converted / f"own.{kind}") for kind in ("at2", "csv"))
    kept = {name: value for name, value in record.attributes.items() if name != "record_start"}
    assert kept == {name: value for name, value in read.attributes.items() if name != "history"}
    assert read.attributes["source"] == "own.at2"
    assert "corrected, not at rest" in read.attributes["baseline"]
    (line,) = read.attributes["history"].splitlines()
    assert "convert-motion: own.at2 (" in line
    assert "corrected, not at rest" in line
    assert line.endswith(f"digest of own.at2: {file_digest(converted / 'own.at2')}")


def test_a_second_conversion_adds_a_line(converted):
    again = converted / "again.csv"
    assert main(["convert-motion", str(converted / "own.csv"), "--output", str(again)]) == 0
    first, second = load_motion(again).attributes["history"].splitlines()
    assert first == load_motion(converted / "own.csv").attributes["history"]
    assert "convert-motion: own.at2" in second
    assert history("a", "b").splitlines()[0] == "a"


@pytest.mark.parametrize("content", ["", "[]", "{}", '{"csv": 1}', None])
def test_attributes_of_another_file_are_not_taken(converted, content):
    beside = converted / "own.csv-metadata.json"
    if content is None:  # the CSV was altered since
        text = (converted / "own.csv").read_text()
        (converted / "own.csv").write_text(text.replace("acceleration_x", "acceleration_y"))
    else:
        beside.write_text(content)
    attributes = load_motion(converted / "own.csv").attributes
    assert (attributes["source"], attributes["format"], attributes["baseline"]) == ("own.csv", "csv", "none")
    assert "history" not in attributes


def test_a_campaign_takes_the_attributes_along(converted):
    folder = converted / "campaign"
    assert motion_in_folder(str(converted / "own.csv"), folder) == "own.csv"
    assert load_motion(folder / "own.csv").attributes == load_motion(converted / "own.csv").attributes


def test_a_synthetic_motion_stays_synthetic(tmp_path):
    assert main(["convert-motion", "alkion", "--output", str(tmp_path / "a.csv")]) == 0
    assert load_motion(tmp_path / "a.csv").attributes["synthetic"]
    described = describe_motion(load_motion(tmp_path / "a.csv"), tmp_path / "a.csv")
    assert described.attrs["synthetic"] == 1
    assert "convert-motion: " in described.attrs["history"]
    assert json.loads((tmp_path / "a.csv-metadata.json").read_text())["attributes"]["synthetic"] is True
