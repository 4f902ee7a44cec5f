"""The network of a machine built from geometry: films, streams, losses and priors around the condensed conduction."""
