"""Numbers of the assessment: what is asked of the solvers, where models hold, and how theories are sampled."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Settings:
    """Numbers of the assessment.

    Between the Tabor parameters `stiff` and `soft` neither limit serves: they are those of lambda in Johnson &
    Greenwood's map of 1997. [G97], section 5, has 0.2 and 3; the pull-off load is there 4 % off Bradley's and 3.4 % off
    JKR's. The first order of the attracted layer's yield is told between `faint` and `first_order`: below, no measured
    work of adhesion has that digit; beyond, the second order, its square, is more than a per cent.
    """

    # What is asked of the solvers
    rigid: float = 1e-12  # Tabor parameter below which the rigid sphere is taken
    computed: float = 300.0  # Tabor parameter above which JKR's theory with the reach of the attraction is taken
    finite: float = 10.0  # Tabor parameter up to which the finite sphere takes a few seconds
    rtol: float = 1e-6  # of the half-space
    finite_rtol: float = 1e-4  # of the finite sphere beside it
    searched: float = 1e-3  # of the samples in the search for the thickness that is enough
    to_load: float = 2.0  # R dgamma
    maugis: tuple[float, float] = (1e-6, 1e6)  # of Maugis's lambda
    decay: float = 1.5  # power of 1/mu with which the distance of JKR's theory with reach dies out
    thin: float = 0.12  # beta: on a layer so thick that distance at `computed` is at most twice the half-space's
    bulge: float = 0.6  # beta: the jump on errs at `computed` by at most 1 + bulge/thickness of the half-space's error

    # Where models hold
    stiff: float = 0.1  # Tabor parameter below which a contact is rigid
    soft: float = 5.0  # Tabor parameter above which a contact is JKR's
    good: float = 0.01  # largest difference of a model that does in the place of the best one
    contact: float = 0.3  # of its radius over R: beyond, neither the parabola nor linear elasticity hold
    strain: float = 0.2  # beta/R, the strain of a contact beta wide
    spacing: float = 0.1  # eps/R: a sphere of ten atoms is no continuum
    jump: float = 0.3  # of the distance over R: the law between planes is meant for gaps small against R
    faint: float = 1e-3  # of the work of adhesion
    first_order: float = 0.1  # of the work of adhesion

    # Closed theories as samples
    number: int = 100_001  # of each stretch; odd, so that every second sample has the same ends
    nodes: int = 48  # of the polynomial through JKR's theory on layers
    sampled: int = 8001  # places on the atlas' curve; energies err by 2e-7
    zooms: int = 3  # times that intervals beside a turn of the base are divided
    zoomed: int = 33  # places on such an interval
    slack: float = 10.0  # errors of the atlas' curve by which its turns may be off, in eps, and energies
    draws: int = 256  # of the inputs: quantiles at 16 and 84 % to 5 % of the spread
    drawn: int = 401  # places on the atlas' curve for each draw
    step: float = 0.25  # of a standard deviation, by which an input is changed for a derivative
    least_step: float = 1e-3  # of the input: the solvers err by 1e-6, a derivative then by 1e-3
    straight: float = 0.2  # of the linear spread, by which quantiles may be off to bear it out
    compressed: float = 2.0  # load to which the curves go

    # Thin samples
    wrong: float = 0.01  # part of the value by which the half-space may be off to be right
    deepest: float = 0.2  # indentation, as a part of the thickness: small strain
    widest: float = 0.05  # indentation, as a part of the radius: small strain
    parts: tuple[float, ...] = (0.05, 0.1, 0.2, 0.5, 1.0)  # of the deepest indentation
    thick: float = 30.0  # beta, where the search for a thickness begins
    most: int = 12  # secants
    flattest: float = -0.2  # slope of a secant
    least: float = 1e-12  # difference that counts as none
    narrow: float = 1e-8  # error of the contact radius, in thicknesses
    root: float = 1e-3  # error of the logarithm of the thickness

    # The tables and the figure
    digits: int = 4  # significant digits of a ratio, at most
    wider: float = 1.3  # of the frame, beyond the jump on
    higher: float = 0.35  # of the frame, above zero in pull-off forces
    thinned: int = 50  # of so many samples of a closed theory one is drawn


USUAL = Settings()
