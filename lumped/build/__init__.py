"""The network against the field it came from, and the errors of mesh, condensation and time."""
