"""Pictures and exports of one run."""
