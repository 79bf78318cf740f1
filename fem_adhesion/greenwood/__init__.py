"""Greenwood (1997), computed again. The command ``greenwood``.

Computation: `study`, which calls `tables`, `criteria` and `numerics_1997`. Figures are data that `drawing` draws and
writes as CSV: `load_figures` and `state_figures` under the paper's numbers, `beyond` for what the paper does not draw.
All is shown on `page`. And `command`.
"""
