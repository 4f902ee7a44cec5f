"""What a measurement adds: sensors' answers, sampling, noise, faults."""
