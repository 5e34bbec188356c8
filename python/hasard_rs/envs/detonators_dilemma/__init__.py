"""DetonatorsDilemma, where the published package has it."""
