"""One block: hexahedral mesh, elastic shapes and the points at which it can be touched."""
