"""The thermal test procedure: what to measure when, screening and reduction.

warming       eq. 8, eq. 9, tau_95
assemblies    the 3 to 4 % rule
repeats       pooled runs, repeatability
protocol      what to measure when; what a test record lacks or has wrong
factorial     two-level designs, effects, Lenth's limits
sensitivity   Morris and Sobol over the same factors
two_paths     any network as R_ext and R_w
pm_network    a permanent-magnet machine by hand formulas;  screening: table I on it
heat_run      the rise by IEC 60034-1 against the limit of its class
steady_law    one law from a table of steady tests
curves        all of eq. 8, eq. 9, the rule and the repeats for a case
carry         the calibrated model on other machines
"""
