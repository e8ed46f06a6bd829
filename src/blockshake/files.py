"""Reading and writing files: strict YAML, atomic writes, digests of contents."""

import contextlib
import errno
import hashlib
import json
import os
import re
import shutil
import tempfile
from datetime import datetime
from pathlib import Path

import yaml

from blockshake import __version__
from blockshake.errors import InputError
from blockshake.interrupts import delayed_interrupts

AnyPath = str | os.PathLike[str]
PACKAGE = Path(__file__).parent
_INSTALLED = PACKAGE / "shipped"
# what ships next to the package: a checkout's own folders, or the copy of them in an installed package
HOME = _INSTALLED if _INSTALLED.is_dir() else PACKAGE.parents[1]
MADE_ANEW = "expected the {} file that an earlier job made; delete it, and the same command makes it anew"
# no file of this kind comes near; a few lines of aliases of aliases would grow beyond any memory
_DEEPEST, _MOST_VALUES = 50, 200_000
_NO_NUMBER = -(2**31)  # stands for NaN in packed variables
_FULL = (errno.ENOSPC, errno.EDQUOT)
_FURTHER = 2**16  # bytes, more than a file system keeps in hand for a file's end
_SKEW = 2.0  # s that clocks of a network may differ by
_MERGE = "tag:yaml.org,2002:merge"
_TRUTH, _TEXT = "tag:yaml.org,2002:bool", "tag:yaml.org,2002:str"


class _StrictLoader(yaml.CSafeLoader):
    """Decimal numbers alone, ``1e-5`` included, no dates and no key twice.

    YAML 1.1 reads ``02400`` as an octal number, ``1:30`` as 90 and ``1_000`` as 1000: here each is a text, and so is a
    key ``on`` or ``no``, which is a truth value there.
    """

    def construct_mapping(self, node, deep=False):
        known = set()
        for key in (key for key, _ in node.value if isinstance(key, yaml.ScalarNode)):
            key.tag = _TEXT if key.tag == _TRUTH else key.tag
            value = key.value if key.tag == _MERGE else self.construct_object(key)
            if value in known:
                raise yaml.constructor.ConstructorError(
                    None, None, f"the key '{key.value}' stands twice", key.start_mark
                )
            known.add(value)
        return super().construct_mapping(node, deep)


_StrictLoader.yaml_implicit_resolvers = {
    first: [(tag, text) for tag, text in known if tag.rsplit(":")[-1] not in ("int", "float", "timestamp")]
    for first, known in yaml.CSafeLoader.yaml_implicit_resolvers.items()
}
_StrictLoader.add_implicit_resolver(
    "tag:yaml.org,2002:int", re.compile(r"^[-+]?(0|[1-9][0-9]*)$"), list("-+0123456789")
)
_StrictLoader.add_implicit_resolver(
    "tag:yaml.org,2002:float",
    re.compile(
        r"^[-+]?(\.[0-9]+|(0|[1-9][0-9]*)(\.[0-9]*)?)([eE][-+]?[0-9]+)?$|^[-+]?\.(inf|Inf|INF)$|^\.(nan|NaN|NAN)$"
    ),
    list("-+0123456789."),
)


def parse_yaml(text, where):
    """Python value of a YAML text, every decimal number read as one (``1e-5`` included).

    Raises
    ------
    InputError
        The text is not YAML, states a key twice, or grows too large or too deep.
    """
    try:
        _check_growth(text)
        return yaml.load(text, Loader=_StrictLoader)
    except (yaml.YAMLError, ValueError, TypeError, KeyError, AttributeError) as error:  # a bad value of a tag
        words = " ".join(str(error).replace('in "<unicode string>", ', "in ").split())
        raise InputError(where, "", f"expected YAML; {words}") from None


def _check_growth(text):
    """Refuse a text whose values hold themselves, lie too deep, or are very many once every alias is written out."""
    sizes, opened = {}, []  # by anchor; of the collections around an event, with their anchors
    for event in yaml.parse(text, Loader=_StrictLoader):
        if isinstance(event, yaml.CollectionStartEvent):
            opened.append([event.anchor, 1])
            if len(opened) > _DEEPEST:
                raise ValueError(f"it is deeper than {_DEEPEST} levels")
            continue
        if isinstance(event, yaml.CollectionEndEvent):
            anchor, size = opened.pop()
        elif isinstance(event, yaml.AliasEvent):
            if any(anchor == event.anchor for anchor, _ in opened):
                raise ValueError(f"'{event.anchor}' holds itself")
            anchor, size = None, sizes.get(event.anchor, 1)
        elif isinstance(event, yaml.ScalarEvent):
            anchor, size = event.anchor, 1
        else:
            continue
        if anchor is not None:
            sizes[anchor] = size
        if opened:
            opened[-1][1] += size
        if size > _MOST_VALUES:
            raise ValueError(f"it has more than {_MOST_VALUES} values")


