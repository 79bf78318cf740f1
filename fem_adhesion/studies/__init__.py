"""Studies: each answers one question with the solvers."""
