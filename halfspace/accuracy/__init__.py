"""To the accuracy asked for: ladders of ever finer stages, the errors they leave, and the curves they end in."""
