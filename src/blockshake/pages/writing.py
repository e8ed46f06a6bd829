"""A document as one page of HTML that needs nothing else, and as a PDF by Typst with vector graphics."""

import dataclasses
import json
import re
from importlib.resources import files

import jinja2
import typst

from blockshake.files import replacing, write_text
from blockshake.pages.blocks import PAGE_WIDTH


def write_html(path, document):
    """Write a numbered `Document` as one self-contained HTML file: no link out of it."""
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("blockshake.pages"),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=jinja2.StrictUndefined,
    )
    template = environment.get_template("report.html.j2")
    blocks = [block for section in document.sections for block in section.blocks]
    moves = any(getattr(block, "moving", "") for block in blocks)
    write_text(path, template.render(document=document, picture=_picture, embedded=_embedded, moves=moves))


def _embedded(text):
    """JSON to stand in a script element: nothing in it ends the element."""
    return jinja2.filters.Markup(text.replace("<", "\\u003c"))


def _picture(block):
    """SVG of a figure to stand in the page: ids of its own, its caption for readers who hear it."""
    own = f"figure-{block.number}-"
    svg = re.sub(r'\bid="', f'id="{own}', block.svg)
    svg = re.sub(r'href="#', f'href="#{own}', svg)
    svg = svg.replace("url(#", f"url(#{own}")
    share = 100.0 * block.width / PAGE_WIDTH
    label = jinja2.filters.escape(f"Figure {block.number}")
    start = f'<svg role="img" aria-label="{label}" style="max-width: {share:.0f}%" '
    return jinja2.filters.Markup(svg.replace("<svg ", start, 1))


def write_pdf(path, document):
    """Write a numbered `Document` as PDF: A4, pages numbered, the same bytes for the same document."""
    template = files("blockshake.pages").joinpath("templates/report.typ").read_bytes()
    content = json.dumps(dataclasses.asdict(document)).encode()
    pdf = typst.compile({"main.typ": template, "content.json": content}, ignore_system_fonts=True)
    with replacing(path) as temporary:
        temporary.write_bytes(pdf)
