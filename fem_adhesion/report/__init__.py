"""One page that a reviewer can be sent. The command ``report``.

`walk` (the states of one curve), `page` (with the comparison, and what other commands left), `command`.
"""
