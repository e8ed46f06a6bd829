"""The diagnosis's report."""
