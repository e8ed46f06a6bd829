"""Names that mean something to a page, a formula, a shell or a workflow are but names."""

import dataclasses
import html
import json
import re

import numpy as np
import pytest
import yaml
from contract import run_command
from test_fuzz_structures import GOOD

from blockshake.dynamics.motion import ground_motion
from blockshake.files import PACKAGE, write_dataset
from blockshake.geometry.structure import build_structure
from blockshake.report.document.blocks import (
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
from blockshake.report.document.box import Box
from blockshake.report.document.drawing import new_figure, svg_of
from blockshake.report.document.html import write_html
from blockshake.report.document.pdf import write_pdf
from blockshake.simulation.simulate import simulate

ROOT = PACKAGE.parents[1]
SCRIPT = "<script>alert(1)</script>"
NAMES = (
    SCRIPT,
    '"><img src=x onerror=alert(1)>',
    "{{ 7*7 }}",
    "$\\frac$",
    "#eval(1)",
    "--><b>",
    "it's",
    "&amp;",
    "]]>",
)


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
        interactive=json.dumps({"data": [{"y": [1, 2], "name": name}], "layout": {}}),
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
    page = page.replace(re.search(r"<script>.{100000,}?</script>", page, flags=re.DOTALL)[0], "")  # plotly
    assert "<script>alert" not in page
    assert "<img" not in page
    assert page.count("<script") == page.count("</script") == 2  # the figure's JSON and the page's own
    assert html.escape(name, quote=False).replace("&#x27;", "'") in html.unescape(page).replace(
        name, html.escape(name, quote=False)
    )
    assert "49" not in re.sub(r"<svg.*?</svg>|<style.*?</style>", "", page, flags=re.DOTALL) or "7*7" in page


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
