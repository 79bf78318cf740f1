"""What a digit costs. The command ``speed``.

`methods`, on the half-space, and `element_methods`; `study`, which times them, and those with error control as they are
asked for more; `result`, `earlier`, which reads that of another run; `page` with its figures, `command`.
"""
