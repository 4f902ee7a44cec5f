"""A case folder: settings, tests, model.toml, results."""
