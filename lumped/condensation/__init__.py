"""From a field to a small network: bases, training, and the error that is left."""
