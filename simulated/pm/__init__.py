"""The sealed magnet motors of the published thermal tests: films, plant, meters, files."""
