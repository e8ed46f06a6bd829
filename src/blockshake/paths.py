"""Paths that files of users name: where they may lead, and of which signs they are."""

from pathlib import Path

from blockshake.errors import InputError


def file_below(folder, name, where, key):
    """Path of a file that another file names, which lies below that file's folder, wherever links lead.

    Whoever receives a folder from others reads nothing else through it.

    Parameters
    ----------
    folder : str or path
    name : str
        Relative path; there need not be such a file.
    where, key : str
        File and key that an error names.

    Raises
    ------
    InputError
        An absolute path, one that leads out of the folder, or no path at all.
    """
    path = Path(folder) / name
    try:
        if not Path(name).is_absolute() and path.resolve().is_relative_to(Path(folder).resolve()):
            return path
    except (OSError, RuntimeError, ValueError):  # a loop of links, a null byte
        pass
    raise InputError(where, key, f"expected the path of a file below {folder}, not '{name}'")


def check_plain(path, where, key):
    """Refuse a path that the workflow, which reads what stands in braces as a wildcard, would not take as it is.

    Raises
    ------
    InputError
        Braces, line breaks or other control characters in the path.
    """
    if set("{}") & set(str(path)) or not str(path).isprintable():
        raise InputError(where, key, f"expected a path without braces and control characters, not '{path}'")
