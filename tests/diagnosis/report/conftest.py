import pytest
from fake_diagnosis import SIMULATED, FakeDiagnosis
from fake_findings import KINDS, track_record

from blockshake.diagnosis.report.content import load_diagnosed
from blockshake.files import write_json


@pytest.fixture(scope="session")
def fakes(tmp_path_factory):
    """Results of every kind of decision."""
    made = {
        kind: FakeDiagnosis(tmp_path_factory.mktemp(kind), kind, simulated=kind == SIMULATED)
        for kind in KINDS
    }
    write_json(made[SIMULATED].track_record, track_record())
    return made


@pytest.fixture(scope="session")
def found(fakes):
    """Content of the report, by decision; sealed tests' files hold no test, so that opening one would fail."""
    return {kind: load_diagnosed(*fake.arguments()) for kind, fake in fakes.items()}
