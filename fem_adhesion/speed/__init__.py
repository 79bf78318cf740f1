"""What a digit costs. The command ``speed``.

`methods`, on the half-space and by finite elements, with their ladders in ``data/methods.toml``; `study`, which times
them, and those with error control as they are asked for more; `page` with its figures, beside which an earlier run can
be shown; `command`.
"""
