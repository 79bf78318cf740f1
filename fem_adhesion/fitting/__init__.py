"""From a measured force curve to work of adhesion and range. The command ``fit``; in Python `fem_adhesion.fit`.

`measured` (reading), `makers` (files of instruments), `prepare` (baseline, noise, jumps), `model` (what an apparatus
records of a theory), `traced` (of other laws and bodies), `data` (samples by branches), `likelihood` (and best values),
`profile` (intervals), `study` (the fit, other models beside it, what the curve does not tell), `words`, `terminal`,
`figure`, `command`; `folder` (many curves), `plugin` (a fit model for nanite).
"""
