"""The report as a PDF by Typst, figures as vector graphics."""

import dataclasses
import json
from importlib.resources import files

import typst

from blockshake.files import replacing


def write_pdf(path, document):
    """Write a numbered `Document` as PDF: A4, pages numbered, the same bytes for the same document."""
    template = files("blockshake.pages").joinpath("templates/report.typ").read_bytes()
    content = json.dumps(dataclasses.asdict(document)).encode()
    pdf = typst.compile({"main.typ": template, "content.json": content}, ignore_system_fonts=True)
    with replacing(path) as temporary:
        temporary.write_bytes(pdf)
