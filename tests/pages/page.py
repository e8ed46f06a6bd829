"""A report's page as its reader sees it."""

from html.parser import HTMLParser

VOID = {"meta", "link", "br", "img", "hr", "input"}
CLAIMS = ("validated", "good agreement", "excellent", "accurate", "remarkable")


class Page(HTMLParser):
    """Checks that tags close in order and gathers ids, references and the text."""

    def __init__(self):
        super().__init__()
        self.open, self.ids, self.references, self.tags, self.words = [], [], [], [], []

    def handle_starttag(self, tag, attributes):
        self.tags.append(tag)
        for name, value in attributes:
            if name == "id":
                self.ids.append(value)
            if name in ("href", "src", "xlink:href", "srcset", "action", "data"):
                self.references.append(value)
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        self.handle_starttag(tag, attributes)
        if tag not in VOID:
            self.open.pop()

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if not {"style", "svg", "script"} & set(self.open):
            self.words.append(data)


def texts(section):
    """All sentences of a section but those in tables and listings."""
    for block in section.blocks:
        if block.kind == "text":
            yield block.text
        if block.kind == "items":
            yield from block.items
