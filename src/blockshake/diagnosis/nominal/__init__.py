"""Nominal ensembles: planned tests, nominal models, and the histories that simulated and measured tests show."""
