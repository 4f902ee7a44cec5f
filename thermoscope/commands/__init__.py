"""One file per group of commands. Each returns its exit code: 0 done, 1 disagrees or nothing found."""
