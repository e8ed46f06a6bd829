"""JSON schemas of the files that users write, made from the schemas that check them."""

from blockshake.geometry.schema import StructureFile
from blockshake.measurement.campaigns.campaign import CampaignFile
from blockshake.measurement.imports.import_map import ImportMap
from blockshake.study.config import StudyConfig

_FILES = {"structure": StructureFile, "study": StudyConfig, "campaign": CampaignFile, "import": ImportMap}
_DRAFT = "https://json-schema.org/draft/2020-12/schema"


def file_schema(kind):
    """JSON schema of a kind of file, for editors that complete and check YAML.

    Parameters
    ----------
    kind : str
        ``structure``, ``study``, ``campaign`` or ``import`` (the map of an import).

    Returns
    -------
    dict
        Types, limits and meaning of every key. Rules between keys, such as a friction for every pair of materials, are
        those of ``blockshake check`` alone.
    """
    return {"$schema": _DRAFT, **_FILES[kind].model_json_schema()}
