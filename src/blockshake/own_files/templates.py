"""Commented templates that are right as they stand: a structure, a study, a campaign."""

import re
from pathlib import Path

import numpy as np

from blockshake.dynamics.load_motion import load_motion
from blockshake.errors import InputError
from blockshake.files import read_text, replacing_folder, shipped, write_text

STRUCTURE, STUDY, CAMPAIGN = "structure", "study", "campaign"
_MOTION = "alkion"
_MARKERS = ("slab-lvdt", *(f"block-{block}-{place}" for block in (1, 2) for place in ("lvdt", "foot")))
_READING_RATE, _DURATION, _NOISE = 100.0, 12.0, 1e-4  # Hz, s, m


def write_template(kind, path):
    """Write a template, named after its path.

    Parameters
    ----------
    kind : str
        ``structure`` or ``study``, a file; ``campaign``, a folder with a structure and a synthetic test.
    path : str or path
        That is not there yet.

    Returns
    -------
    list of str
        Lines that say what was written, and what to do next.

    Raises
    ------
    InputError
        A path that is there already, or a file that does not end in ``.yaml``.
    """
    path = Path(path)
    if path.exists() and not (kind == CAMPAIGN and path.is_dir() and not any(path.iterdir())):
        raise InputError(path, "", "expected a new path; nothing is overwritten")
    if kind == CAMPAIGN:
        with replacing_folder(path) as folder:
            write_text(folder / "structure.yaml", _template(STRUCTURE, "structure"))
            write_text(folder / "campaign.yaml", _template(CAMPAIGN, path.resolve().name))
            write_text(folder / "test-1.csv", _synthetic_test())
    else:
        if path.suffix not in (".yaml", ".yml"):
            raise InputError(path, "", f"expected a YAML file, {path}.yaml")
        write_text(path, _template(kind, path.stem))
    return [f"{path}: a template of a {kind}; change it, then: blockshake check {path}"]


def _template(kind, name):
    """Text of a template under a name in lower case, digits and hyphens."""
    name = re.sub(r"[^a-z0-9]+", "-", name.lower()).strip("-") or f"my-{kind}"
    return re.sub(
        r"^name: \S+", f"name: {name}", read_text(shipped("templates", kind)), count=1, flags=re.MULTILINE
    )


def _synthetic_test():
    """CSV of transducers along x on blocks that the table carries, with noise."""
    time = np.arange(round(_DURATION * _READING_RATE)) / _READING_RATE
    moved = load_motion(_MOTION).evaluate(time)[:, :1]
    readings = moved - moved[0] + np.random.default_rng(1).normal(0.0, _NOISE, (len(time), len(_MARKERS)))
    lines = [",".join(["time_s", *(f"{name}.x" for name in _MARKERS)])]
    lines += [
        f"{at:.2f}," + ",".join(f"{reading:.5f}" for reading in row)
        for at, row in zip(time, readings, strict=True)
    ]
    return "\n".join(lines) + "\n"
