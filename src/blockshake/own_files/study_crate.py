"""A finished study as a Workflow Run RO-Crate: a folder with its inputs, workflow and results, and their digests.

The metadata follow the Workflow Run Crate profile 0.5 (https://w3id.org/ro/wfrun/workflow/0.5) on RO-Crate 1.1. They
state only what the files show: no person, no licence of the user's data, no start of the run.
"""

import hashlib
import shutil
from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path
from urllib.parse import quote

import netCDF4

from blockshake.diagnosis.nominal.plan import result_name
from blockshake.dynamics.record_set import record_files
from blockshake.errors import InputError
from blockshake.files import (
    HOME,
    AnyPath,
    content_digest,
    load_yaml,
    named_file,
    replacing_folder,
    write_json,
)
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import load_campaign
from blockshake.study.config import StudyConfig, load_config

METADATA = "ro-crate-metadata.json"
MAIN = "workflow/Snakefile"
_FORMATS = {
    ".csv": "text/csv", ".html": "text/html", ".json": "application/json", ".nc": "application/netcdf",
    ".pdf": "application/pdf", ".yaml": "application/yaml", ".yml": "application/yaml",
}  # fmt: skip
_PROFILES = {
    "https://w3id.org/ro/wfrun/process/0.5": "Process Run Crate",
    "https://w3id.org/ro/wfrun/workflow/0.5": "Workflow Run Crate",
    "https://w3id.org/workflowhub/workflow-ro-crate/1.0": "Workflow RO-Crate",
}
_CONTEXT = ["https://w3id.org/ro/crate/1.1/context", "https://w3id.org/ro/terms/workflow-run/context"]
_LANGUAGE = "https://w3id.org/workflowhub/workflow-ro-crate#snakemake"
_LICENCE = "https://spdx.org/licenses/MIT"
_UNSTATED = "The workflow is under the MIT licence. No licence of the other files is stated."


def export_study(study: AnyPath, output: AnyPath) -> Path:
    """Copy a finished study to a folder with the metadata of a Workflow Run RO-Crate, whole or not at all.

    Parameters
    ----------
    study : str or path
        The study, YAML. Its ``results`` and ``reports`` are in the current folder.
    output : str or path
        Folder of the crate, new or empty.

    Returns
    -------
    Path
        The metadata file.

    Raises
    ------
    InputError
        A study that is not there or not finished, or a folder with content.
    """
    config = load_config(study)
    inputs, results = dict(_inputs(Path(study), config)), dict(_results(study, config))
    workflow = {
        str(path.relative_to(HOME)): path
        for path in (HOME / "Snakefile", *sorted((HOME / "workflow").rglob("*")))
        if path.is_file() and "__pycache__" not in path.parts
    }
    with replacing_folder(output) as folder:
        entities = {}
        for name, source in {**workflow, **inputs, **results}.items():
            target = folder / name
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(source, target)
            entities[name] = _file_entity(name, target, source)
        end = datetime.fromtimestamp(max(path.stat().st_mtime for path in results.values()), UTC)
        graph = _graph(config, entities, (inputs, results), _version(results), end)
        write_json(folder / METADATA, {"@context": _CONTEXT, "@graph": graph})
    return Path(output) / METADATA


def _inputs(study: Path, config: StudyConfig) -> Iterator[tuple[str, Path]]:
    """Name in the crate and path of the study and of every file that it names."""
    yield _place(study), study
    for case in config.cases:
        structure = load_structure(case.structure)
        files = [named_file("structures", case.structure), *record_files(case.motion)]
        meshes = [shape.mesh for shape in structure.file.shapes.values() if shape.mesh]
        for path in (*files, *(structure.folder / mesh for mesh in meshes)):
            yield _place(path), Path(path)
    drawn = (load_yaml(study)["ensemble"].get("distributions") or {}).values()
    tables = [config.ensemble.table, config.ensemble.correlation, *(one.get("file") for one in drawn)]
    for path in filter(None, tables):
        yield _place(path), Path(path)
    diagnosed = config.diagnosis.campaigns
    compared = [case.measured.campaign for case in config.cases if case.measured]
    for name in dict.fromkeys([*diagnosed, *compared]):
        campaign = load_campaign(name)
        files = {campaign.folder / test.file for test in campaign.sealed.values() if test.file}
        files |= {path.with_name(f"{path.stem}-acc.csv") for path in files}
        unread = set() if name in diagnosed else files
        for path in sorted(campaign.folder.rglob("*")):
            if path.is_file() and path not in unread:
                yield _place(path), path


