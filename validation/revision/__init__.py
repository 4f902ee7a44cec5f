"""Effects added and removed, held against acceptance checks, repeated until the model agrees."""
