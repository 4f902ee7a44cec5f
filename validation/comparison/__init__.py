"""The model against the measurement: predictions, residuals, errors and how far they can be believed."""
