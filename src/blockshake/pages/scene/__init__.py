"""Blocks as pictures show them: projections, colours and meshes."""