def _place(path: AnyPath) -> str:
    """Name in the crate: as from the current folder or, of what ships with the program, from its home."""
    path = Path(path).resolve()
    home = next((one for one in (Path.cwd().resolve(), HOME.resolve()) if path.is_relative_to(one)), None)
    return path.relative_to(home).as_posix() if home else f"inputs/{content_digest(str(path))}/{path.name}"


def _results(study: AnyPath, config: StudyConfig) -> Iterator[tuple[str, Path]]:
    """Name in the crate and path of the reports and of every file of results, with those of its diagnoses."""
    campaigns = [result_name(folder, ()) for folder in config.diagnosis.campaigns]
    reports = [config.name, *(f"diagnosis-{name}" for name in campaigns)]
    for path in (Path("reports", f"{name}.{kind}") for name in reports for kind in ("html", "pdf")):
        if not path.is_file():
            words = f"expected a finished study: {path} is not there; `blockshake study {study}` makes it"
            raise InputError(study, "", words)
        yield path.as_posix(), path
    for folder in (config.name, *(f"diagnosis/{name}" for name in campaigns)):
        for path in sorted(Path("results", folder).rglob("*")):
            if path.is_file() and not path.name.startswith("."):
                yield path.as_posix(), path


def _version(results: dict[str, Path]) -> str:
    """Version of the program that made the runs, as they state it; several where they are of several."""
    versions = set()
    for name in (one for one in results if "/runs/" in one):
        with netCDF4.Dataset(results[name]) as run:
            versions.add(run.getncattr("blockshake_version"))
    return ", ".join(sorted(versions))


def _file_entity(name: str, copy: Path, source: Path) -> dict:
    """Data entity of a file, with its size, the digest of its copy, and its own name where the crate has another."""
    with copy.open("rb") as stream:
        digest = hashlib.file_digest(stream, "sha256").hexdigest()
    entity = {"@id": quote(name), "@type": "File", "contentSize": str(copy.stat().st_size), "sha256": digest}
    if format_ := _FORMATS.get(copy.suffix):
        entity["encodingFormat"] = format_
    return entity | ({"alternateName": source.name} if name.startswith("inputs/") else {})


def _graph(config, entities, actual, version, end):
    """Entities of the crate; ``actual``: inputs and results of the run by name, ``end``: the last of its results."""
    consumed, made = ([_reference(quote(name)) for name in names] for names in actual)
    digests = {name: entity["sha256"] for name, entity in entities.items()}
    action = f"#run-{content_digest(digests)}"
    entities[MAIN] |= {
        "@type": ["File", "SoftwareSourceCode", "ComputationalWorkflow"],
        "name": "blockshake, a study of stacked blocks",
        "version": version,
        "programmingLanguage": _reference(_LANGUAGE),
        "license": _reference(_LICENCE),
    }
    profiles = [_reference(one) for one in _PROFILES]
    return [
        {
            "@id": METADATA,
            "@type": "CreativeWork",
            "about": _reference("./"),
            "conformsTo": [_reference("https://w3id.org/ro/crate/1.1"), profiles[-1]],
        },
        {
            "@id": "./",
            "@type": "Dataset",
            "name": config.name,
            "description": config.description,
            "datePublished": end.date().isoformat(),
            "license": _UNSTATED,
            "conformsTo": profiles,
            "mainEntity": _reference(MAIN),
            "mentions": _reference(action),
            "hasPart": [_reference(entity["@id"]) for entity in entities.values()],
        },
        *(
            {"@id": one, "@type": "CreativeWork", "name": name, "version": one.rpartition("/")[2]}
            for one, name in _PROFILES.items()
        ),
        {"@id": _LANGUAGE, "@type": "ComputerLanguage", "name": "Snakemake", "url": "https://snakemake.github.io",
         "identifier": "https://snakemake.github.io"},
        {"@id": _LICENCE, "@type": "CreativeWork", "name": "MIT License"},
        {
            "@id": action,
            "@type": "CreateAction",
            "name": f"Study {config.name}",
            "description": config.description,
            "endTime": end.isoformat(timespec="seconds"),
            "instrument": _reference(MAIN),
            "object": consumed,
            "result": made,
            "actionStatus": "http://schema.org/CompletedActionStatus",
        },
        *entities.values(),
    ]  # fmt: skip


def _reference(name: str) -> dict[str, str]:
    return {"@id": name}
