"""The project is whole in itself: pages, paths and names that it mentions exist, and its pages are plain to read."""

import ast
import pkgutil
import re
from pathlib import Path

import pytest

from blockshake.files import PACKAGE

ROOT = PACKAGE.parents[1]
PAGES = sorted(
    [ROOT / "README.md", *ROOT.glob("docs/**/*.md"), *ROOT.glob("*/README.md"), *ROOT.glob("src/*/README.md")]
)
TEXTS = (".py", ".smk", ".md", ".yaml", ".yml", ".toml", ".j2", ".typ", ".json", ".lock", "")
FOLDERS = ("src", "tests", "docs", "bench", "hidden_effects", "workflow", "config", "data", "profiles", ".ci")
WIDTH = 100
MOST_UNFORMATTED = 187  # lines and statements of `src` that keep a layout of their own; formulas need one
MOST_LINES_OF_COMMON = 159
# names of pages, folders and hosts outside of the project; written so that this file does not hold them
OUTSIDE = re.compile(
    r"design[.]md|facts[.]md|design[ ]contract|(?<![\w.])/work[/]|design[ ]section|the[ ]issue(?:'s| asks)"
    r"|(?:files[.])?pythonhosted[.]org|pypi[.]org/simple",
    re.IGNORECASE,
)


def source_files():
    """Text files that belong to the project."""
    for path in sorted([*ROOT.iterdir(), *(path for name in FOLDERS for path in (ROOT / name).rglob("*"))]):
        if (
            path.is_file()
            and path.suffix in TEXTS
            and "__pycache__" not in path.parts
            and path.name != ".git"
        ):
            yield path


def prose(page):
    """Lines of a page with their numbers, without tables, headings and code."""
    fenced = False
    for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), start=1):
        if line.startswith("```"):
            fenced = not fenced
        elif not fenced and not line.startswith(("|", "#", "    ", "<!--")):
            yield number, line


def sentences(text):
    """Sentences of a text; the dot of an abbreviation or a number does not end one."""
    return re.split(r"(?<=[.:?!])[*`)\"]*\s+(?=[*`(\"]*[A-Z])", text)


def code_spans(page):
    """Words in code spans outside of fenced code, tables included."""
    text = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL)
    return re.findall(r"`([^`\n]+)`", text)


def by_name(pages):
    """Parameters that show a page by its path in the project."""
    return pytest.mark.parametrize("page", pages, ids=lambda page: str(page.relative_to(ROOT)))


def test_nothing_points_outside_the_project():
    for path in source_files():
        found = OUTSIDE.findall(path.read_text(encoding="utf-8"))
        assert found == [], path.relative_to(ROOT)


@by_name(PAGES)
def test_every_link_of_a_page_leads_somewhere(page):
    text = page.read_text(encoding="utf-8")
    for target in re.findall(r"\]\(([^)#\s]+)[^)]*\)", text):
        if not target.startswith("http"):
            assert (page.parent / target).exists(), target


def test_every_page_is_linked_from_another():
    linked = {
        (page.parent / target).resolve()
        for page in PAGES
        for target in re.findall(r"\]\(([^)#\s]+)", page.read_text(encoding="utf-8"))
        if not target.startswith("http") and (page.parent / target).resolve() != page
    }
    for page in ROOT.glob("docs/**/*.md"):
        assert page.resolve() in linked, page.relative_to(ROOT)


PATH = re.compile(r"[\w.-]+(?:/[\w.-]+)*/?")
MADE = ("results", "reports", "logs", "~", ".venv", ".venv-peers", ".snakemake")


def is_path(word):
    """Whether a code span is a path of a file or folder that the project holds."""
    if not PATH.fullmatch(word) or word.split("/")[0] in MADE or not word.isascii():
        return False
    head = word.split("/")[0]
    rooms = {path.name for base in (ROOT, PACKAGE) for path in base.iterdir()}
    return ("/" in word and head in rooms) or word.endswith((".py", ".smk"))


def exists(word, page):
    """Whether a path is there: from the root, the package or the page, or a file's name anywhere."""
    bases = (ROOT, ROOT / "src", PACKAGE, page.parent, ROOT / "hidden_effects", ROOT / "bench")
    if any((base / word).exists() for base in bases):
        return True
    return "/" not in word and any(
        next((ROOT / room).rglob(word), None) for room in ("src", "tests", "workflow")
    )


@by_name(PAGES)
def test_every_path_of_a_page_exists(page):
    words = [word.split(":")[0].strip() for span in code_spans(page) for word in span.split(", ")]
    missing = [word for word in words if is_path(word) and not exists(word, page)]
    # an example of a file that the reader is to write
    assert [word for word in missing if not Path(word).name.startswith("my_")] == []


@by_name(PAGES)
def test_every_name_of_a_page_can_be_imported(page):
    missing = []
    for name in re.findall(r"\bblockshake(?:\.[a-zA-Z_]\w*)+", page.read_text(encoding="utf-8")):
        try:
            pkgutil.resolve_name(name)
        except (ImportError, AttributeError):
            missing.append(name)
    assert missing == []


