import json
import os
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from numba.core.caching import IndexDataCacheFile

from blockshake import files, jit
from blockshake.errors import InputError
from blockshake.files import (
    content_digest,
    load_made_json,
    load_yaml,
    parse_yaml,
    replacing,
    write_dataset,
    write_json,
    write_text,
)


def test_an_input_error_is_one_line_that_names_file_key_and_expectation():
    assert str(InputError("a.yaml", "bodies.b", "expected one")) == "a.yaml: bodies.b: expected one"
    assert str(InputError("a.yaml", "", "expected a file")) == "a.yaml: expected a file"


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1e-5", 1e-5),
        ("3.45e10", 3.45e10),
        ("1.0e-5", 1e-5),
        ("-2E3", -2000.0),
        (".5", 0.5),
        ("+1.e+2", 100.0),
    ],
)
def test_every_spelling_of_a_number_is_a_number(text, value):
    """YAML 1.1, and so plain PyYAML, reads 1e-5 as text; YAML 1.2 (section 10.3.2) reads a number."""
    read = parse_yaml(f"key: {text}", "t")["key"]
    assert isinstance(read, float)
    assert read == value


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("12", 12),
        ("-0", 0),
        ("configuration-1", "configuration-1"),
        ("true", True),
        ("1e-5 m", "1e-5 m"),
        *((text, text) for text in ("02400", "-010", "02400.5", "1:30", "1:30.5", "0x10", "0b11", "0o17")),
        *((text, text) for text in ("1_000", "1_0.5", "2026-01-31", "2026-01-31 10:00:00")),
    ],
)
def test_other_values_keep_their_type(text, value):
    read = parse_yaml(f"key: {text}", "t")["key"]
    assert read == value
    assert type(read) is type(value)


@pytest.mark.parametrize(
    ("text", "key", "line"),
    [
        ("a: 1\nb: 2\na: 3\n", "a", 3),
        ("a: 1\r\nb: 2\r\n\r\na: 3\r\n", "a", 4),
        ("outer:\n  a: 1\n  # remark\n  b: {c: 1}\n  a: 1\n", "a", 5),
        ("list:\n  - a: 1\n    b: 2\n    a: 3\n", "a", 4),
        ("{a: 1,\n b: 2, a: 3}", "a", 2),
        ("a: 1\n'a': 2\n", "a", 2),
        ("1: 1\nx: 1\n1.0: 2\n", "1.0", 3),
        ("a: &a {x: 1}\nb:\n  <<: *a\n  <<: *a\n", "<<", 4),
    ],
)
def test_a_key_stated_twice_is_an_error_that_names_the_line_of_the_second(text, key, line, tmp_path):
    (tmp_path / "f.yaml").write_bytes(text.encode())
    with pytest.raises(InputError) as error:
        load_yaml(tmp_path / "f.yaml")
    assert f"expected YAML; the key '{key}' stands twice in line {line}, column" in str(error.value)
    assert str(error.value).isprintable()


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (None, "expected a readable file; no such file or directory"),
        (b"\xff\xfe\x00", "expected a text file; its bytes are not UTF-8"),
        (b"- 1\n- 2\n", "expected a mapping of keys to values at the top of the file"),
        (b"a: [1, 2\n", "expected YAML; "),
    ],
)
def test_an_unreadable_file_is_one_line(tmp_path, content, message):
    path = tmp_path / "s.yaml"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(InputError) as error:
        load_yaml(path)
    assert str(error.value).startswith(f"{path}: {message}")
    assert "\n" not in str(error.value)


def test_replacing_puts_the_whole_new_file_or_keeps_the_old(tmp_path):
    path = tmp_path / "folder" / "a.txt"
    write_text(path, "old")

    def write_half():
        with replacing(path) as temporary:
            temporary.write_text("half of the n")
            raise RuntimeError("killed")

    with pytest.raises(RuntimeError, match="killed"):
        write_half()
    assert path.read_text() == "old"
    assert [item.name for item in path.parent.iterdir()] == ["a.txt"]
    write_text(path, "new")
    assert path.read_text() == "new"
    assert [item.name for item in path.parent.iterdir()] == ["a.txt"]


