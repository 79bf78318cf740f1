"""Do the two solvers agree? The command ``compare``.

In the order of reading: `comparison` (two numbers with errors, a budget, a verdict), `study` (operators, residuals,
events), `from_scratch` (what both share, against `fem_adhesion.weak_form`), `record`, `table`, `command`.
"""
