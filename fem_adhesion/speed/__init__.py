"""What a digit costs. The command ``speed``.

`methods` of both families (`halfspace_methods`, `element_methods`), `study`, `result`; `figures`, `page`, `command`.
"""
