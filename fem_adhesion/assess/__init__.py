"""What holds for one contact given in SI, and which model to trust. The command ``assess``.

`study`, `predictions` (of the solvers), `theories`, `thin_sample`, `verdict`; `settings`, their numbers;
`terminal`, `figure`, `command`.
"""
