"""Folders of what may be made anew: compiled kernels, and what libraries keep, where no home can be written to."""

import logging
import os
import tempfile
from pathlib import Path

_log = logging.getLogger("blockshake")


def set_cache_home():
    """Name a folder for caches in the environment where this user has none, for libraries and for jobs.

    Notes
    -----
    The folder is ``XDG_CACHE_HOME``, else ``~/.cache``, which all libraries look for by themselves (XDG Base Directory
    Specification, version 0.8). Where neither can be written to it is a temporary one, with a remark.
    """
    if _takes_files(user_cache()):
        return
    try:
        folder = _temporary_cache()
    except OSError:  # nothing can be written anywhere; kernels are then compiled in every process
        return
    os.environ["XDG_CACHE_HOME"] = str(folder)
    os.environ.setdefault("MPLCONFIGDIR", str(folder / "matplotlib"))
    _log.warning("no cache of the user can be written to; %s is taken, a temporary folder", folder)


def kernel_folder(digest):
    """Folder of the compiled kernels of some sources.

    In ``BLOCKSHAKE_CACHE`` where that holds them or can be written to, else in the cache of `set_cache_home`.
    """
    cache = user_cache() / "blockshake" / digest
    if named := os.environ.get("BLOCKSHAKE_CACHE"):
        folder = Path(named) / digest
        if folder.is_dir() or _takes_files(Path(named)):
            return folder
        _log.warning("BLOCKSHAKE_CACHE: %s cannot be written to; %s is taken", named, cache)
    return cache


def user_cache():
    """Cache of the user, there or not."""
    named = Path(os.environ.get("XDG_CACHE_HOME", ""))
    if named.is_absolute():
        return named
    try:
        return Path.home() / ".cache"
    except RuntimeError:  # a user that the system does not know, without HOME: a folder that cannot be
        return Path(os.devnull)


def _takes_files(folder):
    """Whether a folder, made where it is missing, can be written to."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        return False
    return os.access(folder, os.W_OK | os.X_OK)


def _temporary_cache():
    """Temporary folder that this user's processes share and nobody else can write to: kernels are code."""
    folder = Path(tempfile.gettempdir()) / f"blockshake-{os.getuid()}"
    folder.mkdir(mode=0o700, exist_ok=True)
    state = folder.lstat()
    if folder.is_symlink() or state.st_uid != os.getuid() or state.st_mode & 0o077:
        return Path(tempfile.mkdtemp(prefix="blockshake-"))
    return folder
