"""Is the half-space good enough for a sphere? The command ``finite-sphere``.

Computation: `cases`, `study`, `records`, `table`, `points`, `terms`, `bulk`, `fit`, `chart`, `materials`. What is seen:
`figures`, `chart_figure`, `findings`, `words`, `tables`, `page`. And `command`.
"""
