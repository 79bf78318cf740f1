"""Uniform refinement of curved meshes: new nodes are placed by the cells' own shape, which scikit-fem's is not."""

from __future__ import annotations

from typing import Any

import numpy as np
from skfem import MeshQuad, MeshQuad2, MeshTri, MeshTri2

CURVED = {MeshTri: MeshTri2, MeshTri2: MeshTri2, MeshQuad: MeshQuad2, MeshQuad2: MeshQuad2}
STRAIGHT = {MeshTri: MeshTri, MeshTri2: MeshTri, MeshQuad: MeshQuad, MeshQuad2: MeshQuad}


def refined(mesh: Any) -> Any:
    """Cut each cell into four of the same shape together.

    Parameters
    ----------
    mesh : skfem.MeshTri, MeshTri2, MeshQuad or MeshQuad2
        With straight or curved sides, and named boundaries.

    Returns
    -------
    skfem.MeshTri2 or MeshQuad2
        With the same boundaries.
    """
    kind = type(mesh)
    sorting = {"sort_t": False} if STRAIGHT[kind] is MeshTri else {}
    straight = STRAIGHT[kind](mesh.p[:, : mesh.nvertices], mesh.t, mesh.boundaries, **sorting)
    finer = straight.refined()
    fine = CURVED[kind].from_mesh(finer)
    cells = fine.dofs.element_dofs
    parents = np.tile(np.arange(mesh.nelements), 4)
    X = straight.mapping().invF(fine.doflocs[:, cells].transpose(0, 2, 1), tind=parents)
    points = fine.doflocs.copy()
    points[:, cells.T] = mesh.mapping().F(X, tind=parents)
    return CURVED[kind](points, fine.t, finer.boundaries)
