"""Every key of a user's files is made wrong once, and `check` names the file, the key and the expectation.

The keys come from the schemas, so that a new one cannot be forgotten: it needs a row in `wrong_keys.ROWS`.
"""

import copy
import itertools
import os
import re
import shutil
from pathlib import Path

import pytest
import yaml
from wrong_keys import BESIDE, CAMPAIGN, EXEMPT, ROWS, STUDY, TURNED, write_files

from blockshake.dynamics.record_choice import TargetSpectrum
from blockshake.errors import InputError
from blockshake.files import load_yaml
from blockshake.geometry.schema import Array, Cylinder, StructureFile
from blockshake.measurement.campaigns.campaign import CampaignFile
from blockshake.own_files.check import check
from blockshake.own_files.import_map import ImportMap
from blockshake.study.config import StudyConfig, Until, load_config
from blockshake.study.limit_states.settings import LimitState
from blockshake.study.sampling.latin_hypercube import draw_design
from blockshake.virtual.settings import VirtualCampaign, load_settings

# keys that exclude others of the good files, or that `extend-study` writes: tested next to what they are for
ELSEWHERE = (
    "shapes.*.mesh",
    *(f"shapes.*.cylinder.{key}" for key in Cylinder.model_fields),
    "bodies.*.steps",
    *(f"bodies.*.array.{key}" for key in Array.model_fields),
    "bodies.*.on",
    "bodies.*.offset",
    "tests.*.outcome",
    "time.rate",
    "accelerometers.time.rate",
    "cases.*.intensity.measure",
    "cases.*.intensity.period",
    "cases.*.intensity.levels",
    "cases.*.intensity.unit",
    *(f"cases.*.intensity.spectrum.{key}" for key in TargetSpectrum.model_fields),
    "structure",
    "ensemble.table",
    "ensemble.distributions.*.values",
    "ensemble.distributions.*.probabilities",
    "ensemble.distributions.*.loc",
    "ensemble.distributions.*.scale",
    "ensemble.batch",
    *(f"ensemble.until.{key}" for key in Until.model_fields),
    *(f"limits.*.{key}" for key in LimitState.model_fields),
    "limits.*.joint.*",
    "limits.*.cases.*",
    "extension",
    "extension.cases",
    "extension.named_by",
)
KINDS = {
    "study": (StudyConfig, "study.yaml", load_config),
    "structure": (StructureFile, "structure.yaml", check),
    "campaign": (CampaignFile, "campaign/campaign.yaml", check),
    "import": (ImportMap, "import.yaml", check),
    "virtual": (VirtualCampaign, "virtual.yaml", lambda path: load_settings(path, "structure.yaml")),
}
SHARED = Path(os.environ.get("BLOCKSHAKE_SHARED", Path(__file__).parents[3] / "shared"))
ANY = "*"  # of a key's pattern: an entry of a list or of a mapping with free names


def keys_of(schema, known=None, above=()):
    """Patterns of the keys of a JSON schema that have no keys below them, as tuples of their parts."""
    known = known or schema.get("$defs", {})
    if "$ref" in schema:
        yield from keys_of(known[schema["$ref"].rpartition("/")[2]], known, above)
    elif "anyOf" in schema or "prefixItems" in schema:
        inner = schema.get("anyOf", ())
        found = dict.fromkeys(itertools.chain(*(keys_of(one, known, above) for one in inner)))
        deeper = [key for key in found if len(key) > len(above)]
        yield from deeper or [above]
    elif "properties" in schema:
        for name, entry in schema["properties"].items():
            yield from keys_of(entry, known, (*above, name))
    elif "patternProperties" in schema or isinstance(schema.get("additionalProperties"), dict):
        entry = next(iter(schema.get("patternProperties", {}).values()), schema.get("additionalProperties"))
        deeper = [key for key in keys_of(entry, known, (*above, ANY)) if len(key) > len(above) + 1]
        yield from deeper or [above]
    elif schema.get("type") == "array":
        deeper = [key for key in keys_of(schema["items"], known, (*above, ANY)) if len(key) > len(above) + 1]
        yield from deeper or [above]
    else:
        yield above


def place_of(mapping, dotted):
    """Parts of a key in a mapping, whose names may hold dots."""
    if not dotted:
        return ()
    if isinstance(mapping, list):
        number, _, rest = dotted.partition(".")
        return (int(number), *place_of(mapping[int(number)], rest))
    for name in sorted(mapping, key=len, reverse=True):
        if dotted == name or dotted.startswith(f"{name}."):
            return (name, *place_of(mapping[name], dotted[len(name) + 1 :]))
    return (dotted,)


def changed(mapping, place, value):
    mapping = copy.deepcopy(mapping)
    inner = mapping
    for part in place[:-1]:
        inner = inner[part]
    inner[place[-1]] = value
    return mapping


@pytest.fixture(scope="module")
def good(tmp_path_factory):
    """Folder of good files."""
    folder = tmp_path_factory.mktemp("good")
    write_files(folder)
    return folder


def refusal(folder, kind, mapping):
    """The refusal of a file of a kind; it fails where the file is accepted."""
    _, name, check = KINDS[kind]
    before = (folder / name).read_text()
    (folder / name).write_text(yaml.safe_dump(mapping, sort_keys=False))
    try:
        with pytest.raises(InputError) as error:
            check(name)
    finally:
        (folder / name).write_text(before)
    assert str(error.value).isprintable()
    return str(error.value)


