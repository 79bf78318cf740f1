"""Other people's numbers beside ours, and what is likely wrong with them. The command ``benchmark``.

`problems` (named problems, our values, sheets), `submission` (their numbers or curves), `causes` (what may be wrong, as
changes of our own solution), `study` (which of these fits, and the verdicts), `terminal`, `figure`, `command`.
"""
