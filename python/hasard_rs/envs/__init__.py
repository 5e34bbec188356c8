"""The published package's environment classes: one folder a scenario, each an `Env` with the scenario bound."""