def test_a_new_file_has_the_rights_of_an_ordinary_one(tmp_path):
    (tmp_path / "plain").write_text("")
    write_text(tmp_path / "atomic", "")
    assert (tmp_path / "atomic").stat().st_mode == (tmp_path / "plain").stat().st_mode


def test_json_keeps_every_digit(tmp_path):
    write_json(tmp_path / "a.json", {"b": 0.1 + 0.2, "a": 1})
    assert (tmp_path / "a.json").read_text() == '{\n  "b": 0.30000000000000004,\n  "a": 1\n}\n'


def test_a_dataset_returns_as_it_was_written(tmp_path):
    values = np.linspace(0.0, 1.0, 100) ** 3
    values[-1] = np.nan
    dataset = xr.Dataset({"v": ("time", values, {"units": "m"})}, attrs={"model": "ls-dem"})
    write_dataset(tmp_path / "a.nc", dataset)
    with xr.open_dataset(tmp_path / "a.nc") as read:
        xr.testing.assert_identical(read.load(), dataset)


def test_the_content_digest_tells_values_apart_and_not_the_order_of_keys():
    assert content_digest({"a": 1, "b": 2.5}) == content_digest({"b": 2.5, "a": 1})
    different = {content_digest(v) for v in ({"a": 1}, {"a": 2}, {"a": "1"}, [1], b"[1]x")}
    assert len(different) == 5
    assert content_digest("ab", "c") != content_digest("a", "bc")
    assert len(content_digest(1)) == 12


_ASK = """
import numpy as np
from blockshake.dynamics.free_motion import drift_into
from blockshake.jit import kernel
position, orientation, spin = np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0]), np.zeros(3)
drift = kernel(drift_into)
drift(np.eye(3), spin, np.array([0.0, 0.0, np.pi]), spin.copy(), 1.0, position, orientation)
print(orientation[3], sum(drift.stats.cache_hits.values()))
"""


def _half_turn(root, cache):
    environment = {**os.environ, "PYTHONPATH": str(root), "BLOCKSHAKE_CACHE": str(cache)}
    done = subprocess.run(
        [sys.executable, "-c", _ASK], env=environment, cwd=root, capture_output=True, text=True, check=True
    )
    value, hits = done.stdout.split()
    return float(value), int(hits)


def test_an_edit_in_an_imported_module_changes_what_a_cached_kernel_computes(tmp_path):
    """Numba issue 1833: its cache alone keeps the old physics of an imported kernel."""
    root, cache = tmp_path / "src", tmp_path / "cache"
    shutil.copytree(
        Path(files.__file__).parent, root / "blockshake", ignore=shutil.ignore_patterns("__pycache__")
    )
    assert _half_turn(root, cache) == (1.0, 0)
    assert _half_turn(root, cache) == (1.0, 1)
    copied = tmp_path / "copy"
    shutil.copytree(root, copied)
    # a copy of the same sources compiles nothing, wherever it is
    assert _half_turn(copied, cache) == (1.0, 1)
    with (root / "blockshake" / "solvers" / "nscd" / "step.py").open("a") as step:
        step.write("\n_MORE = 1\n")
    # an edit of what the kernel does not import compiles it not again
    assert _half_turn(root, cache) == (1.0, 1)
    rotations = root / "blockshake" / "geometry" / "rotations.py"
    text = rotations.read_text()
    edited = text.replace("np.sin(0.5 * angle) / angle", "-np.sin(0.5 * angle) / angle", 1)
    assert edited != text
    rotations.write_text(edited)
    # now every rotation goes the other way
    assert _half_turn(root, cache) == (-1.0, 0)


