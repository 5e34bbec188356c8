"""CollateralDamage, where the published package has it."""
