"""Other people's recordings: read whatever a test bench wrote, guess what each column is, write a case."""
