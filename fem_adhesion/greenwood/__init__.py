"""Greenwood (1997), computed again. The command ``greenwood``.

Computation: `study`, which calls `tables`, `criteria` and `numerics_1997`. Claims of the paper: `verdicts` has the rule
that decides them, `facts` what they are measured on, `claims_model`, `claims_curves`, `claims_theories` and
`claims_jumps` the claims by the paper's sections, `claims` their table. Figures are data that `drawing` draws and
writes as CSV: `load_figures` and `state_figures` under the paper's numbers, `beyond` for what the paper does not draw.
All is shown on `page`. And `command`.
"""
