"""Greenwood (1997), computed again. The command ``greenwood``.

`settings` say what is computed, `study` computes it with `tables`, `criteria` and `numerics_1997`. The claims of the
paper stand in ``data/claims.csv``; `claims` has the rule that decides them, `formulas` and `measures` the numbers that
test them, `facts` what these are measured on. Figures are lines of data, which `drawing` draws and writes as CSV:
`figures` under the paper's numbers, `beyond` for what the paper does not draw. All is shown on `page`. And `command`.
"""
