"""Results of two studies held against each other, to the byte."""

import xarray as xr


def files(folder, *suffixes):
    """Files of these kinds in a folder, temporary ones not."""
    found = folder.rglob("*") if folder.exists() else []
    return sorted(path for path in found if path.suffix in suffixes and not path.name.startswith("."))


def unlike(one, other):
    """Names of results of two checkouts whose variables or bytes differ, or that one lacks; the store's units too."""
    names = {
        path.relative_to(folder)
        for folder in (one, other)
        for path in files(folder / "results", ".nc", ".json", ".csv")
        if "kernels" not in path.parts
    }
    assert names
    return sorted(str(name) for name in names if not _alike(one / name, other / name))


def _alike(one, other):
    if not (one.exists() and other.exists()):
        return False
    if one.suffix != ".nc":
        return one.read_bytes() == other.read_bytes()
    return _content(one) == _content(other)


def _content(path):
    """Dimensions and bytes of the variables by name; of texts, which are objects, the texts."""
    return {
        name: (one.dims, one.values.tolist() if one.dtype == object else one.values.tobytes())
        for name, one in xr.load_dataset(path).variables.items()
    }
