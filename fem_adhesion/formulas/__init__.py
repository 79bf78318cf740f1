"""Drop-in formulas for other codes, from the coefficients of `halfspace.theories.fits`. The command ``formulas``.

`fit` (the coefficients from the atlas), `emit` (Python, C, Fortran, Markdown and LaTeX from the templates in ``data``),
`command`.
"""
