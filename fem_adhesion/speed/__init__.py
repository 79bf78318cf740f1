"""What a digit costs. The command ``speed``.

`methods`, on the half-space and by finite elements; `study`, which times them, and those with error control as they are
asked for more; `result`, which can be that of an earlier run; `page` with its figures, `command`.
"""
