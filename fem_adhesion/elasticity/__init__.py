"""Linear elasticity: space, stiffness (nearly incompressible too), far field, condensation to the surface, stresses."""
