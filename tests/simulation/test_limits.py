"""Runs that cannot end, cannot be held or are not of their model are refused before anything is allocated."""

import os
import re
import resource

import pytest

from blockshake.cli import BAD_INPUT, main
from blockshake.errors import InputError
from blockshake.geometry.structure import build_structure, load_structure
from blockshake.simulation.limits import LARGEST_RUN, check_limits, run_bytes
from blockshake.simulation.simulate import simulate

MOTION = ["--structure", "configuration-1", "--motion", "alkion", "--output", "r.nc"]


@pytest.fixture
def little_memory():
    """Memory that no answer of minutes fits into."""
    before = resource.getrlimit(resource.RLIMIT_AS)
    resource.setrlimit(resource.RLIMIT_AS, (12 * 2**30, before[1]))
    yield
    resource.setrlimit(resource.RLIMIT_AS, before)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--output-rate", "1e9"], r"--output-rate: expected a run of at most 8.6 GB, not .* GB: 25 s at 1e\+09 Hz"),
        (["--duration", "1e9"], r"--time-step: expected at most 1e\+11 steps, not 1e\+12"),
        (["--duration", "1e7", "--time-step", "0.01"], r"--duration: expected a run of at most 8.6 GB"),
        (["--time-step", "1e-15"], r"--time-step: expected at most 1e\+11 steps, not 2.5e\+16"),
        (["--duration", "0.1", "--output-rate", "7"], "--output-rate: expected at least 10 Hz of 0.1 s, not 7"),
        (["--duration", "0.001"], "--output-rate: expected at least 1000 Hz of 0.001 s, not 200"),
        (["--set", "nscd.impact_parts=1000000000"], "nscd.impact_parts: input should be less than or equal to 1000"),
        *(
            ([f"--{name}", value], f"--{name}: expected a positive number, not")
            for name in ("duration", "time-step", "output-rate")
            for value in ("0", "-1", "nan", "inf")
        ),
    ],
)  # fmt: skip
def test_a_run_beyond_the_limits_is_refused_in_one_line(
    options, words, tmp_path, monkeypatch, capsys, little_memory
):
    monkeypatch.chdir(tmp_path)
    assert main(["simulate", *MOTION, "--model", "nscd-rigid", *options]) == BAD_INPUT
    complaint = capsys.readouterr().err.splitlines()[-1]
    assert re.search(words, complaint), complaint
    assert list(tmp_path.iterdir()) == []


def test_nodes_without_number_are_refused():
    with pytest.raises(
        InputError, match=r"expected at most 1e\+06 nodes, not \de\+\d+: a wider ls_dem.node_spacing"
    ):
        simulate("configuration-1", "alkion", "ls-dem", {"ls_dem.node_spacing": 1e-7}, duration=0.01)


@pytest.mark.parametrize(
    "command",
    [
        ["sample", "--size", "1000000000", "--output", "d.csv"],
        ["animate", "RUN", "--speed", "1e-9", "--output", "a.gif"],
    ],
    ids=lambda command: command[0],
)
def test_other_commands_refuse_what_no_memory_holds(command, tmp_path, monkeypatch, capsys, leaning_file):
    monkeypatch.chdir(tmp_path)
    assert main([str(leaning_file) if word == "RUN" else word for word in command]) == BAD_INPUT
    assert "expected at most" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_an_hour_of_motion_is_within_the_limits():
    structure = load_structure("configuration-3")
    check_limits(structure, "ls-dem", 1e-5, 3600.0, 200.0, fine=True, in_memory=False)
    assert run_bytes(structure, 720_000, 7_372_800, in_memory=False) < LARGEST_RUN


def _stone(make_mapping, **changes):
    mapping = make_mapping([{"name": "a", "shape": "cube", "position": [0.0, 0.0, 0.5]}])
    mapping["materials"]["stone"] |= changes
    return build_structure(mapping, "s.yaml", ".")


def test_the_viscoelastic_model_needs_a_viscous_modulus(make_mapping):
    """Without one it would be the elastic model, to the bit."""
    refused = r"s.yaml: materials.stone.viscous_modulus: expected above 0 for nscd-viscoelastic, not 0"
    for viscous in ({}, {"viscous_modulus": 0.0}):
        with pytest.raises(InputError, match=refused):
            simulate(_stone(make_mapping, **viscous), "alkion", "nscd-viscoelastic", duration=0.01)
    numbers = 1e-3, 1.0, 200.0, False, True
    check_limits(_stone(make_mapping, viscous_modulus=1e8), "nscd-viscoelastic", *numbers)
    check_limits(_stone(make_mapping), "nscd-elastic", *numbers)


def test_a_motion_whose_name_is_not_utf_8_is_refused(tmp_path):
    """A run file holds the name."""
    path = tmp_path / os.fsdecode(b"m\xff.csv")
    path.write_text("time_s,acceleration_x\n0,0\n1,0.1\n2,0\n")
    with pytest.raises(InputError, match=r"^motion: m\\udcff: expected a name in UTF-8"):
        simulate("configuration-1", path, "nscd-rigid", duration=0.01)
