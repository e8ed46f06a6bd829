import copy

import pytest
import yaml
from synthetic_campaigns import make_tests, structure_of_three

from blockshake.files import load_yaml, shipped


@pytest.fixture(scope="session")
def three():
    """Three blocks with a marker off the line of the others on each body."""
    return structure_of_three()


@pytest.fixture(scope="session")
def clean_tests(three):
    """Sound sensors: coloured noise, gaps, outliers, offsets, markers within 1 mm."""
    return make_tests(
        three, 1, mounting=1e-3, marker_dropouts=0.01, accelerometer_offset=0.05, outliers=0.002
    )


@pytest.fixture(scope="session")
def two_blocks(tmp_path_factory):
    """File of the two lowest blocks of configuration 1 on their slab."""
    mapping = copy.deepcopy(load_yaml(shipped("structures", "configuration-1")))
    for kind, key in (("bodies", "name"), ("markers", "body"), ("accelerometers", "body")):
        mapping[kind] = [item for item in mapping[kind] if item[key] != "block-3"]
    path = tmp_path_factory.mktemp("two") / "two.yaml"
    path.write_text(yaml.safe_dump(mapping, sort_keys=False), encoding="utf-8")
    return str(path)
