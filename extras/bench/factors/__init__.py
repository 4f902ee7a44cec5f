"""Which of many factors move a temperature: factorial designs, screening, Morris and Sobol."""
