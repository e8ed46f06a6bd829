"""A report's page as a browser shows it: nothing fetched, nothing complained of, everything can be saved."""

import base64
import json
import re

import numpy as np
import pytest
from browser import CHROMIUM, page_of_browser

from blockshake.pages.blocks import Document, Figure, Section, Table, Text, numbered
from blockshake.pages.writing import write_html

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="chromium is not installed")
# the drawing of a canvas sets its width
DRAWN = """new Promise((done) => {
  const look = () => (document.querySelector("canvas[width]") ? done() : setTimeout(look, 10));
  look();
})"""
COMPLAINTS = ("Runtime.consoleAPICalled", "Runtime.exceptionThrown", "Log.entryAdded")


@pytest.fixture(scope="module")
def shown(tmp_path_factory):
    """A page as the browser has made it, and the complaints on its console."""
    folder = tmp_path_factory.mktemp("page")
    drawing = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 90 10"><path d="M0 0 L90 10"/></svg>'
    blocks = (
        Text("A <b>name</b> & a sentence."),
        Table("Names.", ("Name", "Value [1]"), (('a "block", 1', "3"),), "lr"),
        Figure("A line.", drawing),
    )
    zeros = {"unit": 0.1, "data": base64.b64encode(np.zeros((2, 1, 3), "<i2").tobytes()).decode()}
    arms = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    moving = {
        "step": 0.04, "frames": 2, "magnification": 5,
        "bodies": [{"place": [0, 0, 1], "arms": arms, "faces": faces, "color": [0.8, 0.8, 0.8]}],
        "samples": [{"label": "sample </script>", "shift": zeros, "turn": zeros}],
        "measured": {"label": "measured", "bodies": [0], "arms": [[0.3, 0, 0.3]], "shift": zeros},
    }  # fmt: skip
    blocks += (Figure("Blocks.", drawing, moving=json.dumps(moving)),)
    document = Document("Title", "What it is", (Section("First", "first", blocks),))
    write_html(folder / "page.html", numbered(document))
    with page_of_browser(folder / "profile") as page:
        page.open((folder / "page.html").as_uri())
        page.evaluate(DRAWN)
        text = page.evaluate("document.documentElement.outerHTML")
        return text, [event for event in page.events if event["method"] in COMPLAINTS]


def test_nothing_is_complained_of(shown):
    assert shown[1] == []


def test_every_table_and_every_figure_can_be_saved(shown):
    buttons = re.findall(r'<button type="button" title="([^"]*)">([^<]*)</button>', shown[0])
    figures = [(f"Save figure-{number}", "SVG") for number in (1, 2)]
    assert buttons == [("Save table-1", "CSV"), *figures]


def test_blocks_that_move_are_drawn_with_their_controls(shown):
    assert shown[0].count('<figure class="drawn">') == 1
    form = re.search(r'<form class="controls">.*?</form><canvas[^>]*>', shown[0], re.DOTALL)[0]
    assert '<option value="0">sample &lt;/script&gt;</option>' in form
    assert '<button type="button" name="play">Play</button>' in form
    assert "0.00 s" in form
    assert "\N{MULTIPLICATION SIGN} 5" in form
    assert int(re.search(r'<canvas[^>]* width="(\d+)"', form)[1]) > 100  # set when it is drawn


def test_names_are_text(shown):
    assert "A &lt;b&gt;name&lt;/b&gt; &amp; a sentence." in shown[0]
