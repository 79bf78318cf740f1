"""What a digit costs. The command ``speed``.

`methods` of both families (`halfspace_methods`, `element_methods`), `growth` of the time of those with error control;
`study`, `result`; `figures`, `page`, `command`.
"""
