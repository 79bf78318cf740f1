"""The numbers of the algorithms at finite strain."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Settings:
    """Numbers of the algorithms at finite strain, relative unless a unit is given; they decide truth or cost as said.

    Attributes
    ----------
    most_rungs
        Rungs of the ladder above the lowest.
    other_cells
        Halves of the change by other cells and one degree more that may be left as error. At half of it the load at
        jump-off by the traction ``vertical`` (poisson 0.499, tabor 1, R/eps 30) was outside its estimate.
    soft
        Part of the surface's stiffness, gone, from which a lost solution is put down to it; up to it the curve may be
        that of the linear body.
    strained
        Widest contact radius in R up to which the curve is that of the linear body; beyond, it may have other events.
    smallest_part
        Least part in which beta/R is raised from the linear body; below it an event counts as lost.
    raised_points
        Most points of a path to an event that is raised: a smaller part of beta/R serves better than a longer path.
        At 60 an attempt in vain took 272 factorisations (tabor 3, R/eps 1070, poisson 0.49, traction ``normal``), at 8
        it takes 55; half of beta/R took 6.
    window
        Fine cells in one mesh of the curve: more cost unknowns, fewer cost meshes.
    most_windows
        Most meshes of a curve that is traced at finite strain. 70 drawn scenes whose curves are take 19 at most up to a
        load of 5, where the surface keeps a tenth of its stiffness. At small strains, where the linear body's curve
        serves unless an event is lost, it would be up to 470, each for seconds.
    flattened
        c dgamma/(E* R) above which a sphere is drawn flat: 0.127 bears a load at tabor 0.5 to 1, 0.169 does not.
    solved
        Accuracy of the linear equations where none is asked for.
    slow
        Part of the error that an iteration by an older tangent may leave; else the state gets a tangent of its own. At
        tabor 1, R/eps 100 and 1e-6 there are 14 factorisations and 1069 solves at 0.5, 22 and 458 at 0.1, 28 and 385
        at 0.02; one of the former takes as long as ten to twenty of the latter.
    start_steps, start_accuracy
        Most steps to a state under a given pressure, and the accuracy of this state.
    most_drawn
        Largest r_d/r of a surface: up to 1.4 in spheres about to be drawn flat, 2.3 to 140 in needles of few cells.
    least_volume
        Least volume ratio J to which a step may take a cell at once.
    """

    most_rungs: int = 2
    other_cells: float = 4.0
    soft: float = 0.85
    strained: float = 0.5
    smallest_part: float = 0.005
    raised_points: int = 8
    window: int = 8
    most_windows: int = 40
    flattened: float = 0.13
    solved: float = 1e-10
    slow: float = 0.1
    start_steps: int = 12
    start_accuracy: float = 1e-4
    most_drawn: float = 2.0
    least_volume: float = 0.1


USUAL = Settings()
