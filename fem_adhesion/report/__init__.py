"""One page that a reviewer can be sent. The command ``report``.

`walk` (the states of one curve), `levels` and `sections` (the comparison, and what other commands left), `parts` and
`figures`, `page`, `command`.
"""
