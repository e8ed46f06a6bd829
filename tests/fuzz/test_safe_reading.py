"""Files of users are data: no code in them runs, and no file names others outside of its folder."""

import ast
import os

import pytest
import yaml
from contract import run_command
from good_campaign import CAMPAIGN, IMPORT, files
from test_fuzz_structures import GOOD

from blockshake.errors import InputError
from blockshake.files import PACKAGE, load_yaml, named_file, parse_yaml, read_bytes
from blockshake.paths import file_below

ROOT = PACKAGE.parents[1]
SOURCES = sorted([*PACKAGE.parent.rglob("*.py"), *(ROOT / "workflow").rglob("*.py")])
# Numba's kernels, compiled here, in a folder of the user's own, each sealed by its digest
OWN_PICKLES = {PACKAGE / "jit.py"}
UNSAFE_MODULES = {
    "pickle",
    "cPickle",
    "dill",
    "cloudpickle",
    "joblib",
    "shelve",
    "marshal",
    "jsonpickle",
    "code",
    "pty",
}
UNSAFE_CALLS = {
    "eval",
    "exec",
    "compile",
    "__import__",
}  # of Python itself, not of a module that has such a word
UNSAFE_METHODS = {"system", "popen", "read_pickle", "to_pickle", "unsafe_load", "full_load"}


