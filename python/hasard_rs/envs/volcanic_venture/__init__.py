"""VolcanicVenture, where the published package has it."""
