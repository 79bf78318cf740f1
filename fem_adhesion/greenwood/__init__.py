"""Greenwood (1997), computed again. The command ``greenwood``.

Computation: `study`, which calls `curves`, `tables`, `devices`, `criteria`, `ripple`, `relaxation`. What is seen:
`plot` (what a figure is), `load_figures`, `state_figures`, `trend_figures` and `device_figures`, all drawn by
`figures`; `text`, `captions`, `trend_captions` and `remarks`, which are made of numbers; `record`, `page`. And
`command`.
"""
