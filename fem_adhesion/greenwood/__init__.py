"""Greenwood (1997), computed again. The command ``greenwood``.

Computation: `study`, which calls `tables`, `criteria` and `numerics_1997`. What is seen: `load_figures`,
`state_figures` and `trend_figures`, each figure with its caption and all in the looks of `drawing`, and `page`, with
the tables and theirs. And `command`.
"""
