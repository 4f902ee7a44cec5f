"""Makes the simulated measurements of cases/road-test; shares no physics code with the rooms."""
