"""Names that mean something to a page, a formula, a shell or a workflow are but names."""

import copy
import dataclasses
import html
import json
import re
import subprocess
import sys

import numpy as np
import pytest
import yaml
from contract import run_command
from good_campaign import CAMPAIGN, files
from test_fuzz_structures import GOOD
from test_fuzz_studies import CORRELATION, STUDY

from blockshake import run_diagnosis
from blockshake.dynamics.motion import ground_motion
from blockshake.errors import InputError
from blockshake.files import PACKAGE, write_dataset
from blockshake.geometry.structure import build_structure
from blockshake.measurement.campaigns.campaign import load_campaign
from blockshake.own_files.run_workflow import WorkflowError
from blockshake.pages.blocks import (
    Box,
    Document,
    Figure,
    Heading,
    Items,
    Listing,
    Section,
    Table,
    Text,
    numbered,
)
from blockshake.pages.drawing import new_figure, svg_of
from blockshake.pages.writing import write_html, write_pdf
from blockshake.simulation.simulate import simulate
from blockshake.study.config import check_config

ROOT = PACKAGE.parents[1]
SCRIPT = "<script>alert(1)</script>"
NAMES = (
    SCRIPT, '"><img src=x onerror=alert(1)>', "{{ 7*7 }}", "$\\frac$", "#eval(1)", "--><b>", "it's", "&amp;", "]]>",
)  # fmt: skip


def _plot(name):
    figure = new_figure(0.05)
    axes = figure.add_subplot()
    axes.plot([0.0, 1.0], label=name)
    axes.set_title(name)
    axes.legend()
    return figure


def _document(name):
    """Every kind of block with a name in every place."""
    drawn = Figure(
        name,
        svg_of(_plot, name),
        moving=json.dumps({"samples": [{"label": name}]}),
    )
    facts = {field.name: name for field in dataclasses.fields(Box) if field.init}
    blocks = (
        Text(name), Items((name,)), Heading(name, "key"), Table(name, (name,), ((name,),), "l"), drawn,
        Listing(name, name),
        Box(**facts | {"facts": ((name, name, name),)}),
    )  # fmt: skip
    return numbered(Document(name, name, (Section(name, "key", blocks),), ((name, name),)))


@pytest.mark.parametrize("name", NAMES)
def test_a_page_escapes_every_name(name, tmp_path):
    write_html(tmp_path / "r.html", _document(name))
    page = (tmp_path / "r.html").read_text()
    own = re.sub(
        r"<script>.*?</script>|<style>.*?</style>", "", page, flags=re.DOTALL
    )  # the library, the page's own
    assert own.count("<script") == 1  # JSON of the figure
    assert "<script>alert" not in page.replace("<script>!function", "")
    assert "<img" not in own
    assert "<b>" not in re.sub(r"<b>[^<]*</b>", "", own)
    shown = html.unescape(re.sub(r"<[^>]*>", "", re.sub(r"<svg.*?</svg>", "", own, flags=re.DOTALL)))
    assert shown.count(name) >= 12


@pytest.mark.parametrize("name", NAMES)
def test_a_printed_page_takes_every_name(name, tmp_path):
    write_pdf(tmp_path / "r.pdf", _document(name))
    assert (tmp_path / "r.pdf").read_bytes().startswith(b"%PDF")


@pytest.mark.parametrize(
    "name", ["<script>", "$x$", "$\\frac$", "a&b", "it's", '"', "%", "{x}", "\N{PILE OF POO}"]
)
def test_a_body_of_any_name_is_drawn_and_exported(name, tmp_path):
    mapping = json.loads(
        json.dumps(GOOD).replace('"high"', json.dumps(name)).replace('"m"', json.dumps(name))
    )
    mapping["name"] = mapping["description"] = name
    time = np.linspace(0.0, 0.1, 11)
    motion = ground_motion(name, time, {"x": np.sin(12.0 * time)}, "acceleration")
    run = simulate(build_structure(mapping, "s.yaml", "."), motion, "nscd-rigid", duration=0.05)
    write_dataset(tmp_path / "r.nc", run)
    (tmp_path / "s.yaml").write_text(yaml.safe_dump(mapping))
    for command in (
        ["plot", "r.nc", "--output", "r.svg"], ["export", "r.nc", "--output", "r.csv"],
        ["export", "r.nc", "--output", "r.vtkhdf"], ["export", "r.nc", "--output", "r.glb"],
        ["animate", "r.nc", "--output", "r.gif"], ["check", "s.yaml", "--picture", "s.svg"],
    ):  # fmt: skip
        assert run_command(command, tmp_path)[0] == 0
    for picture in ("r.svg", "s.svg"):
        assert "<script" not in (tmp_path / picture).read_text()