@pytest.mark.parametrize("folder", ["bench", "examples", "hidden_effects", "workflow"])
def test_every_name_that_a_program_imports_is_there(folder):
    for path in sorted((ROOT / folder).rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("blockshake"):
                for name in node.names:
                    pkgutil.resolve_name(f"{node.module}.{name.name}")


@by_name(PAGES)
def test_lines_of_a_page_fit_a_screen(page):
    long = [number for number, line in prose(page) if len(line) > WIDTH]
    assert long == []


def starts_with_what(text):
    """Sentences that start with a pronoun for their noun."""
    return [
        words
        for words in sentences(text)
        if re.match(r"[*`(\"]*What\b(?! (is|are|do|does|did|can)\b.*\?)", words)
    ]


@by_name(PAGES)
def test_no_sentence_of_a_page_starts_with_what(page):
    text = re.sub(r"^[-*] ", "", "\n".join(line for _, line in prose(page)), flags=re.MULTILINE)
    assert [words for block in text.split("\n\n") for words in starts_with_what(block.strip())] == []


@pytest.mark.parametrize("folder", ["bench", "hidden_effects", "src", "tests"])
def test_no_docstring_starts_with_what(folder):
    found = []
    for path in sorted((ROOT / folder).rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef)) and (
                text := ast.get_docstring(node)
            ):
                found += [f"{path.relative_to(ROOT)}: {words}" for words in starts_with_what(text)]
    assert found == []


NOT_YET = ("diagnosis", "forces", "parity")  # rooms whose digests a record rests on


def test_no_sentence_of_a_docstring_starts_with_of():
    """Descriptions begin with their noun: of what is left open is read twice."""
    found = []
    for path, tree in parsed_modules():
        if path.relative_to(PACKAGE.parent).parts[1] in NOT_YET:
            continue
        for node in ast.walk(tree):
            if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef)):
                text = ast.get_docstring(node) or ""
                blocks = re.findall(r"(?:\A|\n\n|\n(?:\w.* : .*|-+)\n)\s*((?:Of|Those of) .*)", text)
                found += [f"{path.name}: {words}" for words in blocks]
    assert found == []


def test_every_module_of_tests_has_a_name_of_its_own():
    """Pytest imports them by their names alone."""
    names = [path.name for path in (ROOT / "tests").rglob("test_*.py")]
    assert sorted(names) == sorted(set(names))


def names_twice(entries):
    """Names that stand in more than one file, each with its files."""
    homes = {}
    for name, path in entries:
        homes.setdefault(name, set()).add(str(path.relative_to(PACKAGE.parent)))
    return {name: sorted(files) for name, files in homes.items() if len(files) > 1}


def parsed_modules():
    """Modules of both packages, with their syntax trees."""
    for path in sorted(PACKAGE.parent.rglob("*.py")):
        yield path, ast.parse(path.read_text(encoding="utf-8"))


def test_no_class_name_stands_twice():
    classes = [
        (node.name, path)
        for path, tree in parsed_modules()
        for node in ast.walk(tree)
        if isinstance(node, ast.ClassDef) and not node.name.startswith("_")
    ]
    assert names_twice(classes) == {}


def private_constants(tree):
    """Names and values of a module's private constants, those of `A, B = 1, 2` too."""
    for node in tree.body:
        if not isinstance(node, ast.Assign):
            continue
        for target in node.targets:
            both = isinstance(target, ast.Tuple) and isinstance(node.value, ast.Tuple)
            pairs = zip(target.elts, node.value.elts, strict=True) if both else [(target, node.value)]
            for name, value in pairs:
                if isinstance(name, ast.Name) and re.fullmatch(r"_[A-Z][A-Z0-9_]*", name.id):
                    yield name.id, ast.dump(value)


def test_no_private_constant_stands_twice():
    """For one name and one value it is one fact, and has one home; or it is two, and they have two names."""
    constants = [(entry, path) for path, tree in parsed_modules() for entry in private_constants(tree)]
    twice = {name: files for (name, _), files in names_twice(constants).items()}
    assert twice == {}


def test_layouts_of_their_own_and_the_common_rules_do_not_grow():
    unformatted = sum(path.read_text(encoding="utf-8").count("# fmt: skip") for path, _ in parsed_modules())
    assert unformatted <= MOST_UNFORMATTED
    common = ROOT / "workflow" / "rules" / "common.smk"
    assert len(common.read_text(encoding="utf-8").splitlines()) <= MOST_LINES_OF_COMMON


# words of this house that are no terms of the field: in names, in code or pages' macros, none of them stands
RETIRED = {"told", "asked", "beside", "likeliest", "loudest", "heard", "speaks", "says", "sound", "rung"}


def test_no_retired_word_stands_in_a_name():
    found = {
        (str(path.relative_to(ROOT)), name)
        for path, tree in parsed_modules()
        for node in ast.walk(tree)
        for name in names_of(node)
        if RETIRED & set(re.sub(r"(?<=[a-z])(?=[A-Z])", "_", name).lower().split("_"))
    }
    assert found == set()


def names_of(node):
    """Names that a node of a syntax tree gives or uses."""
    return [
        name
        for field in ("id", "attr", "arg", "name", "asname")
        if isinstance(name := getattr(node, field, None), str)
    ]
