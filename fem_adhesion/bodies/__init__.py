"""Elastic bodies: what each is, and how it becomes a mesh. Nothing else asks which body it is.

`body` says what there is to know of one; a `half_space` is endless or cut off, `layers` lie on a rigid base or a
half-space, those `held` at their far side have a length of their own. scikit-fem takes as long to load as all else, so
that it is imported where a mesh is made, not where a body is named.
"""
