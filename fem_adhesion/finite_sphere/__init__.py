"""Is the half-space good enough for a sphere? The command ``finite-sphere``.

Computation: `cases`, `study`, and of its `table` the leading terms and what the body yields (`fit`) and the `chart`
with its materials. What is seen: `chart_figure` and `figures`, captions with them, and `page`. And `command`.
"""
