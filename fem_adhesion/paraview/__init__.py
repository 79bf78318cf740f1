"""Bodies for the eye: VTK files with cells of high order and units, solids of revolution, pictures of the cut body."""
