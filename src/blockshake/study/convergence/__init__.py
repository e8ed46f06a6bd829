"""LS-DEM with its numerical parameters varied one at a time."""
