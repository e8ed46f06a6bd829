"""The one error that a user can mend, worded in one line."""

import contextlib
from os import PathLike

BAD_INPUT, INTERRUPTED = 2, 130  # exit codes; the second by Ctrl-C
_LONGEST = 1000  # characters of a line that someone reads


class Argument(str):
    """Name of a function's argument at fault, the place of an `InputError`; a command line states its option."""


class InputError(ValueError):
    """Bad input: names the file or the argument, the key and what was expected.

    Parameters
    ----------
    where : str, path or Argument
        File, command-line option or argument of a function at fault.
    key : str
        Dotted key inside it; empty when the whole file is at fault.
    expected : str
        A correct input in words, and the value found where that helps.

    Notes
    -----
    Names and values of files stand in the words. A line break or another control character among them is shown as an
    escape, so that the words are one line, and the end of a very long line is left out.

    Examples
    --------
    >>> import blockshake
    >>> try:
    ...     blockshake.load_structure("configuration-1", {"materials.concrete.density": -1.0})
    ... except blockshake.InputError as error:
    ...     print(error.where, error.key, error.expected, sep="; ")
    configuration-1; materials.concrete.density; input should be greater than or equal to 0.001, not -1.0
    """

    def __init__(self, where: str | PathLike[str], key: str, expected: str) -> None:
        self.where = where if isinstance(where, Argument) else str(where)
        self.key, self.expected = str(key), str(expected)
        place = f"{self.where}: {self.key}" if self.key else self.where
        super().__init__(one_line(f"{place}: {self.expected}"))


@contextlib.contextmanager
def faults_of(where, key):
    """Raise the faults of what a key of a file names with that file and key."""
    try:
        yield
    except InputError as error:
        raise InputError(where, key, str(error)) from None


def one_line(words):
    """Words in one line of at most 1000 characters, control characters as escapes."""
    line = "".join(sign if sign.isprintable() else ascii(sign)[1:-1] for sign in words[:_LONGEST])
    return line if len(words) <= _LONGEST >= len(line) else f"{line[: _LONGEST - 4]} ..."
