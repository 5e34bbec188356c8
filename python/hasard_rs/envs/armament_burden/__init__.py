"""ArmamentBurden, where the published package has it."""
