"""A machine on a bench with a hidden truth, served row by row; shares no physics code with the rooms."""
