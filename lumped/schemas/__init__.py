"""The keys of all TOML files: their bounds, their schemas, and the reader that refuses what is not one of them."""