def calls(tree):
    """Calls of a tree, with the last part of the name of what is called."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            yield getattr(node.func, "attr", getattr(node.func, "id", "")), node


def keywords(call):
    return {keyword.arg: keyword.value for keyword in call.keywords}


@pytest.fixture(scope="module")
def trees():
    return {path: ast.parse(path.read_text(encoding="utf-8")) for path in SOURCES}


def test_nothing_that_can_run_code_is_read(trees):
    for path, tree in trees.items():
        if path in OWN_PICKLES:
            continue
        for node in ast.walk(tree):
            if isinstance(node, ast.Import):
                assert not UNSAFE_MODULES & {alias.name.split(".")[0] for alias in node.names}, path
            if isinstance(node, ast.ImportFrom):
                assert (node.module or "").split(".")[0] not in UNSAFE_MODULES, path
        for name, call in calls(tree):
            unsafe = UNSAFE_CALLS if isinstance(call.func, ast.Name) else UNSAFE_METHODS
            assert name not in unsafe, f"{path}:{call.lineno}"
            assert "allow_pickle" not in keywords(call), f"{path}:{call.lineno}"
            shell = keywords(call).get("shell", ast.Constant(False))
            assert isinstance(shell, ast.Constant), f"{path}:{call.lineno}"
            assert shell.value is False, f"{path}:{call.lineno}"


def test_yaml_is_loaded_by_the_strict_loader_alone(trees):
    loads = [
        (path, ast.unparse(call)) for path, tree in trees.items() for name, call in calls(tree)
        if name in ("load", "load_all") and ast.unparse(call.func).startswith("yaml.")
    ]  # fmt: skip
    assert loads == [(PACKAGE / "files.py", "yaml.load(text, Loader=_StrictLoader)")]
    (loader,) = [
        node for node in ast.walk(trees[PACKAGE / "files.py"])
        if isinstance(node, ast.ClassDef) and node.name == "_StrictLoader"
    ]  # fmt: skip
    assert [ast.unparse(base) for base in loader.bases] == ["yaml.CSafeLoader"]


def _bomb(first, form):
    """Few lines of aliases of aliases, which grow nine times with each."""
    lines = [f"a0: &a0 {first}"]
    lines += [f"a{n}: &a{n} {form.format(', '.join([f'*a{n - 1}'] * 9))}" for n in range(1, 12)]
    return "\n".join(lines)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("a: !!python/object/apply:os.system ['touch pwned']", "could not determine a constructor"),
        ("a: !!python/name:os.system", "could not determine a constructor"),
        ("a: &a [*a]", "holds itself"),
        ("[" * 100_000, "deeper than"),
        (_bomb("[1, 1]", "[{}]"), "values"),
        (_bomb("{x: 1}", "{{<<: [{}]}}"), "values"),
        ("a: !!bool x", "expected YAML"),
        ("a: !!timestamp x", "expected YAML"),
        (f"a: {'9' * 5000}", "expected YAML"),
    ],
)  # fmt: skip
def test_yaml_that_runs_grows_or_breaks_is_refused(text, words):
    with pytest.raises(InputError, match=words):
        parse_yaml(text, "f.yaml")


def test_aliases_and_merges_are_read():
    assert parse_yaml("a: &a {x: 1}\nb: {<<: *a, y: 2}\nc: *a", "f") == {
        "a": {"x": 1},
        "b": {"x": 1, "y": 2},
        "c": {"x": 1},
    }


def test_what_is_no_file_is_refused(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path, tmp_path / "pipe", "/dev/zero", "a\0b", "x" * 300, tmp_path / "none"):
        with pytest.raises(InputError, match="expected"):
            read_bytes(path)
    for name in ("a\0b", "x" * 300, "../configuration-1", "../../pyproject"):
        with pytest.raises(InputError):
            load_yaml(named_file("structures", name))


def test_a_control_character_of_a_name_is_shown_as_an_escape():
    error = InputError("a\nb.yaml", "x\x1b[2J", f"expected one, not '{'y' * 5000}'")
    assert str(error).startswith("a\\nb.yaml: x\\x1b[2J: expected one, not 'yyy")
    assert str(error).endswith("yyy ...")
    assert len(str(error)) == 1000


@pytest.fixture
def folder(tmp_path):
    """A folder next to a secret, with links to it and to itself."""
    (tmp_path / "secret.txt").write_text("secret")
    folder = tmp_path / "received"
    folder.mkdir()
    (folder / "link").symlink_to("../secret.txt")
    (folder / "above").symlink_to("..")
    (folder / "loop").symlink_to("loop")
    (folder / "inside").symlink_to("file")
    (folder / "file").write_text("")
    return folder


@pytest.mark.parametrize("name", ["file", "inside", "none", "sub/../file", "./file"])
def test_a_file_below_is_found(folder, name):
    assert file_below(folder, name, "f", "k") == folder / name


@pytest.mark.parametrize(
    "name",
    ["..", "../secret.txt", "sub/../../secret.txt", "/etc/passwd", "link", "above/secret.txt", "loop", "a\0"],
)
def test_a_file_elsewhere_is_not(folder, name):
    with pytest.raises(InputError, match="f: k: expected the path of a file below"):
        file_below(folder, name, "f", "k")


ELSEWHERE = ("../secret.txt", "/etc/passwd", "link")


@pytest.mark.parametrize("name", ELSEWHERE)
@pytest.mark.parametrize("key", ["structure", "file", "motion", "accelerometers"])
def test_a_campaign_names_only_files_below_it(folder, key, name):
    listed = yaml.safe_load(yaml.safe_dump(CAMPAIGN))
    if key == "structure":
        listed["structure"] = name
    elif key != "accelerometers":
        listed["tests"][0][key] = name
    for file, content in files(**{"campaign.yaml": yaml.safe_dump(listed)}).items():
        (folder / file).write_bytes(content if isinstance(content, bytes) else content.encode())
    if key == "accelerometers":
        (folder / "t1-acc.csv").unlink()
        (folder / "t1-acc.csv").symlink_to("../secret.txt")
    code, _, complained = run_command(
        ["check", folder], folder, [folder.parent / "secret.txt", "/etc/passwd"]
    )
    assert code == 2
    assert "expected the path of a file below" in complained


@pytest.mark.parametrize("name", ELSEWHERE)
@pytest.mark.parametrize("key", ["structure", "file", "motion", "accelerometers"])
def test_a_map_names_only_files_below_it(folder, key, name):
    asked = yaml.safe_load(yaml.safe_dump(IMPORT))
    (asked if key == "structure" else asked["tests"][0])[key] = name
    for file, content in files(**{"map.yaml": yaml.safe_dump(asked)}).items():
        (folder / file).write_bytes(content if isinstance(content, bytes) else content.encode())
    code, _, complained = run_command(
        ["import-campaign", folder / "map.yaml", "--output", folder / "o"],
        folder,
        [folder.parent / "secret.txt", "/etc/passwd"],
    )
    assert code == 2
    assert "expected the path of a file below" in complained


@pytest.mark.parametrize("name", ["../secret.stl", "/etc/passwd", "link", "file", "file.zip", "file.glb"])
def test_a_structure_names_only_meshes_below_it(folder, name):
    mapping = GOOD | {"shapes": GOOD["shapes"] | {"block": {"mesh": name}}}
    (folder / "s.yaml").write_text(yaml.safe_dump(mapping))
    code, _, complained = run_command(
        ["check", folder / "s.yaml"], folder, [folder.parent / "secret.txt", "/etc/passwd"]
    )
    assert code == 2
    assert "shapes.block.mesh" in complained


def test_an_object_file_names_no_further_files(folder):
    """A Wavefront file may name a library of materials, which names pictures."""
    (folder / "b.obj").write_text("mtllib ../secret.txt\nv 0 0 0\n")
    mapping = GOOD | {"shapes": GOOD["shapes"] | {"block": {"mesh": "b.obj"}}}
    (folder / "s.yaml").write_text(yaml.safe_dump(mapping))
    assert run_command(["check", folder / "s.yaml"], folder, [folder.parent / "secret.txt"])[0] == 2
