"""Load-approach curves to look at and to keep. The command ``curve``.

`solve`, with the units of what is shown; `figure` with its panels, of which `load` is apart; `beside`, of several laws;
`terminal`; `record`; `pictures` of the body; `settings`, the numbers of what is shown; `command`.
"""
