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


def _picture(block, left=False):
    """SVG of a figure to stand in the page, or that to its left: ids of its own, a name for readers who hear it."""
    drawing, own = (block.left, "left-") if left else (block, "")
    own = f"figure-{block.number}-{own}"
    svg = re.sub(r'\bid="', f'id="{own}', drawing.svg)
    svg = re.sub(r'href="#', f'href="#{own}', svg)
    svg = svg.replace("url(#", f"url(#{own}")
    millimetres, style = 1e3 * drawing.width, f"max-width: {100.0 * drawing.width / PAGE_WIDTH:.0f}%"
    if block.left:  # shares of a row that they leave where both are no more legible
        style = f"flex: {millimetres:.0f} 1 {3 * millimetres:.0f}px; max-width: min(100%, {6 * millimetres:.0f}px)"
    label = jinja2.filters.escape(f"Figure {block.number}")
    start = f'<svg role="img" aria-label="{label}" style="{style}" '
    return jinja2.filters.Markup(svg.replace("<svg ", start, 1))


def write_pdf(path, document):
    """Write a numbered `Document` as PDF: A4, pages numbered, the same bytes for the same document."""
    template = files("blockshake.pages").joinpath("templates/report.typ").read_bytes()
    content = json.dumps(dataclasses.asdict(document)).encode()
    pdf = typst.compile({"main.typ": template, "content.json": content}, ignore_system_fonts=True)
    with replacing(path) as temporary:
        temporary.write_bytes(pdf)