ODD_FOLDER = "odd 'q' \"d\" $(touch pwned) `touch pwned` ; a: b #c & *"
SNAKEMAKE = [
    sys.executable,
    "-m",
    "snakemake",
    "--cores",
    "1",
    "--snakefile",
    str(ROOT / "Snakefile"),
    "--nolock",
]


@pytest.fixture
def odd(tmp_path):
    """A folder with a campaign and what a study needs, and a place to work in."""
    folder = tmp_path / ODD_FOLDER
    folder.mkdir()
    for name, content in files().items():
        (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
    (folder / "c.csv").write_text(CORRELATION)
    (tmp_path / "work").mkdir()
    return folder


def test_a_study_in_an_odd_folder_reaches_no_shell(odd, tmp_path):
    study = copy.deepcopy(STUDY)
    study["cases"][0] |= {"structure": str(odd / "structure.yaml"), "motion": str(odd / "m.csv")}
    study["cases"][0] |= {"measured": {"campaign": str(odd), "test": "t1"}, "scale": 1.0}
    study["ensemble"]["correlation"] = str(odd / "c.csv")
    (tmp_path / "study.yaml").write_text(yaml.safe_dump(study))
    command = [
        *SNAKEMAKE,
        "--directory",
        str(tmp_path / "work"),
        "--configfile",
        str(tmp_path / "study.yaml"),
    ]
    for more in (["-n"], ["--", "results/small/motions/m.nc"]):
        answer = subprocess.run([*command, *more], capture_output=True, text=True, check=False)
        assert answer.returncode == 0, answer.stdout + answer.stderr
    assert (tmp_path / "work" / "results" / "small" / "motions" / "m.nc").exists()
    assert not list(tmp_path.rglob("pwned"))


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("structure", "{wildcards.case}.yaml", "expected a path without braces"),
        ("structure", "a\nb.yaml", "expected a path without braces and control characters"),
        ("structure", "two words.yaml", "expected letters, digits"),
        ("structure", "a;b.yaml", "expected letters, digits"),
        ("motion", "it's.csv", "expected letters, digits"),
        ("motion", "elsewhere/m.csv", "expected motions of different names"),
    ],
)
def test_a_study_refuses_names_that_cannot_name_results(key, value, words):
    study = copy.deepcopy(STUDY)
    study["cases"].append(study["cases"][0] | {"name": "other"})
    study["cases"][0][key] = value
    with pytest.raises(InputError, match=words):
        check_config(study, "study.yaml")


@pytest.mark.parametrize("key", ["file", "motion", "structure"])
def test_a_campaign_refuses_braces(odd, key):
    listed = copy.deepcopy(CAMPAIGN)
    (listed if key == "structure" else listed["tests"][0])[key] = "{x}.csv"
    (odd / "campaign.yaml").write_text(yaml.safe_dump(listed))
    with pytest.raises(InputError, match="expected a path without braces"):
        load_campaign(odd)
    with pytest.raises(InputError, match="expected a path without braces"):
        load_campaign(odd.rename(odd.with_name("{x}")))


def test_a_diagnosis_is_told_the_very_folder(odd, tmp_path, monkeypatch):
    from snakemake.cli import parse_config

    given = []

    def taken(command, listener):
        given.extend(command)
        raise WorkflowError(1)

    monkeypatch.setattr(run_diagnosis, "run_workflow", taken)
    monkeypatch.setattr("blockshake.diagnosis.nominal.plan.plan_diagnosis", lambda *_: None)
    with pytest.raises(RuntimeError, match="workflow stopped"):
        run_diagnosis.diagnose(odd, tmp_path / "out", "quick", 1)
    (campaigns,) = [word for word in given if word.startswith("campaigns=")]
    assert parse_config([campaigns]) == {"campaigns": [str(odd)]}
