"""The contact problem of deformable bodies, in the impulses."""
