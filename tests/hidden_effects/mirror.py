"""The mirror image of structures, readings and effects: x to -x, everything else as it is."""

import copy

from blockshake.files import load_yaml
from blockshake.geometry.structure import build_structure


def mirrored_structure(path):
    """A structure with its markers and accelerometers on the other side; its bodies are their own mirror images."""
    mapping = copy.deepcopy(load_yaml(path))
    for kind in ("markers", "accelerometers"):
        for item in mapping[kind]:
            item["position"] = [-item["position"][0], *item["position"][1:]]
    return build_structure(mapping, "mirrored.yaml", ".")


def mirrored_test(test):
    """Readings of the mirror image of a test."""
    test = test.copy(deep=True)
    for name in ("marker_displacement", "marker_initial_position", "initial_offset"):
        if name in test:
            test[name].loc[{"axis": "x"}] *= -1.0
    if "initial_rotation" in test:
        test["initial_rotation"].loc[{"axis": ["y", "z"]}] *= -1.0  # an axial vector
    along_x = [name for name in test["channel"].values if str(name).endswith("-x")]
    test["accelerometer"].loc[{"channel": along_x}] *= -1.0
    return test


def mirrored_effect(effect):
    """The mirror image of an effect: an offset or a share of vertical motion changes sign, a stop its side."""
    changed = copy.deepcopy(effect)
    for key in ("offset", "ratio"):
        if key in changed["values"]:
            changed["values"][key] *= -1.0
    if "axis" in changed["place"]:
        changed["place"]["axis"] = {"+x": "-x", "-x": "+x"}[changed["place"]["axis"]]
    return changed
