"""Is the half-space good enough for a sphere? The command ``finite-sphere``.

Computation: `cases`, `study`, and of its `table` the leading terms and what the body yields (`fit`). What is seen: the
`chart` with its materials and `figures`, captions with them, and `page`. And `command`.
"""
