r"""
Your AFM tip
============

A silica tip of 100 nm radius comes down on a hard surface, on a cantilever of 0.2 N/m. How hard does it stick,
where does it jump, and which theory describes it? One command answers; the first line says which model to trust.

Put in your own tip: its radius, Young's modulus and Poisson's ratio, the work of adhesion, and either the Hamaker
constant or the equilibrium spacing of the surfaces. The same command in a terminal::

    fem-adhesion assess --radius 100nm --modulus 72GPa --poisson 0.17 \
        --work-of-adhesion 0.063J/m^2 --hamaker 65zJ --stiffness 0.2N/m --plot tip.png
"""

from fem_adhesion import cli

tip = "--radius 100nm --modulus 72GPa --poisson 0.17 --work-of-adhesion 0.063J/m^2 --hamaker 65zJ"
cli.main(["assess", *tip.split(), "--stiffness", "0.2N/m", "--plot", "tip.png"])
