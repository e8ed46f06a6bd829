"""Origin of a report: software, digests of files, and the command that makes it again."""

import platform
from importlib.metadata import version

from blockshake.pages.blocks import Listing, Table, Text

_PACKAGES = ("numpy", "scipy", "numba", "xarray", "pandas", "snakemake", "matplotlib", "typst")


def software_versions():
    """Versions of blockshake, Python and the packages that figures rest on, by name."""
    return {
        "blockshake": version("blockshake"),
        "Python": platform.python_version(),
        **{name: version(name) for name in _PACKAGES},
    }


def pairs_table(caption, header, mapping):
    """Table of two columns from a mapping of text to text."""
    return Table(caption, header, tuple((str(key), str(value)) for key, value in mapping.items()), "ll")


def versions_table(versions):
    """Table of the software."""
    return pairs_table("Software that made this report.", ("Package", "Version"), versions)


def digests_table(digests):
    """Table of the files that a report rests on."""
    return pairs_table("Digests of files (first 12 digits of SHA-256).", ("File", "Digest"), digests)


def command_blocks(command):
    """The command that makes a report again."""
    return [
        Text("Command that makes this report again, in a checkout of the same version:"),
        Listing("Command", command),
    ]
