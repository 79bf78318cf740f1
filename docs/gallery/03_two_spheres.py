r"""
Two spheres
===========

A silica particle of 50 nm meets a polystyrene particle of 200 nm. Both are elastic, both are round. Give the second
body with the options that begin with ``--counter``; each sphere keeps its own radius, modulus and Poisson's ratio.
"""

from fem_adhesion import cli

silica = "--radius 50nm --modulus 72GPa --poisson 0.17"
polystyrene = "--counter-radius 200nm --counter-modulus 3GPa --counter-poisson 0.34"
surfaces = "--work-of-adhesion 0.06J/m^2 --spacing 0.2nm"
cli.main(["assess", *f"{silica} {polystyrene} {surfaces}".split(), "--plot", "spheres.png"])
