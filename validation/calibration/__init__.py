"""Fitting parameters under priors, and how sure the fitted values are."""
