"""Bodies with a size as elastic operators: the sphere in its grips, a pair of them, a mesh of the user's."""
