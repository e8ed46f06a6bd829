"""A campaign's folder as it is written: structure, motions and ``campaign.yaml``."""

import shutil
from pathlib import Path

import yaml

from blockshake.dynamics.load_motion import load_motion
from blockshake.dynamics.records.contract_csv import write_motion_csv
from blockshake.files import shipped_names, write_text


def motion_in_folder(motion, folder):
    """Name of a motion in the campaign: a shipped name, or the file that is written to the folder."""
    if motion in shipped_names("motions"):
        return motion
    name = f"{Path(motion).stem}.csv"
    if Path(motion).resolve() != (folder / name).resolve():
        write_motion_csv(load_motion(motion), folder / name)
    return name


def structure_in_folder(structure, loaded, folder):
    """Name of the structure in the campaign: a shipped name, or the file copied to the folder, meshes beside it."""
    if structure in shipped_names("structures"):
        return structure
    meshes = [shape.mesh for shape in loaded.file.shapes.values() if shape.mesh]
    for name, source in [
        ("structure.yaml", Path(structure)),
        *((m, Path(structure).parent / m) for m in meshes),
    ]:
        if source.resolve() != (folder / name).resolve():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(source, folder / name)
    return "structure.yaml"


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
        Of which the keys that the file has are taken.
    """
    keys = ("name", "file", "motion", "scale", "role")
    mapping = {
        "name": name, "structure": structure, "sensors": sensors,
        "tests": [{key: test[key] for key in keys} for test in tests],
    }  # fmt: skip
    text = yaml.safe_dump(mapping, sort_keys=False, default_flow_style=None, width=200, allow_unicode=True)
    write_text(folder / "campaign.yaml", header + text)
