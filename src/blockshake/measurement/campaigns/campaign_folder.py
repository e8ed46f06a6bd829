"""A campaign's folder as it is written: structure, motions and ``campaign.yaml``."""

import shutil
from pathlib import Path

import yaml

from blockshake.dynamics.baseline import AUTO
from blockshake.dynamics.records.contract_csv import METADATA
from blockshake.files import shipped_names, write_text


def motion_in_folder(motion, folder):
    """Name of a motion in the campaign: a shipped name, or the file copied to the folder as it was published."""
    if motion in shipped_names("motions"):
        return motion
    for suffix in ("", METADATA):
        if not suffix or Path(f"{motion}{suffix}").is_file():
            copy_unless_same(f"{motion}{suffix}", folder / f"{Path(motion).name}{suffix}")
    return Path(motion).name


def structure_in_folder(structure, loaded, folder):
    """Name of the structure in the campaign: a shipped name, or the file copied to the folder, meshes with it."""
    if structure in shipped_names("structures"):
        return structure
    meshes = [shape.mesh for shape in loaded.file.shapes.values() if shape.mesh]
    copy_unless_same(structure, folder / "structure.yaml")
    for mesh in meshes:
        copy_unless_same(Path(structure).parent / mesh, folder / mesh)
    return "structure.yaml"


def copy_unless_same(source, target):
    """Copy a file to a path, unless it is that file."""
    if Path(source).resolve() != target.resolve():
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(source, target)


def write_campaign_file(folder, header, name, structure, sensors, tests):
    """Write ``campaign.yaml``.

    Parameters
    ----------
    folder : Path
    header : str
        Comment lines.
    name, structure : str
        As in the file.
    sensors : dict
        Standard deviations.
    tests : sequence of dict
        Which the keys that the file has are taken.
    """
    keys = ("name", "file", "motion", "scale", "baseline", "role")
    mapping = {
        "name": name, "structure": structure, "sensors": sensors,
        "tests": [{key: test[key] for key in keys if test.get(key, AUTO) != AUTO} for test in tests],
    }  # fmt: skip
    text = yaml.safe_dump(mapping, sort_keys=False, default_flow_style=None, width=200, allow_unicode=True)
    write_text(folder / "campaign.yaml", header + text)
