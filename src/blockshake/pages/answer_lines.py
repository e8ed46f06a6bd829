"""The answer of a report in lines for a terminal, read off its page: the words have one home."""

import html
import re
import shutil
import textwrap
from pathlib import Path

_WIDEST = 100  # columns
_PART = re.compile(r"<(p|dt|b|small|li)\b[^>]*>(.*?)</\1>", re.DOTALL)
# what precedes each part: a fact's number and note go on in the line of its label
_BEFORE = {"p": "\n", "dt": "\n  ", "b": ": ", "small": "; ", "li": "\n  "}


def answer_lines(path):
    """Frame of a report's first section, and what follows it before any drawing or table, as text in lines.

    ``path`` of the page, from `write_html`. Lines are as wide as the terminal, at most 100 columns.
    """
    page = Path(path).read_text(encoding="utf-8")
    answer = page.partition('class="box"')[2].partition("</section>")[0].partition("<figure")[0]
    text = "".join(_BEFORE[kind] + html.unescape(words) for kind, words in _PART.findall(answer))
    width = min(shutil.get_terminal_size().columns, _WIDEST)
    for line in text.strip().splitlines():
        yield from textwrap.wrap(line, width, subsequent_indent=_indent(line), break_on_hyphens=False)


def _indent(line):
    return " " * (len(line) - len(line.lstrip()) + 2)
