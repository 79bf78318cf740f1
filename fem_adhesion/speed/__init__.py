"""What a digit costs. The command ``speed``.

`methods`, on the half-space, and `element_methods`; `growth` of the time of those with error control; `study`,
`result`; `page` with its figures, `command`.
"""
