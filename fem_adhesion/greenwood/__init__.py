"""Greenwood (1997), computed again. The command ``greenwood``.

Computation: `study`, which calls `curves`, `tables`, `devices`, `criteria`, `ripple`, `relaxation`. What is seen:
`figures` of four kinds, `captions` and `remarks`, which are made of numbers, `record`, `page`. And `command`.
"""
