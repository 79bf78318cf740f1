"""One page that a reviewer can be sent. The command ``report``.

`walk` (the states of one curve), `levels` (the comparison), `sections` (what other commands left), `page`, `command`.
"""
