"""
A body from a mesh
==================

Any body of revolution can be meshed, in Gmsh say, and named as the body: here the tip of a probe, a round cap on a
cone. The mesh needs three named groups of boundary lines; ``meshes/README.md`` says which and shows three recipes.
"""

from pathlib import Path

import matplotlib.pyplot as plt
import meshio

import fem_adhesion

file = next(folder / "meshes/tip.msh" for folder in Path.cwd().parents if (folder / "meshes/tip.msh").exists())
tip = fem_adhesion.Meshed(file, radius_ratio=100.0)
path = fem_adhesion.trace(fem_adhesion.Scene(tabor=0.5, body=tip), rtol=1e-3)
for name, event in path.events.items():
    print(f"{name:10} approach {event.approach:8.4f} eps, load {event.load:8.4f} R dgamma")

mesh = meshio.read(file)
(left, right) = plt.subplots(1, 2, figsize=(9, 4))[1]
left.triplot(mesh.points[:, 0], mesh.points[:, 1], mesh.cells_dict["triangle6"][:, :3], linewidth=0.4)
left.set(aspect="equal", xlabel="radius (R)", ylabel="height (R)")
curve = path.resampled(80)
right.plot(curve.approach, curve.load)
right.set(xlim=(-4, 4), xlabel="approach (ε)", ylabel="load (R Δγ)")
