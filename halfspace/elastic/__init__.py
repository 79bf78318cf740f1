"""The elastic half-space: grids of radii, the kernel of a ring, compliance matrices, and operators made of them."""