def load_yaml(path):
    """Mapping at the top of a YAML file.

    Raises
    ------
    InputError
        The file is missing, unreadable, not YAML or not a mapping.
    """
    mapping = parse_yaml(read_text(path), path)
    if not isinstance(mapping, dict):
        raise InputError(path, "", "expected a mapping of keys to values at the top of the file")
    return mapping


def read_text(path):
    """Text of a file that a user named.

    Raises
    ------
    InputError
        The file is missing or is not text.
    """
    try:
        return read_bytes(path).decode("utf-8").replace("\r\n", "\n").replace("\r", "\n")
    except UnicodeDecodeError:
        raise InputError(path, "", "expected a text file; its bytes are not UTF-8") from None


def read_foreign_text(path):
    """Text of a file that another program wrote: UTF-8, UTF-16 with its mark, else Windows-1252.

    Raises
    ------
    InputError
        The file is missing, or is no regular file.
    """
    content = read_bytes(path)
    try:
        text = content.decode("utf-16" if content[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig")
    except UnicodeDecodeError:
        text = content.decode("cp1252", errors="replace")  # digits are the same in both
    text = text.rstrip("\x1a")  # the end of a file of DOS
    return text.replace("\r\n", "\n").replace("\r", "\n")


def read_bytes(path):
    """Bytes of a file that a user named.

    Raises
    ------
    InputError
        The file is missing, or is none: a folder, a device, a pipe.
    """
    try:
        if os.path.exists(path) and not os.path.isfile(path):
            raise InputError(path, "", "expected a readable file; this is a folder or a device")
        return Path(path).read_bytes()
    except InputError:
        raise
    except OSError as error:
        raise InputError(path, "", f"expected a readable file; {error.strerror.lower()}") from None
    except ValueError:  # a null byte
        raise InputError(path, "", "expected the path of a readable file") from None


def load_json(path):
    """Value of a JSON file.

    Raises
    ------
    InputError
        The file is missing or holds something else.
    """
    return parse_json(read_text(path), path)


def parse_json(text, where):
    """Value of a JSON text.

    Raises
    ------
    InputError
        The text is something else.
    """
    try:
        return json.loads(text)
    except (
        ValueError,
        RecursionError,
    ) as error:  # a whole number of thousands of digits; lists in lists in lists
        raise InputError(where, "", f"expected JSON; {error}") from None


def load_made_json(path, read):
    """Value that ``read`` makes of the JSON that an earlier job wrote.

    Raises
    ------
    InputError
        The file is missing or holds something else.
    """
    value = load_json(path)
    try:
        return read(value)
    except (KeyError, TypeError, ValueError, AttributeError, OverflowError):
        raise InputError(path, "", MADE_ANEW.format("JSON")) from None


def named_file(kind, name):
    """Path of a file that ships with the program, by its name among its kind, or of a file of the user.

    Raises
    ------
    InputError
        Neither of them, for a name without a suffix.
    """
    if str(name) in shipped_names(kind):
        return shipped(kind, name)
    path = Path(name)
    if not os.path.exists(path) and path.suffix == "":
        known = f"expected a {kind.removesuffix('s')} file or one of {', '.join(shipped_names(kind))}"
        raise InputError(name, "", known)
    return path


def shipped(kind, name):
    """Path of a file that ships with the program, such as ``shipped("structures", "configuration-1")``."""
    return HOME / "config" / kind / f"{name}.yaml"


def shipped_names(kind):
    """Names of the files of one kind that ship with the program, sorted."""
    return sorted(path.stem for path in (HOME / "config" / kind).glob("*.yaml"))


def check_past(path):
    """Refuse a file whose time lies ahead of the clock: the workflow would take it for newer than every result of it.

    Raises
    ------
    InputError
        Names the file and its time, and states how to set it.
    """
    time = os.stat(path).st_mtime
    if time > datetime.now().timestamp() + _SKEW:
        found = datetime.fromtimestamp(time).isoformat(" ", "seconds")
        raise InputError(
            path, "", f"expected a file from before now, found the time {found}; `touch` sets it to now"
        )


def check_output(path):
    """Path of a file that can be written. Its folder may be missing: a command that fails leaves none behind.

    Raises
    ------
    InputError
        The path is empty, a folder or not UTF-8, or its own folder cannot be made or written to.
    """
    if not str(path) or Path(path).is_dir():
        raise InputError(path or "output", "", "expected the path of a file to write, not a folder")
    try:
        str(path).encode()
    except UnicodeEncodeError:  # libraries that write take no other
        raise InputError(path, "", "expected a path in UTF-8") from None
    folder = _nearest_folder(path)
    if not folder.is_dir():
        raise InputError(path, "", f"expected a folder to write to; {folder} is a file")
    if not os.access(folder, os.W_OK):
        raise InputError(path, "", "expected a folder to write to; permission denied")
    return Path(path)


def _nearest_folder(path):
    """The folder of a path or, where it is missing, the nearest one above that is there."""
    return next(folder for folder in Path(path).absolute().parents if os.path.exists(folder))


@contextlib.contextmanager
def replacing(path):
    """Temporary path next to ``path`` that takes its place when the block ends well.

    A reader sees the whole old file or the whole new one; a failed or killed writer leaves the old one.

    Raises
    ------
    InputError
        The path is that of no file, or cannot be written to; or the disk is full.
    """
    path = check_output(path)
    full = InputError(path, "", "expected room to write to; the disk is full")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, temporary = tempfile.mkstemp(prefix=f".{path.name}.", suffix=path.suffix, dir=path.parent)
    except OSError as error:
        if error.errno in _FULL:
            raise full from None
        raise InputError(path, "", f"expected a folder to write to; {error.strerror.lower()}") from None
    os.close(handle)
    try:
        yield Path(temporary)
        os.chmod(temporary, 0o666 & ~_umask())
        os.replace(temporary, path)
    except BaseException as error:
        # checked before the temporary file gives its room back; errors of netCDF's library do not tell
        no_room = isinstance(error, (OSError, RuntimeError)) and _is_full(path.parent)
        Path(temporary).unlink(missing_ok=True)
        if no_room:
            raise full from None
        raise


def _is_full(folder):
    """Whether a folder takes no further bytes."""
    try:
        with tempfile.TemporaryFile(dir=folder) as file:
            file.write(bytes(_FURTHER))
    except OSError as error:
        return error.errno in _FULL
    return False


@contextlib.contextmanager
def replacing_folder(folder):
    """Temporary folder next to ``folder`` that takes its place when the block ends well; else nothing is left.

    Raises
    ------
    InputError
        There is a file, or a folder with content, in its place.
    """
    folder = Path(folder)
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise InputError(folder, "", "expected a new or an empty folder; nothing is overwritten")
    check_output(folder / "file" if folder.exists() else folder)
    made = Path(tempfile.mkdtemp(prefix=f".{folder.name}.", dir=_nearest_folder(folder)))
    try:
        yield made
        made.chmod(0o777 & ~_umask())
        folder.parent.mkdir(parents=True, exist_ok=True)
        made.replace(folder)
    finally:
        shutil.rmtree(made, ignore_errors=True)


def _umask():
    mask = os.umask(0)
    os.umask(mask)
    return mask


def write_text(path, text):
    """Write a text file atomically."""
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


def write_json(path, value):
    """Write a JSON file atomically, keys in the order given, floats with all their digits."""
    write_text(path, json.dumps(value, indent=2) + "\n")


def write_dataset(path, dataset, decimals=None):
    """Write an xarray Dataset as netCDF-4, atomically, float variables compressed.

    ``decimals``, where given, is the number of decimal digits kept in variables of a unit, which are packed as whole
    numbers (CF-1.11, section 8.1): ``{"m": 7}`` keeps 0.1 micrometre, far below any marker's noise. A variable with a
    value that no such number reaches, 215 m here, is not packed. The same content gives the same bytes, whether it was
    computed or read from a file.
    """
    dataset = dataset.drop_encoding()
    # coordinate variables have no missing values (CF-1.11, section 2.5.1)
    encoding = {name: {"_FillValue": None} for name in dataset.dims if name in dataset.variables}
    for name, variable in dataset.variables.items():
        if variable.dtype.kind == "f" and variable.size > 64:
            encoding[name] = encoding.get(name, {}) | {"zlib": True, "complevel": 2, "shuffle": True}
            unit = variable.attrs.get("units")
            if decimals is None or unit not in decimals:
                continue
            scale = 10.0 ** -decimals[unit]
            if not float(abs(variable).max()) >= -_NO_NUMBER * scale:
                encoding[name] |= {"dtype": "int32", "scale_factor": scale, "_FillValue": _NO_NUMBER}
    with replacing(path) as temporary, delayed_interrupts():
        dataset.to_netcdf(temporary, engine="netcdf4", format="NETCDF4", encoding=encoding, unlimited_dims=[])


def history(before, words):
    """The attribute ``history`` of a file (CF-1.11, section 2.6.2), a line longer; without a date, for equal bytes."""
    return "\n".join(filter(None, [before, f"blockshake {__version__} {words}"]))


def content_digest(*values):
    """Twelve hexadecimal digits that identify JSON-like values and arrays of bytes."""
    digest = hashlib.sha256()
    for value in values:
        digest.update(value if isinstance(value, bytes) else json.dumps(value, sort_keys=True).encode())
        digest.update(b"\0")
    return digest.hexdigest()[:12]


def file_digest(path):
    """Twelve hexadecimal digits that identify a file's bytes."""
    return content_digest(Path(path).read_bytes())