@pytest.mark.parametrize("kind", KINDS)
def test_the_good_files_are_good(good, kind, monkeypatch):
    monkeypatch.chdir(good)
    _, name, check = KINDS[kind]
    check(name)


@pytest.mark.parametrize(
    ("kind", "key", "value", "words"), [(kind, *row) for kind, rows in ROWS.items() for row in rows]
)
def test_a_wrong_value_is_named_with_file_and_key(good, kind, key, value, words, monkeypatch):
    monkeypatch.chdir(good)
    mapping = load_yaml(KINDS[kind][1])
    said = refusal(good, kind, changed(mapping, place_of(mapping, key), value))
    assert words in said
    # a fault that lies in another file is reported with that file
    named = re.findall(r"[\w-]+\.(?:csv|yaml)", str(value))
    assert KINDS[kind][1] in said or any(name in said for name in [*named, *BESIDE])
    if KINDS[kind][1] in said and kind != "campaign":
        # a structure that a model cannot read with these parameters is given by the case
        told = key.split(".")[0], key.split(".")[-1], "cases.0.structure: ls-dem: "
        assert any(one in said for one in told)


@pytest.mark.parametrize("kind", KINDS)
def test_a_value_of_another_type_is_named(good, kind, monkeypatch):
    """Every key of the schema that the good file has, once with a list in lists, once with a text for all else."""
    monkeypatch.chdir(good)
    schema, name, _ = KINDS[kind]
    mapping = load_yaml(name)
    for pattern in keys_of(schema.model_json_schema()):
        place = first_place(mapping, pattern)
        if place is None:  # a mesh, which no box has with it
            continue
        said = refusal(good, kind, changed(mapping, place, [[["x"]]]))
        assert str(place[-1]) in said, (place, said)


def first_place(mapping, pattern):
    """Place of the first entry of a mapping that has the key of a pattern; None where none has."""
    if not pattern:
        return ()
    part, *rest = pattern
    if part == ANY:
        choices = range(len(mapping)) if isinstance(mapping, list) else list(mapping)
    else:
        choices = [part] if isinstance(mapping, dict) and part in mapping else []
    for choice in choices:
        inner = first_place(mapping[choice], rest)
        if inner is not None:
            return (choice, *inner)
    return None


@pytest.mark.parametrize("kind", KINDS)
def test_every_key_of_the_schema_has_a_row(good, kind):
    """The good file has every key, and every one is made wrong."""
    schema, name, _ = KINDS[kind]
    mapping = load_yaml(good / name)
    rows = [place_of(mapping, key) for key, *_ in ROWS[kind]]
    for pattern in keys_of(schema.model_json_schema()):
        assert first_place(mapping, pattern) or ".".join(pattern) in ELSEWHERE
        if ".".join(pattern) in EXEMPT[kind]:
            continue
        assert any(
            len(row) <= len(pattern)
            and all(one in (part, ANY) for one, part in zip(pattern, row, strict=False))
            for row in rows
        ), pattern


def test_a_calibration_without_a_parameter_of_the_model_is_refused(good, monkeypatch):
    monkeypatch.chdir(good)
    study = changed(STUDY, ("ensemble",), {"size": 10, "seed": 1, "linked": {}, "distributions": {
        "materials.granite.density": STUDY["ensemble"]["distributions"]["materials.granite.density"]}})  # fmt: skip
    study["calibration"] = {"cases": {"nscd-rigid": ["wall"]}}
    assert "that nscd-rigid has a use for" in refusal(good, "study", study)


def test_materials_of_a_pair_may_be_in_either_order(good, monkeypatch):
    monkeypatch.chdir(good)
    config = load_config("study.yaml")
    own, *others = config.calibration.parameters
    assert others == ["restitution", "hollow"]
    assert own != TURNED
    assert own in config.ensemble.distributions
    assert list(config.calibration.ranges) == [own]
    design = draw_design(config.ensemble.model_dump())
    assert abs(design.values[own].corr(design.values["materials.granite.density"]) - 0.5) < 0.05


def test_a_command_that_is_not_at_hand_is_remarked(tmp_path):
    write_files(tmp_path)
    campaign = changed(CAMPAIGN, ("tests", 0, "motion"), "nothing.csv")
    (tmp_path / "campaign" / "campaign.yaml").write_text(yaml.safe_dump(campaign))
    assert "nothing.csv is not at hand, without which there is no diagnosis" in check(tmp_path / "campaign")


@pytest.mark.skipif(not (SHARED / "cases").is_dir(), reason=f"no cases in {SHARED} (set BLOCKSHAKE_SHARED)")
def test_the_case_of_a_correlation_s_names(tmp_path, monkeypatch):
    shutil.copytree(SHARED / "cases" / "correlation-names", tmp_path / "case")
    monkeypatch.chdir(tmp_path / "case")
    with pytest.raises(InputError, match=r"correlation\.csv: friction\.granite\.steel: expected one of"):
        check("study.yaml")
    check("study-2.yaml")
    design = draw_design(load_config("study-2.yaml").ensemble.model_dump())
    assert design.target.to_numpy()[0, 1] == 0.5
    assert abs(design.correlation.to_numpy()[0, 1] - 0.5) < 0.01
