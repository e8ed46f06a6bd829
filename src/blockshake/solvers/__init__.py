"""The contact solvers: same structure, same motion, same record, different contact."""
