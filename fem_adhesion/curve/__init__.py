"""Load-approach curves to look at and to keep. The command ``curve``.

`solve`; `lines` and `scales`, of which everything is drawn; `figure` with its panels, of which `load` and `profiles`
are apart; `beside`, of several laws; `terminal`; `record`; `still` and `movie`; `command`.
"""
