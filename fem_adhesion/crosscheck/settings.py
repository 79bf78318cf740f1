"""Numbers of the comparison: budgets, tolerances, and the bodies that the levels solve."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Settings:
    """Numbers of the comparison, by level; lengths are in beta unless said.

    A budget is the sum of both error estimates up to which a comparison means something. On levels 1 to 3 budgets are
    in the tolerance asked for, on the fourth, which looks for mistakes and not digits, they are what stands here.
    """

    # Levels 1 to 3: the solvers
    pointwise: float = 10.0  # budget of gaps, radii, deflections, in that of loads, which are averages; as of level 4
    residual: float = 50.0  # budget of residuals, which see every wiggle of the pressure, in the same
    tightest: float = 1e-9  # least tolerance of a solver
    closer: tuple[float, ...] = (10.0, 100.0)  # factors of the tolerance asked for again where estimates leave it open
    share: float = 4.0  # triangles get this part of the budget, inverse: with 1 they and the elements miss it together
    finest: float = 1e-4  # cells of operators at an edge, under which the deflection has a vertical tangent
    fine: float = 0.02  # cells of operators where pressures have no edge, in the radius of these
    harmonic: tuple[tuple[int, int], ...] = ((9, 2000), (11, 2600))  # nodes of cells, harmonics: they show the spike

    # Definitions: laws, profiles and lengths
    defined: float = 1e-3  # budget of each number
    exact: float = 1e-5  # relative error that the rule and differences leave
    step: float = 2e-3  # of ln H in the trapezoidal rule: it leaves 1e-12 of smooth laws, 1e-7 of a kink
    small: float = 1e-4  # step of differences of a profile, in the radius

    # The fourth level: equations and events in the weak form
    budget: float = 1e-3  # of each quantity
    least: float = 5e-5  # relative error of each number that the weak form knows none better than: both bodies may err
    round_off: float = 1e-10  # relative
    approach: float = -0.5  # of the state made up, in eps
    change: float = 0.3  # of that approach, in eps
    # Steps beside a fold, in 1 + the load: more than both sources differ by there, or as far as states are found.
    aside: tuple[float, ...] = tuple(1e-2 / 2.0**n for n in range(8))
    # Of the secant to a turning point: its first step in 1 + the size of what it goes along, the part of that within
    # which the point is found, and the most steps.
    turn: float = 5e-4
    turned: float = 1e-3
    tries: int = 10
    innermost: int = 20  # points next to the axis whose gaps show ripples, about those of two cells
    near: float = 3e-3  # where the way from afar ends before a fold, in 1 + the approach
    steps: int = 7  # equilibria on that way; 4 to 20 lead to the same, by laws of all kinds, at tabor 1 to 20
    away: float = 0.2  # how far off that fold may be, in 1 + the load
    tiny: float = 0.1  # radius of a contact about whose edge cells are finest, in the radius of the attraction
    opening: float = 0.49  # part of a gap that opens in the radius of the attraction by the 3-9 law
    closest: float = 0.1  # least gap that counts there, in eps

    # Bodies of the weak form
    fineness: tuple[tuple[int, float], ...] = ((3, 20.0), (4, 60.0), (5, 180.0))  # half-spaces: degree, box in radii
    wide: float = 2.5  # contact radius beyond which spikes of tension are narrower in it than on paraboloids
    half_space_growth: float = 3.0  # ratio of neighbouring cells of a half-space
    within: float = 0.3  # longest cell within the reach of the attraction, as a part of that
    closing: float = 1e-6  # least gap in eps that counts as one
    tip: float = 1e-4  # what the cell under a sharp tip may leave
    farther: float = 10.0  # times that a box is larger for an attraction that falls slowly
    degrees: tuple[int, ...] = (3, 4, 5)  # of bodies with a length; one more of layers and where nothing else checks
    nearly: float = 0.45  # Poisson's ratio beyond which a body with a length has a degree more
    locking: float = 0.499  # Poisson's ratio beyond which a half-space has a degree more, as by other laws
    sharp: float = 6.0  # sharpness of an edge beyond which its spike is too narrow to show where it turns
    growth: float = 2.5  # ratio of neighbouring cells of a body with a length
    widest: float = 0.95  # radius beyond which cells are finest nowhere, in R
    clamped: float = 2e-6  # part of eps and a deflection that a clamp under a half-space under strata may leave out
    rings: int = 4  # of cells around a corner where the stress is singular

    # The block that is solved condensed and with all displacements
    block: tuple[float, float, float] = (0.4, 3.0, 20.0)  # finest cells, how far these go, its edge
    block_degree: int = 3  # of its elements
    rounding: float = 1e-9  # relative difference that rounding may make; tabor 0.02 to 20 differ by 2e-12 at most
    before: float = 1.0  # how far before the jump on, or the first touch, in eps: found from undeformed surfaces there


USUAL = Settings()
