"""From a table of steady tests to the law that their cooling follows."""
