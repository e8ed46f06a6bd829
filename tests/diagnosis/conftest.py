import copy

import pytest
import yaml

from blockshake.files import load_yaml, shipped


@pytest.fixture(scope="session")
def two_blocks(tmp_path_factory):
    """File of the two lowest blocks of configuration 1 on their slab."""
    mapping = copy.deepcopy(load_yaml(shipped("structures", "configuration-1")))
    for kind, key in (("bodies", "name"), ("markers", "body"), ("accelerometers", "body")):
        mapping[kind] = [item for item in mapping[kind] if item[key] != "block-3"]
    path = tmp_path_factory.mktemp("two") / "two.yaml"
    path.write_text(yaml.safe_dump(mapping, sort_keys=False), encoding="utf-8")
    return str(path)


@pytest.fixture
def without_limits(monkeypatch):
    """Decisions without the limits of causes, half of their time, on which no decision depends."""
    monkeypatch.setattr("blockshake.diagnosis.answer.decide.limits_of", lambda *_: {})