def test_packed_variables_keep_their_digits_and_their_gaps(tmp_path):
    values = np.random.default_rng(0).normal(0.0, 0.1, (100, 3))
    values[3, 1] = np.nan
    dataset = xr.Dataset(
        {"u": (("t", "a"), values, {"units": "m"}), "n": (("t", "a"), values, {"units": "1"})}
    )
    write_dataset(tmp_path / "a.nc", dataset, decimals={"m": 5})
    read = xr.load_dataset(tmp_path / "a.nc")
    # half of the last digit kept
    np.testing.assert_allclose(read["u"], values, atol=0.5e-5 * (1.0 + 1e-9))
    np.testing.assert_array_equal(read["n"], values)
    # read and written again, nothing moves
    write_dataset(tmp_path / "b.nc", read, decimals={"m": 5})
    assert (tmp_path / "b.nc").read_bytes() == (tmp_path / "a.nc").read_bytes()


@pytest.mark.parametrize("far", [214.7483648, 240.0, -1e6, np.inf])
def test_a_value_beyond_packed_numbers_is_kept_as_it_is(tmp_path, far):
    """A whole number of four bytes ends at 214.7 m in tenths of a micrometre; a block falls as far in 6.6 s."""
    values = np.linspace(0.0, 1.0, 100)
    values[7], values[8] = far, np.nan
    write_dataset(tmp_path / "a.nc", xr.Dataset({"u": ("t", values, {"units": "m"})}), decimals={"m": 7})
    np.testing.assert_array_equal(xr.load_dataset(tmp_path / "a.nc")["u"], values)


def test_content_that_was_read_gives_the_bytes_of_content_that_was_made(tmp_path):
    """A library of which some runs came from the store is the file of one that was simulated in one go."""
    parts = [
        xr.Dataset(
            {"value": (("run", "feature"), np.full((1, 80), float(number)))},
            coords={"unit": ("feature", ["mm"] * 80), "status": ("run", [status])},
        )
        for number, status in enumerate(("done", "collapsed"))
    ]
    write_dataset(tmp_path / "kept.nc", parts[0])
    for name, first in (("made.nc", parts[0]), ("resumed.nc", xr.load_dataset(tmp_path / "kept.nc"))):
        write_dataset(tmp_path / name, xr.concat([first, parts[1]], dim="run", data_vars="all"))
    assert (tmp_path / "resumed.nc").read_bytes() == (tmp_path / "made.nc").read_bytes()


def _cache(folder, stamp="stamp"):
    return IndexDataCacheFile(str(folder), "kernel", stamp)


def test_kernels_that_are_saved_at_the_same_time_do_not_take_each_other_s_place(tmp_path):
    signatures = [f"signature {number}" for number in range(8)] * 4
    with ThreadPoolExecutor(8) as pool:
        list(pool.map(lambda one: _cache(tmp_path).save(one, f"code of {one}"), signatures))
    assert [_cache(tmp_path).load(one) for one in signatures] == [f"code of {one}" for one in signatures]


def test_a_damaged_or_foreign_kernel_is_compiled_anew(tmp_path):
    cache = _cache(tmp_path)
    cache.save("signature", "code")
    cache.save("another", "other code")
    kernel, other = (Path(jit._place(cache, key)) for key in ("signature", "another"))
    whole = kernel.read_bytes()
    flipped = bytearray(whole)
    flipped[-3] ^= 1
    for damaged in (b"", whole[:10], whole[:-1], bytes(flipped), other.read_bytes(), b"a note"):
        kernel.write_bytes(damaged)
        assert cache.load("signature") is None
    cache.save("signature", "code")
    assert cache.load("signature") == "code"
    # other sources
    assert _cache(tmp_path, "edited").load("signature") is None


@pytest.mark.parametrize("value", [{}, {"x": [1]}, {"x": 10**400}, {"x": "one"}])
def test_json_of_an_earlier_job_that_is_something_else_is_refused(tmp_path, value):
    (tmp_path / "a.json").write_text(json.dumps(value))
    with pytest.raises(InputError, match=r"a\.json"):
        load_made_json(tmp_path / "a.json", lambda read: float(read["x"]))
