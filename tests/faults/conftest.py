import ledger
import pytest
from work import WORKS, checkout_with_campaign


@pytest.fixture(scope="session")
def whole_study(tmp_path_factory):
    """A study that nothing happened to."""
    checkout = checkout_with_campaign(tmp_path_factory.mktemp("whole"))
    answer = checkout.snakemake(*WORKS["study"])
    assert answer.returncode == 0, answer.stdout + answer.stderr
    return checkout


def pytest_terminal_summary(terminalreporter):
    """Print the ledger under the results."""
    for line in ledger.tables():
        terminalreporter.write_line(line)
