"""PrecipicePlunge, where the published package has it."""
