"""Meshes of the bodies and their refinement, and meshes read from files, checked."""
