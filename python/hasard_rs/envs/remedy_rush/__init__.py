"""RemedyRush, where the published package has it."""
